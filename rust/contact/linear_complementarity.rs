//! The linearised contact problem: a linear complementarity problem with one border.
//!
//! Find forces f >= 0 and the approach d with
//!     gap = free gap + C f - d >= 0,   gap . f = 0,   sum f = load.
//! For a given active set it is linear (`active_set_system`). The set is found by the primal-dual
//! active set method (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865). If the sets repeat,
//! `pivoting` continues from the last one.

use super::active_set_system::ActiveSetSystem;
use super::pivoting;
use crate::executor::Executor;
use crate::settings::Settings;
use crate::status::Status;

/// A solution: forces and approach, and the nodes in contact.
#[derive(Debug, Clone)]
pub struct Contact {
    pub force: Vec<f64>,
    pub approach: f64,
    pub active_set: Vec<bool>,
}

/// What forces at the nodes add to the gaps.
pub trait Compliance: Sync {
    /// What a unit force at node `from` adds to the gap of node `to`.
    fn entry(&self, to: usize, from: usize) -> f64;

    /// Add C `force` to `gap`.
    fn add_opening(&self, force: &[f64], gap: &mut [f64]);

    /// An approximate inverse of C, for openings of the `active_nodes`; None if there is none.
    fn approximate_inverse(&self, _active_nodes: &[usize]) -> Option<ApproximateInverse<'_>> {
        None
    }
}

/// From openings to forces, at every node.
pub type ApproximateInverse<'a> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>;

#[derive(Clone, Copy)]
pub struct ComplementarityProblem<'c, 'g> {
    pub compliance: &'c dyn Compliance,
    /// Gaps without forces and approach.
    pub free_gap: &'g [f64],
    pub load: f64,
}

impl ComplementarityProblem<'_, '_> {
    /// Gaps under `force` at `approach`.
    pub fn gaps(&self, force: &[f64], approach: f64) -> Vec<f64> {
        let mut gap: Vec<f64> = self.free_gap.iter().map(|g| g - approach).collect();
        self.compliance.add_opening(force, &mut gap);
        gap
    }
}

/// Solve, beginning with the active set `start`; also the linear system of the set that was found.
/// `NoActiveSet` if no set satisfies the conditions.
pub fn solve<'a>(
    problem: &ComplementarityProblem<'a, '_>,
    start: &[bool],
    settings: &Settings,
    executor: &Executor<'_>,
) -> Result<(Contact, ActiveSetSystem<'a>), Status> {
    let &ComplementarityProblem { free_gap, load, .. } = problem;
    let tolerance = settings.active_set_tolerance;
    let mut active_set = start.to_vec();
    if !active_set.contains(&true) {
        active_set[lowest(free_gap)] = true;
    }
    let mut visited: Vec<Vec<bool>> = Vec::new();
    let gap_scale = free_gap.iter().fold(1e-300_f64, |m, g| m.max(g.abs()));
    while visited.len() < settings.active_set_rounds && !visited.contains(&active_set) {
        let (contact, system) = solve_on_active_set(problem, &active_set, settings, executor)?;
        let force = &contact.force;
        let gap = problem.gaps(force, contact.approach);
        let force_scale = load / active_set.iter().filter(|&&a| a).count() as f64;
        // Positive entries violate their condition.
        let violation: Vec<f64> = (0..free_gap.len())
            .map(|i| {
                if active_set[i] {
                    -force[i] / force_scale
                } else {
                    -gap[i] / gap_scale
                }
            })
            .collect();
        if violation.iter().all(|&v| v <= tolerance) {
            return Ok((contact, system));
        }
        visited.push(active_set.clone());
        for (active, violation) in active_set.iter_mut().zip(violation) {
            if violation > tolerance {
                *active = !*active;
            }
        }
        if !active_set.contains(&true) {
            active_set[lowest(free_gap)] = true;
        }
    }
    pivoting::solve(problem, &active_set, settings, executor)
}

/// Solve with exactly the nodes of `active_set` in contact, whatever the signs of forces and gaps.
pub fn solve_on_active_set<'a>(
    problem: &ComplementarityProblem<'a, '_>,
    active_set: &[bool],
    settings: &Settings,
    executor: &Executor<'_>,
) -> Result<(Contact, ActiveSetSystem<'a>), Status> {
    let system = ActiveSetSystem::new(problem.compliance, active_set, settings)?;
    let solution = system.solve(problem.free_gap, problem.load, executor)?;
    let (force, approach) = solution.ok_or(Status::NoActiveSet)?;
    let contact = Contact {
        force,
        approach,
        active_set: active_set.to_vec(),
    };
    Ok((contact, system))
}

/// Index of the smallest value, the first of equals.
fn lowest(values: &[f64]) -> usize {
    let mut best = 0;
    for (i, value) in values.iter().enumerate() {
        if *value < values[best] {
            best = i;
        }
    }
    best
}
