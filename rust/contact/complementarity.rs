//! The linearised contact problem, solved exactly: a dense complementarity problem with one border.
//!
//! Find forces f >= 0 and the approach d with
//!     gap = free + C f - d >= 0,   gap . f = 0,   sum f = load.
//! Primal-dual active set (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865); when it
//! repeats itself, only the worst node changes sides, which ends on the P-matrices of contact.

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

/// Solve from the active set `start`; `NoActiveSet` if none satisfies the conditions.
pub fn solve(
    compliance: &Matrix<f64>,
    free: &[f64],
    load: f64,
    start: &[bool],
    settings: &Settings,
    watch: &Watch<'_>,
) -> Result<Contact, Status> {
    let (rounds, tolerance) = (settings.active_set_rounds, settings.active_set_tolerance);
    let mut active = start.to_vec();
    if !active.iter().any(|&a| a) {
        active[lowest(free)] = true;
    }
    let mut seen: Vec<Vec<bool>> = Vec::new();
    let scale = free.iter().fold(1e-300_f64, |m, g| m.max(g.abs()));
    for round in 0..rounds + settings.single_node_rounds {
        let solved = on_set(compliance, free, load, &active, watch)?;
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
        let repeated = round >= rounds || seen.contains(&active);
        seen.push(active.clone());
        if repeated {
            let worst = lowest(&wrong.iter().map(|w| -w).collect::<Vec<_>>());
            active[worst] = !active[worst];
        } else {
            for i in 0..active.len() {
                if wrong[i] > tolerance {
                    active[i] = !active[i];
                }
            }
        }
        if !active.iter().any(|&a| a) {
            active[lowest(free)] = true;
        }
    }
    Err(Status::NoActiveSet)
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

fn on_set(
    compliance: &Matrix<f64>,
    free: &[f64],
    load: f64,
    active: &[bool],
    watch: &Watch<'_>,
) -> Result<Option<(Vec<f64>, f64)>, Status> {
    let set: Vec<usize> = (0..active.len()).filter(|&i| active[i]).collect();
    let n = set.len();
    // Scale the border like the compliance so that pivoting sees comparable rows.
    let border = compliance[(set[0], set[0])].abs().max(1e-300);
    let matrix = Matrix::from_fn(n + 1, n + 1, |i, j| {
        if i < n && j < n {
            compliance[(set[i], set[j])]
        } else if i < n || j < n {
            border * if i < n { -1.0 } else { 1.0 }
        } else {
            0.0
        }
    });
    let mut right: Vec<f64> = set.iter().map(|&i| -free[i]).collect();
    right.push(border * load);
    let Some(solution) = solve_dense(&matrix, &right, watch)? else {
        return Ok(None);
    };
    let mut force = vec![0.0; active.len()];
    for (&i, &f) in set.iter().zip(&solution) {
        force[i] = f;
    }
    Ok(Some((force, border * solution[n])))
}

fn gaps(compliance: &Matrix<f64>, free: &[f64], force: &[f64], approach: f64) -> Vec<f64> {
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
