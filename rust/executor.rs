//! Parallel execution, the one file with rayon; the result does not depend on the number of threads.
//!
//! Work is cut into parts by its size, never by the number of threads, and every part writes to its own
//! memory. The calling thread takes parts like the others. It alone checks for cancellation between its
//! parts, so that the caller's functions need not be thread-safe.

use std::convert::Infallible;
use std::sync::{Mutex, OnceLock, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::cancel::Cancel;
use crate::status::Status;

/// Numbers read and written that are worth a thread: for fewer, waking it takes longer than the work.
const WORTH_A_THREAD: usize = 100_000;

static SERIAL: Threads = Threads::new(1);

/// Threads to work with, and when to stop.
pub struct Executor<'a> {
    pub(crate) threads: &'a Threads,
    cancel: Cancel<'a>,
}

impl<'a> Executor<'a> {
    pub fn new(threads: &'a Threads, cancel: Cancel<'a>) -> Self {
        Self { threads, cancel }
    }

    /// The calling thread alone.
    pub fn serial(cancel: Cancel<'a>) -> Self {
        Self::new(&SERIAL, cancel)
    }

    /// The same threads and caller without a deadline, for the work that remains after it.
    pub(crate) fn without_deadline(&self) -> Self {
        Self::new(self.threads, self.cancel.without_deadline())
    }

    pub(crate) fn check_cancelled(&self) -> Result<(), Status> {
        self.cancel.check()
    }

    /// `work` applied to every number below `count`, unless cancelled; `size` is how many numbers all
    /// of it reads and writes.
    pub(crate) fn map<T: Send>(
        &self,
        size: usize,
        count: usize,
        work: impl Fn(usize) -> T + Sync,
    ) -> Result<Vec<T>, Status> {
        let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
        let mut workspaces = vec![(); self.threads.count_for(size)];
        let (parts, check) = (results.iter_mut().enumerate(), || self.cancel.check());
        self.threads.share_until(size, &mut workspaces, parts, check, |(), (i, result)| {
            *result = Some(work(i));
        })?;
        Ok(results.into_iter().flatten().collect())
    }

    /// The same for parts, as `Threads::share` does them; `workspace` makes that of each thread.
    pub(crate) fn share<P: Send, W: Send>(
        &self,
        size: usize,
        workspace: impl Fn() -> W,
        parts: impl Iterator<Item = P> + Send,
        work: impl Fn(&mut W, P) + Sync,
    ) -> Result<(), Status> {
        let mut workspaces: Vec<W> =
            (0..self.threads.count_for(size)).map(|_| workspace()).collect();
        self.threads.share_until(size, &mut workspaces, parts, || self.cancel.check(), work)
    }
}

/// The calling thread and its helpers, which are started when there is enough work.
pub struct Threads {
    limit: usize,
    worth: usize,
    helpers: OnceLock<Option<ThreadPool>>,
}

impl Threads {
    /// At most `limit` threads, the calling one included.
    pub const fn new(limit: usize) -> Self {
        Self::each_worth(limit, WORTH_A_THREAD)
    }

    /// The same with a thread for every `worth` numbers, at least one.
    const fn each_worth(limit: usize, worth: usize) -> Self {
        Self { limit, worth, helpers: OnceLock::new() }
    }

    /// Number of threads for work that reads and writes `size` numbers.
    pub(crate) fn count_for(&self, size: usize) -> usize {
        (size / self.worth).min(self.limit).max(1)
    }

    /// Do every part, in any order. Every thread has one of the `workspaces` for itself, and there are
    /// no more threads than workspaces.
    pub(crate) fn share<P: Send, W: Send>(
        &self,
        size: usize,
        workspaces: &mut [W],
        parts: impl Iterator<Item = P> + Send,
        work: impl Fn(&mut W, P) + Sync,
    ) {
        let Ok(()) = self.share_until(size, workspaces, parts, || Ok::<(), Infallible>(()), work);
    }

    /// The same until `check`, called by the calling thread before each of its parts, fails.
    fn share_until<P: Send, W: Send, E>(
        &self,
        size: usize,
        workspaces: &mut [W],
        mut parts: impl Iterator<Item = P> + Send,
        mut check: impl FnMut() -> Result<(), E>,
        work: impl Fn(&mut W, P) + Sync,
    ) -> Result<(), E> {
        let count = self.count_for(size).min(workspaces.len());
        let Some((callers, others)) = workspaces.split_first_mut() else {
            return Ok(());
        };
        let helpers = if count > 1 { self.helpers() } else { None };
        let Some(pool) = helpers else {
            return parts.try_for_each(|part| {
                check()?;
                work(callers, part);
                Ok(())
            });
        };
        let parts = Mutex::new(parts);
        let next = || parts.lock().unwrap_or_else(PoisonError::into_inner).next();
        let (next, work) = (&next, &work);
        pool.in_place_scope(|scope| {
            for workspace in others.iter_mut().take(count - 1) {
                scope.spawn(move |_| {
                    while let Some(part) = next() {
                        work(workspace, part);
                    }
                });
            }
            while let Some(part) = next() {
                if let Err(failure) = check() {
                    // Leave the helpers no further part.
                    while next().is_some() {}
                    return Err(failure);
                }
                work(callers, part);
            }
            Ok(())
        })
    }

    /// None if the system gives no threads: the calling one then works alone.
    fn helpers(&self) -> Option<&ThreadPool> {
        let start = || {
            let builder = ThreadPoolBuilder::new().num_threads(self.limit - 1);
            let named = builder.thread_name(|i| format!("gripscale-{i}"));
            named.build().ok()
        };
        self.helpers.get_or_init(start).as_ref()
    }
}

#[cfg(test)]
mod tests;
