//! Cancellation of a solve: by its caller, or by a limit of time.
//!
//! Long work calls `check` between parts of some ten milliseconds. The caller is asked only every
//! `INTERVAL`, because its answer may cost more than reading the clock.

use std::cell::Cell;
use std::time::{Duration, Instant};

use crate::error::{positive, KernelError};
use crate::status::Status;

const INTERVAL: Duration = Duration::from_millis(50);

/// Longest time limit [s], some thirty years: a clock can add it to the present time.
const LONGEST_LIMIT: f64 = 1e9;

/// A caller who may want to stop, and a deadline.
pub struct Cancel<'a> {
    stop_requested: &'a dyn Fn() -> bool,
    deadline: Option<Instant>,
    next_request: Cell<Instant>,
    stopped: Cell<bool>,
}

impl<'a> Cancel<'a> {
    /// Stop where `stop_requested` returns true, or `time_limit` [s] from now.
    pub fn new(
        stop_requested: &'a dyn Fn() -> bool,
        time_limit: Option<f64>,
    ) -> Result<Self, KernelError> {
        let now = Instant::now();
        let limit = positive("time_limit", time_limit.unwrap_or(1.0))?.min(LONGEST_LIMIT);
        Ok(Self {
            deadline: time_limit.map(|_| now + Duration::from_secs_f64(limit)),
            ..Self::without_limit(stop_requested)
        })
    }

    /// Never cancel.
    pub fn never() -> Cancel<'static> {
        Cancel::without_limit(&|| false)
    }

    /// The same caller without a deadline, for the work that remains after it.
    pub(crate) fn without_deadline(&self) -> Self {
        Self { stopped: self.stopped.clone(), ..Self::without_limit(self.stop_requested) }
    }

    fn without_limit(stop_requested: &'a dyn Fn() -> bool) -> Self {
        Self {
            stop_requested,
            deadline: None,
            next_request: Cell::new(Instant::now() + INTERVAL),
            stopped: Cell::new(false),
        }
    }

    /// `Stopped` once the caller has asked to stop, `TimeLimit` after the deadline.
    pub(crate) fn check(&self) -> Result<(), Status> {
        let now = Instant::now();
        if now >= self.next_request.get() {
            self.next_request.set(now + INTERVAL);
            // A caller who has asked once is not asked again.
            self.stopped.set(self.stopped.get() || (self.stop_requested)());
        }
        if self.stopped.get() {
            return Err(Status::Stopped);
        }
        match self.deadline {
            Some(deadline) if now >= deadline => Err(Status::TimeLimit),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_by_the_caller_is_not_a_time_limit() {
        let (now, hour) = (Instant::now(), Duration::from_secs(3600));
        let calls = Cell::new(0);
        let stop_requested = || {
            calls.set(calls.get() + 1);
            true
        };
        let mut cancel = Cancel::new(&stop_requested, Some(3600.0)).unwrap();
        // Not yet time to ask the caller.
        cancel.next_request.set(now + hour);
        assert_eq!(cancel.check(), Ok(()));
        cancel.deadline = Some(now);
        assert_eq!(cancel.check(), Err(Status::TimeLimit));
        // Both apply: the caller has precedence, and is asked once.
        cancel.next_request.set(now);
        for _ in 0..2 {
            assert_eq!(cancel.check(), Err(Status::Stopped));
            cancel.next_request.set(now);
        }
        assert_eq!(cancel.without_deadline().check(), Err(Status::Stopped));
        assert_eq!(calls.get(), 1);
    }

    #[test]
    fn a_time_limit_must_be_positive_and_may_be_lifted() {
        let refusal = Cancel::new(&|| false, Some(0.0)).map(|_| ()).unwrap_err();
        assert!(refusal.to_string().starts_with("time_limit must be greater than zero"));
        let mut cancel = Cancel::never();
        cancel.deadline = Some(Instant::now());
        assert_eq!(cancel.check(), Err(Status::TimeLimit));
        assert_eq!(cancel.without_deadline().check(), Ok(()));
    }
}
