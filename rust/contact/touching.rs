//! The linearised contact problem: a dense complementarity problem with one border.
//!
//! Find forces f >= 0 and the approach d with
//!     gap = free + C f - d >= 0,   gap . f = 0,   sum f = load.
//! Where it is known which nodes touch it is linear.

use crate::linear::{from_entries, solve_dense, Matrix};
use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

#[derive(Debug, Clone)]
pub struct Contact {
    pub force: Vec<f64>,
    pub approach: f64,
    pub active: Vec<bool>,
}

/// What forces at the nodes add to the gaps.
pub trait Compliance: Sync {
    /// Of node `to` by a unit force at node `from`.
    fn between(&self, to: usize, from: usize) -> f64;

    /// Add what `force` opens to `gap`.
    fn open(&self, force: &[f64], gap: &mut [f64]);
}

/// The problem: gaps without forces or approach, and what unit forces add to them.
#[derive(Clone, Copy)]
pub struct Linearised<'a> {
    pub compliance: &'a dyn Compliance,
    pub free: &'a [f64],
    pub load: f64,
}

impl Linearised<'_> {
    /// Scale of the border like the compliance's, so that pivoting sees comparable rows.
    pub(crate) fn border(&self, set: &[usize]) -> f64 {
        self.compliance.between(set[0], set[0]).abs().max(1e-300)
    }

    /// The compliance between the nodes of `set`, with the approach and the sum of forces.
    pub(crate) fn bordered(&self, set: &[usize], threads: &Threads) -> Matrix<f64> {
        let (n, border) = (set.len(), self.border(set));
        let entry = |i: usize, j: usize| {
            if i < n && j < n {
                self.compliance.between(set[i], set[j])
            } else if i < n || j < n {
                border * if i < n { -1.0 } else { 1.0 }
            } else {
                0.0
            }
        };
        from_entries(n + 1, entry, threads)
    }

    /// Forces and approach where just these nodes touch; None if they cannot be told.
    pub(super) fn on_set(
        &self,
        active: &[bool],
        watch: &Watch<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Status> {
        let set: Vec<usize> = (0..active.len()).filter(|&i| active[i]).collect();
        let border = self.border(&set);
        let mut right: Vec<f64> = set.iter().map(|&i| -self.free[i]).collect();
        right.push(border * self.load);
        let Some(solution) = solve_dense(&self.bordered(&set, watch.threads), &right, watch)?
        else {
            return Ok(None);
        };
        let mut force = vec![0.0; active.len()];
        for (&i, &f) in set.iter().zip(&solution) {
            force[i] = f;
        }
        Ok(Some((force, border * solution[set.len()])))
    }
}

/// Gaps under `force` at `approach`.
pub(super) fn gaps(
    compliance: &dyn Compliance,
    free: &[f64],
    force: &[f64],
    approach: f64,
) -> Vec<f64> {
    let mut gap: Vec<f64> = free.iter().map(|g| g - approach).collect();
    compliance.open(force, &mut gap);
    gap
}
