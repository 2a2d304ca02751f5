//! The linearised contact problem (`touching`), solved exactly: which nodes touch.
//!
//! Primal-dual active set (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865); where it
//! repeats itself, `pivoting` goes on from there.

use super::held::Held;
use super::pivoting;
use super::touching::{gaps, Contact, Linearised};
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

/// Solve from the active set `start`, the nodes that touch in the end held; `NoActiveSet` if no set
/// satisfies the conditions.
pub fn solve<'a>(
    problem: &Linearised<'a, '_>,
    start: &[bool],
    settings: &Settings,
    watch: &Watch<'_>,
) -> Result<(Contact, Held<'a>), Status> {
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
        let (contact, held) = on_set(problem, &active, settings, watch)?;
        let force = &contact.force;
        let gap = gaps(compliance, free, force, contact.approach);
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
            return Ok((contact, held));
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

/// Solve with just the nodes `active` in contact, whatever the signs of forces and gaps.
pub fn on_set<'a>(
    problem: &Linearised<'a, '_>,
    active: &[bool],
    settings: &Settings,
    watch: &Watch<'_>,
) -> Result<(Contact, Held<'a>), Status> {
    let held = Held::new(problem.compliance, active, settings)?;
    let solved = held.close(problem.free, problem.load, watch)?;
    let (force, approach) = solved.ok_or(Status::NoActiveSet)?;
    let contact = Contact {
        force,
        approach,
        active: active.to_vec(),
    };
    Ok((contact, held))
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
