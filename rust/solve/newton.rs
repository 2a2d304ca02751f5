//! Newton's method for one load, on the linearised problem of the block in contact.
//!
//! The linearised problem is solved by iteration, only as accurately as pays: to the share
//!     eta = gamma (residual / residual before)^2,   at least gamma eta_before^2 if that is large,
//! of the residual forces (Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2).
//!
//! Which nodes the next step keeps in contact is decided in two ways. Far from convergence the
//! complementarity problem with the averaged compliance predicts the whole active set. Near convergence
//! the signs of forces and gaps decide: this is the primal-dual active set method, which is Newton's
//! method for the exact problem (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865). The averaged
//! compliance is not exact, and under pressures of the order of the modulus it differs so much from that of
//! the block at an edge that its predictions may cycle.

use super::krylov::{self, Accuracy};
use super::newton_step::{Increment, Iterate};
use super::residual::Residual;
use crate::contact::linear_complementarity::ACTIVE_SET_TOLERANCE;
use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::linear::add;
use crate::material::kinematics::Deformation;
use crate::settings::Settings;
use crate::solution::Report;
use crate::status::Status;

/// Smallest share of the residual forces to which the linearised problem is solved.
const LEAST_SHARE: f64 = 1e-5;
/// The share over the square of the last ratio of residuals.
const GAMMA: f64 = 0.9;
/// Residual below which the signs of forces and gaps decide the next active set.
const SIGNS_BELOW: f64 = 0.005;
/// Lengths tried for one Newton step, each half of the one before.
const STEP_LENGTHS: usize = 8;

/// The linearised problem is not solved below this share of the residual tolerance.
const LEAST_SHARE_OF_TOLERANCE: f64 = 0.1;

/// What to do with a step that is too long.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum LongStep {
    Shorten,
    GiveUp,
}

/// Iterate on `state` under `load` (mean pressure times one wavelength).
pub fn solve(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
) -> Report {
    let (mut share, mut before) = (settings.krylov_share, f64::INFINITY);
    iterate(pressed, state, load, settings, LongStep::Shorten, |iterate| {
        share = forcing_share(share, iterate.residual_norm / before, settings);
        before = iterate.residual_norm;
        let least = LEAST_SHARE_OF_TOLERANCE * settings.residual_tolerance * load.min(1.0);
        let accuracy = Accuracy { share, least };
        let active_set =
            if iterate.residual_norm > SIGNS_BELOW { None } else { active_set_by_signs(iterate) };
        krylov::increment(pressed, iterate, active_set.as_deref(), load, accuracy, settings)
    })
}

