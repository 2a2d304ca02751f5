//! Whether to go on: a caller that may want to stop, and a limit of time; and who does the work
//! meanwhile.
//!
//! Long pieces of work ask between parts of some ten milliseconds. The caller himself is asked
//! only every `INTERVAL`, since his answer may cost more than a look at the clock.

use std::cell::Cell;
use std::time::{Duration, Instant};

use crate::error::{positive, KernelError};
use crate::status::Status;
use crate::threads::Threads;

const INTERVAL: Duration = Duration::from_millis(50);

/// Longest limit of time that a clock can add to now [s], some thirty years.
const ENDLESS: f64 = 1e9;

static ALONE: Threads = Threads::new(1);

pub struct Watch<'a> {
    /// Who does the work.
    pub threads: &'a Threads,
    stopped: &'a dyn Fn() -> bool,
    deadline: Option<Instant>,
    next: Cell<Instant>,
    was_stopped: Cell<bool>,
}

impl<'a> Watch<'a> {
    /// A watch that asks `stopped` and allows `time_limit` [s] from now.
    pub fn new(
        stopped: &'a dyn Fn() -> bool,
        time_limit: Option<f64>,
    ) -> Result<Self, KernelError> {
        let now = Instant::now();
        let limit = positive("time_limit", time_limit.unwrap_or(1.0))?.min(ENDLESS);
        Ok(Self {
            threads: &ALONE,
            stopped,
            deadline: time_limit.map(|_| now + Duration::from_secs_f64(limit)),
            next: Cell::new(now + INTERVAL),
            was_stopped: Cell::new(false),
        })
    }

    /// A watch that never ends the work.
    pub fn endless() -> Watch<'static> {
        Watch::after(&|| false, &ALONE)
    }

    /// The same caller without a limit of time: for what is left to do once it is reached.
    pub fn unlimited(&self) -> Self {
        Watch::after(self.stopped, self.threads)
    }

    /// The same, with the work shared between `threads`; by itself the caller's thread works alone.
    pub fn with(self, threads: &'a Threads) -> Self {
        Self { threads, ..self }
    }

    fn after(stopped: &'a dyn Fn() -> bool, threads: &'a Threads) -> Self {
        Self {
            threads,
            stopped,
            deadline: None,
            next: Cell::new(Instant::now() + INTERVAL),
            was_stopped: Cell::new(false),
        }
    }

    /// Refuse to go on once the time is over; a caller who wants to stop leaves none.
    pub fn look(&self) -> Result<(), Status> {
        let now = Instant::now();
        if now >= self.next.get() {
            self.next.set(now + INTERVAL);
            self.was_stopped
                .set(self.was_stopped.get() || (self.stopped)());
        }
        if self.was_stopped.get() || self.deadline.is_some_and(|deadline| now >= deadline) {
            return Err(Status::TimeLimit);
        }
        Ok(())
    }

    /// `work` of every number below `count`, which together read and write `size` numbers, unless it
    /// is time to stop.
    pub fn map<T: Send>(
        &self,
        size: usize,
        count: usize,
        work: impl Fn(usize) -> T + Sync,
    ) -> Result<Vec<T>, Status> {
        let mut found: Vec<Option<T>> = (0..count).map(|_| None).collect();
        let mut rooms = vec![(); self.threads.on(size)];
        let (parts, look) = (found.iter_mut().enumerate(), || self.look());
        self.threads
            .share_until(size, &mut rooms, parts, look, |(), (at, place)| {
                *place = Some(work(at));
            })?;
        Ok(found.into_iter().flatten().collect())
    }

    /// The refusal of a caller who wanted to stop.
    pub fn unless_stopped(&self) -> Result<(), KernelError> {
        if self.was_stopped.get() {
            return Err(KernelError::Stopped);
        }
        Ok(())
    }
}
