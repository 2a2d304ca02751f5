//! The linearised contact problem, solved exactly: a dense complementarity problem with one border.
//!
//! Find forces f >= 0 and the approach d with
//!     gap = free + C f - d >= 0,   gap . f = 0,   sum f = load.
//! Primal-dual active set (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865); where it
//! repeats itself, `pivoting` goes on from there.

use super::pivoting;
use crate::linear::{solve_dense, Matrix};
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

#[derive(Debug, Clone)]
pub struct Contact {
    pub force: Vec<f64>,
    pub approach: f64,
    pub active: Vec<bool>,
}

/// The problem: gaps without forces or approach, and what unit forces add to them.
#[derive(Clone, Copy)]
pub struct Linearised<'a> {
    pub compliance: &'a Matrix<f64>,
    pub free: &'a [f64],
    pub load: f64,
}

/// Solve from the active set `start`; `NoActiveSet` if none satisfies the conditions.
pub fn solve(
    problem: &Linearised<'_>,
    start: &[bool],
    settings: &Settings,
    watch: &Watch<'_>,
) -> Result<Contact, Status> {
    let &Linearised {
        compliance,
        free,
        load,
    } = problem;
    let tolerance = settings.active_set_tolerance;
    let mut active = start.to_vec();
    if !active.iter().any(|&a| a) {
        active[lowest(free)] = true;
    }
    let mut seen: Vec<Vec<bool>> = Vec::new();
    let scale = free.iter().fold(1e-300_f64, |m, g| m.max(g.abs()));
    while seen.len() < settings.active_set_rounds && !seen.contains(&active) {
        let solved = problem.on_set(&active, watch)?;
        let (force, approach) = solved.ok_or(Status::NoActiveSet)?;
        let gap = gaps(compliance, free, &force, approach);
        let force_scale = load / active.iter().filter(|&&a| a).count() as f64;
        // Positive entries violate their condition, in units of the problem's own scale.
        let wrong: Vec<f64> = (0..free.len())
            .map(|i| {
                if active[i] {
                    -force[i] / force_scale
                } else {
                    -gap[i] / scale
                }
            })
            .collect();
        if wrong.iter().all(|&w| w <= tolerance) {
            return Ok(Contact {
                force,
                approach,
                active,
            });
        }
        seen.push(active.clone());
        for i in 0..active.len() {
            if wrong[i] > tolerance {
                active[i] = !active[i];
            }
        }
        if !active.iter().any(|&a| a) {
            active[lowest(free)] = true;
        }
    }
    pivoting::solve(problem, &active, settings, watch)
}

fn lowest(values: &[f64]) -> usize {
    let mut best = 0;
    for (i, value) in values.iter().enumerate() {
        if *value < values[best] {
            best = i;
        }
    }
    best
}

impl Linearised<'_> {
    /// Scale of the border like the compliance's, so that pivoting sees comparable rows.
    pub(super) fn border(&self, set: &[usize]) -> f64 {
        self.compliance[(set[0], set[0])].abs().max(1e-300)
    }

    /// The compliance between the nodes of `set`, with the approach and the sum of forces.
    pub(super) fn bordered(&self, set: &[usize]) -> Matrix<f64> {
        let (n, border) = (set.len(), self.border(set));
        Matrix::from_fn(n + 1, n + 1, |i, j| {
            if i < n && j < n {
                self.compliance[(set[i], set[j])]
            } else if i < n || j < n {
                border * if i < n { -1.0 } else { 1.0 }
            } else {
                0.0
            }
        })
    }

    /// Forces and approach where just these nodes touch; None if they cannot be told.
    fn on_set(
        &self,
        active: &[bool],
        watch: &Watch<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Status> {
        let set: Vec<usize> = (0..active.len()).filter(|&i| active[i]).collect();
        let border = self.border(&set);
        let mut right: Vec<f64> = set.iter().map(|&i| -self.free[i]).collect();
        right.push(border * self.load);
        let Some(solution) = solve_dense(&self.bordered(&set), &right, watch)? else {
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
    compliance: &Matrix<f64>,
    free: &[f64],
    force: &[f64],
    approach: f64,
) -> Vec<f64> {
    let mut gap: Vec<f64> = free.iter().map(|g| g - approach).collect();
    for (j, &f) in force.iter().enumerate() {
        if f != 0.0 {
            for (i, g) in gap.iter_mut().enumerate() {
                *g += compliance[(i, j)] * f;
            }
        }
    }
    gap
}