/// Iterate on `state` by the increments that `next` computes.
pub(super) fn iterate(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
    long_step: LongStep,
    mut next: impl FnMut(Iterate<'_>) -> Result<Increment, Status>,
) -> Report {
    let mut report = Report { residual: f64::INFINITY, ..Report::unsolved(Status::Converged) };
    let mut run = || -> Result<(), Status> {
        let mut rows = pressed.row_states(&state.field)?;
        let (mut best, mut best_at) = (f64::INFINITY, 0);
        loop {
            // Judge the state by its residual.
            let residual = Residual::new(pressed, state, &rows)?;
            let residual_norm = residual.norm(pressed, state, load);
            report.residual = residual_norm;
            if !residual_norm.is_finite() {
                return Err(Status::NotFinite);
            }
            if residual_norm < settings.residual_tolerance {
                return Ok(());
            }
            if residual_norm < best {
                (best, best_at) = (residual_norm, report.iterations);
            }
            let stalled = report.iterations >= best_at + settings.patience;
            if stalled || report.iterations >= settings.max_iterations {
                return Err(Status::IterationLimit);
            }
            // Solve the linearised problem and step.
            report.iterations += 1;
            let increment =
                next(Iterate { state, rows: &rows, residual: &residual, residual_norm })?;
            report.products += increment.products;
            step(pressed, increment, state, &mut rows, settings, long_step)?;
        }
    };
    match run() {
        Ok(()) => report.load_reached = 1.0,
        Err(status) => report.status = status,
    }
    report
}

/// The share to which the residual forces are reduced, from the last share and the last `ratio` of
/// residuals.
fn forcing_share(last: f64, ratio: f64, settings: &Settings) -> f64 {
    let cautious = GAMMA * last * last;
    let next = GAMMA * ratio * ratio;
    let next = if cautious > 0.1 { next.max(cautious) } else { next };
    next.clamp(LEAST_SHARE, settings.krylov_share)
}

/// The active set by the signs of forces and gaps; None if it would be empty.
fn active_set_by_signs(iterate: Iterate<'_>) -> Option<Vec<bool>> {
    let (state, gap) = (iterate.state, &iterate.residual.gap);
    let count = state.active_set.iter().filter(|&&active| active).count();
    let force_scale = state.force.iter().sum::<f64>() / count as f64;
    let gap_scale = gap.iter().fold(0.0_f64, |most, gap| most.max(gap.abs()));
    let in_contact = |a: usize| match state.active_set[a] {
        true => state.force[a] >= -ACTIVE_SET_TOLERANCE * force_scale,
        false => gap[a] < -ACTIVE_SET_TOLERANCE * gap_scale,
    };
    let active_set: Vec<bool> = (0..gap.len()).map(in_contact).collect();
    active_set.contains(&true).then_some(active_set)
}

/// One Newton step by `increment`, limited in displacement gradient and kept from inverting elements, by
/// the means that `long_step` names.
fn step(
    pressed: &PressedBlock<'_>,
    increment: Increment,
    state: &mut State,
    rows: &mut Vec<RowState>,
    settings: &Settings,
    long_step: LongStep,
) -> Result<(), Status> {
    let Increment { u, pressure, contact, .. } = increment;
    if u.iter().any(|value| !value.is_finite()) {
        return Err(Status::NotFinite);
    }
    let mut share = match long_step {
        LongStep::Shorten => (settings.largest_step / largest_gradient(pressed, &u)?).min(1.0),
        LongStep::GiveUp => 1.0,
    };
    for _ in 0..STEP_LENGTHS {
        let mut trial = state.field.clone();
        add(&mut trial.u, share, &u);
        let trial_rows = pressed.row_states(&trial)?;
        let too_long = || largest_change(rows, &trial_rows) > settings.largest_step;
        if long_step == LongStep::GiveUp && (share < 1.0 || too_long()) {
            return Err(Status::IterationLimit);
        }
        if smallest_jacobian(&trial_rows) > settings.smallest_volume_ratio {
            add(&mut trial.pressure, share, &pressure);
            for (f, new) in state.force.iter_mut().zip(&contact.force) {
                *f += share * (new - *f);
            }
            state.approach += share * (contact.approach - state.approach);
            state.active_set = contact.active_set;
            state.field = trial;
            *rows = trial_rows;
            return Ok(());
        }
        share *= 0.5;
    }
    Err(Status::ElementInverted)
}

/// Norm of the residual of a state; infinite if it has none.
pub fn residual_norm(pressed: &PressedBlock<'_>, state: &State, load: f64) -> f64 {
    let rows = pressed.row_states(&state.field);
    let residual = rows.and_then(|rows| Residual::new(pressed, state, &rows));
    let norm = residual.map(|residual| residual.norm(pressed, state, load));
    norm.map_or(f64::INFINITY, |r| if r.is_nan() { f64::INFINITY } else { r })
}

fn largest_gradient(pressed: &PressedBlock<'_>, du: &[f64]) -> Result<f64, Status> {
    let (block, mesh) = (&pressed.block, pressed.mesh());
    let of_row = |row: usize| {
        let gradients = block.gradients(row, du, 0.0).into_iter().flatten();
        gradients.flatten().fold(1e-300, larger)
    };
    let of_rows = pressed.executor.map(12 * mesh.points(), mesh.rows, of_row)?;
    Ok(of_rows.into_iter().fold(1e-300, larger))
}

fn larger(a: f64, b: f64) -> f64 {
    a.max(b.abs())
}

/// Largest change of the displacement gradient between two states of the rows.
fn largest_change(from: &[RowState], to: &[RowState]) -> f64 {
    let pairs = points(from).zip(points(to));
    let changes = pairs.flat_map(|(from, to)| (0..4).map(move |k| (to.f[k] - from.f[k]).abs()));
    changes.fold(0.0, f64::max)
}

fn smallest_jacobian(rows: &[RowState]) -> f64 {
    points(rows).map(|point| point.j).fold(f64::INFINITY, f64::min)
}

fn points(rows: &[RowState]) -> impl Iterator<Item = &Deformation> {
    rows.iter().flat_map(|row| row.deformation.iter().flatten())
}
