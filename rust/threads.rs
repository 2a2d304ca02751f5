//! Work shared between threads, the one file with rayon; what comes of it does not depend on how many.
//!
//! It is cut into parts by what it is, never by the number of threads, and every part writes to places
//! of its own. The thread that calls takes parts like the others, and is the only one that looks up
//! between them: what it looks at need not be made for threads.

use std::convert::Infallible;
use std::sync::{Mutex, OnceLock, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Numbers read and written, about, that are worth a thread: less takes no longer than to wake it.
const WORTH_A_THREAD: usize = 100_000;

/// The calling thread and those that help it, started when there is enough to do.
pub struct Threads {
    most: usize,
    worth: usize,
    helpers: OnceLock<Option<ThreadPool>>,
}

impl Threads {
    /// At most this many, the calling one among them.
    pub const fn new(most: usize) -> Self {
        Self::each_worth(most, WORTH_A_THREAD)
    }

    /// The same where this many numbers are `worth` a thread, at least one.
    pub const fn each_worth(most: usize, worth: usize) -> Self {
        Self {
            most,
            worth,
            helpers: OnceLock::new(),
        }
    }

    /// How many work on something of `size`, the numbers that it reads and writes.
    pub fn on(&self, size: usize) -> usize {
        (size / self.worth).min(self.most).max(1)
    }

    /// Do every part, in whatever order. A thread has one of the `rooms` for itself, and there are
    /// no more threads than rooms.
    pub fn share<P: Send, R: Send>(
        &self,
        size: usize,
        rooms: &mut [R],
        parts: impl Iterator<Item = P> + Send,
        work: impl Fn(&mut R, P) + Sync,
    ) {
        let Ok(()) = self.share_until(size, rooms, parts, || Ok::<(), Infallible>(()), work);
    }

    /// The same until `look`, asked by the calling thread before each of its parts, refuses.
    pub fn share_until<P: Send, R: Send, E>(
        &self,
        size: usize,
        rooms: &mut [R],
        mut parts: impl Iterator<Item = P> + Send,
        mut look: impl FnMut() -> Result<(), E>,
        work: impl Fn(&mut R, P) + Sync,
    ) -> Result<(), E> {
        let count = self.on(size).min(rooms.len());
        let Some((own, others)) = rooms.split_first_mut() else {
            return Ok(());
        };
        let helpers = if count > 1 { self.helpers() } else { None };
        let Some(pool) = helpers else {
            return parts.try_for_each(|part| {
                look()?;
                work(own, part);
                Ok(())
            });
        };
        let parts = Mutex::new(parts);
        let next = || parts.lock().unwrap_or_else(PoisonError::into_inner).next();
        let (next, work) = (&next, &work);
        pool.in_place_scope(|scope| {
            for room in others.iter_mut().take(count - 1) {
                scope.spawn(move |_| {
                    while let Some(part) = next() {
                        work(room, part);
                    }
                });
            }
            while let Some(part) = next() {
                if let Err(refusal) = look() {
                    while next().is_some() {}
                    return Err(refusal);
                }
                work(own, part);
            }
            Ok(())
        })
    }

    /// None where the system gives no threads: the calling one then works alone.
    fn helpers(&self) -> Option<&ThreadPool> {
        let start = || {
            let helpers = ThreadPoolBuilder::new().num_threads(self.most - 1);
            let named = helpers.thread_name(|at| format!("gripscale-{at}"));
            named.build().ok()
        };
        self.helpers.get_or_init(start).as_ref()
    }
}
