//! The linearised contact problem: a linear complementarity problem with one border.
//!
//! Find forces f >= 0 and the approach d with
//!     gap = free gap + C f - d >= 0,   gap . f = 0,   sum f = load.
//! For a given active set it is linear (`active_set_system`). The set is found by the primal-dual
//! active set method (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865). If the sets repeat,
//! `pivoting` continues from the last one.

use super::active_set_system::ActiveSetSystem;
use super::complementarity_problem::{ComplementarityProblem, Contact};
use super::pivoting;
use crate::executor::Executor;
use crate::settings::Settings;
use crate::status::Status;

/// Changes of the whole active set before nodes enter and leave it one by one, along a path that finds a
/// set if there is one.
const ROUNDS: usize = 60;
/// Largest tension and overlap, in units of the mean contact force and the largest gap.
pub const ACTIVE_SET_TOLERANCE: f64 = 1e-12;

/// Solve, beginning with the active set `start`; also the linear system of the set that was found.
/// `NoActiveSet` if no set satisfies the conditions.
pub fn solve<'a>(
    problem: &ComplementarityProblem<'a, '_>,
    start: &[bool],
    settings: &Settings,
    executor: &Executor<'_>,
) -> Result<(Contact, ActiveSetSystem<'a>), Status> {
    let &ComplementarityProblem { free_gap, load, .. } = problem;
    let mut active_set = start.to_vec();
    if !active_set.contains(&true) {
        active_set[lowest(free_gap)] = true;
    }
    let mut visited: Vec<Vec<bool>> = Vec::new();
    let gap_scale = free_gap.iter().fold(1e-300_f64, |m, g| m.max(g.abs()));
    while visited.len() < ROUNDS && !visited.contains(&active_set) {
        // Solve on the set.
        let (contact, system) = solve_on_active_set(problem, &active_set, settings, executor)?;
        let force = &contact.force;
        let gap = problem.gaps(force, contact.approach);
        let force_scale = load / active_set.iter().filter(|&&a| a).count() as f64;
        // Measure the violation of each node's condition: positive where it is violated.
        let violation: Vec<f64> = (0..free_gap.len())
            .map(|i| if active_set[i] { -force[i] / force_scale } else { -gap[i] / gap_scale })
            .collect();
        if violation.iter().all(|&v| v <= ACTIVE_SET_TOLERANCE) {
            return Ok((contact, system));
        }
        // The nodes that violate it change sides.
        visited.push(active_set.clone());
        for (active, violation) in active_set.iter_mut().zip(violation) {
            if violation > ACTIVE_SET_TOLERANCE {
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
    let contact = Contact { force, approach, active_set: active_set.to_vec() };
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
