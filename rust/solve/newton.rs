//! Newton's method for one load, on the linearised problem of the block in contact.
//!
//! It is solved by iteration, no better than pays: to the share of the forces out of balance
//! (Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2)
//!     eta = gamma (residual / residual before)^2,   at least gamma eta_before^2 where that is large.

use super::balance::Balance;
use super::increment::Increment;
use super::krylov::{self, Accuracy};
use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::settings::Settings;
use crate::status::Status;

/// Share of the residual allowed below which the linearised problem is not solved.
const ITERATED_TO: f64 = 0.1;

#[derive(Debug, Clone, Copy)]
pub struct Report {
    pub status: Status,
    pub iterations: usize,
    /// Products with the Jacobian that the iterations took.
    pub products: usize,
    /// Largest of the forces out of balance over the load and the gaps over half the range.
    pub residual: f64,
}

impl Report {
    /// Refuse to go on from what did not converge.
    pub fn converged(&self) -> Result<(), Status> {
        match self.status {
            Status::Converged => Ok(()),
            other => Err(other),
        }
    }
}

/// Iterate on `state` under `load` (mean pressure times one wavelength).
pub fn solve(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
) -> Report {
    let mut report = Report {
        status: Status::Converged,
        iterations: 0,
        products: 0,
        residual: f64::INFINITY,
    };
    if let Err(status) = iterate(pressed, state, load, settings, &mut report) {
        report.status = status;
    }
    report
}

fn iterate(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
    report: &mut Report,
) -> Result<(), Status> {
    let mut rows = pressed.row_states(&state.field)?;
    let (mut best, mut best_at) = (f64::INFINITY, 0);
    let mut share = settings.krylov_share;
    loop {
        let before = report.residual;
        let balance = Balance::new(pressed, state, &rows)?;
        report.residual = balance.residual(pressed, state, load);
        if !report.residual.is_finite() {
            return Err(Status::NotFinite);
        }
        if report.residual < settings.residual_tolerance {
            return Ok(());
        }
        if report.residual < best {
            (best, best_at) = (report.residual, report.iterations);
        }
        let stalled = report.iterations >= best_at + settings.patience;
        if stalled || report.iterations >= settings.max_iterations {
            return Err(Status::IterationLimit);
        }
        report.iterations += 1;
        share = forcing(share, report.residual / before, settings);
        let least = ITERATED_TO * settings.residual_tolerance * load.min(1.0);
        let accuracy = Accuracy { share, least };
        let increment =
            krylov::increment(pressed, state, &rows, &balance, load, accuracy, settings)?;
        report.products += increment.products;
        step(pressed, increment, state, &mut rows, settings)?;
    }
}

/// The share to which forces out of balance are to fall, from the last one and what came of it.
fn forcing(last: f64, ratio: f64, settings: &Settings) -> f64 {
    let gamma = settings.krylov_safety;
    let careful = gamma * last * last;
    let next = gamma * ratio * ratio;
    let next = if careful > 0.1 {
        next.max(careful)
    } else {
        next
    };
    next.clamp(settings.krylov_least_share, settings.krylov_share)
}

/// One Newton step by `increment`, limited in displacement gradient and kept from turning elements
/// over.
fn step(
    pressed: &PressedBlock<'_>,
    increment: Increment,
    state: &mut State,
    rows: &mut Vec<RowState>,
    settings: &Settings,
) -> Result<(), Status> {
    let Increment {
        u,
        pressure,
        contact,
        ..
    } = increment;
    if u.iter().any(|value| !value.is_finite()) {
        return Err(Status::NotFinite);
    }
    let mut share = (settings.largest_step / largest_gradient(pressed, &u)?).min(1.0);
    for _ in 0..settings.step_halvings {
        let mut trial = state.field.clone();
        add(&mut trial.u, share, &u);
        let trial_rows = pressed.row_states(&trial)?;
        if smallest_jacobian(&trial_rows) > settings.smallest_volume_ratio {
            add(&mut trial.pressure, share, &pressure);
            for (f, new) in state.force.iter_mut().zip(&contact.force) {
                *f += share * (new - *f);
            }
            state.approach += share * (contact.approach - state.approach);
            state.active = contact.active;
            state.field = trial;
            *rows = trial_rows;
            return Ok(());
        }
        share *= 0.5;
    }
    Err(Status::ElementInverted)
}

fn add(to: &mut [f64], share: f64, change: &[f64]) {
    for (to, change) in to.iter_mut().zip(change) {
        *to += share * change;
    }
}

/// The residual of a state that nothing was done to; infinite where it has none.
pub fn missed(pressed: &PressedBlock<'_>, state: &State, load: f64) -> f64 {
    let rows = pressed.row_states(&state.field);
    let balance = rows.and_then(|rows| Balance::new(pressed, state, &rows));
    let residual = balance.map(|balance| balance.residual(pressed, state, load));
    residual.map_or(
        f64::INFINITY,
        |r| if r.is_nan() { f64::INFINITY } else { r },
    )
}

fn largest_gradient(pressed: &PressedBlock<'_>, du: &[f64]) -> Result<f64, Status> {
    let (block, mesh) = (&pressed.block, pressed.mesh());
    let of_row = |row: usize| {
        let gradients = block.gradients(row, du, 0.0).into_iter().flatten();
        gradients.flatten().fold(1e-300, larger)
    };
    let rows = pressed.watch.map(12 * mesh.points(), mesh.rows, of_row)?;
    Ok(rows.into_iter().fold(1e-300, larger))
}

fn larger(a: f64, b: f64) -> f64 {
    a.max(b.abs())
}

fn smallest_jacobian(rows: &[RowState]) -> f64 {
    rows.iter()
        .flat_map(|row| row.deformation.iter().flatten())
        .map(|point| point.j)
        .fold(f64::INFINITY, f64::min)
}
