//! Newton's method for one load, on the linearised problem of the block in contact.
//!
//! It is solved by iteration, no better than pays: to the share of the forces out of balance
//! (Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2)
//!     eta = gamma (residual / residual before)^2,   at least gamma eta_before^2 where that is large.

use super::balance::Balance;
use super::increment::{Increment, Now};
use super::krylov::{self, Accuracy};
use super::next_set::next_set;
use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::linear::add;
use crate::material::kinematics::Deformation;
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

/// What to do where a whole step would go too far.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Cut {
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
    iterate(pressed, state, load, settings, Cut::Shorten, |now| {
        share = forcing(share, now.residual / before, settings);
        before = now.residual;
        let least = ITERATED_TO * settings.residual_tolerance * load.min(1.0);
        let accuracy = Accuracy { share, least };
        let set = next_set(now, settings);
        krylov::increment(pressed, now, set.as_deref(), load, accuracy, settings)
    })
}

/// Iterate on `state` by increments as `next` finds them.
pub(super) fn iterate(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
    cut: Cut,
    mut next: impl FnMut(Now<'_>) -> Result<Increment, Status>,
) -> Report {
    let mut report = Report {
        status: Status::Converged,
        iterations: 0,
        products: 0,
        residual: f64::INFINITY,
    };
    let mut run = || -> Result<(), Status> {
        let mut rows = pressed.row_states(&state.field)?;
        let (mut best, mut best_at) = (f64::INFINITY, 0);
        loop {
            let balance = Balance::new(pressed, state, &rows)?;
            let residual = balance.residual(pressed, state, load);
            report.residual = residual;
            if !residual.is_finite() {
                return Err(Status::NotFinite);
            }
            if residual < settings.residual_tolerance {
                return Ok(());
            }
            if residual < best {
                (best, best_at) = (residual, report.iterations);
            }
            let stalled = report.iterations >= best_at + settings.patience;
            if stalled || report.iterations >= settings.max_iterations {
                return Err(Status::IterationLimit);
            }
            report.iterations += 1;
            let increment = next(Now {
                state,
                rows: &rows,
                balance: &balance,
                residual,
            })?;
            report.products += increment.products;
            step(pressed, increment, state, &mut rows, settings, cut)?;
        }
    };
    if let Err(status) = run() {
        report.status = status;
    }
    report
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
/// over, as `cut` says.
fn step(
    pressed: &PressedBlock<'_>,
    increment: Increment,
    state: &mut State,
    rows: &mut Vec<RowState>,
    settings: &Settings,
    cut: Cut,
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
    let mut share = match cut {
        Cut::Shorten => (settings.largest_step / largest_gradient(pressed, &u)?).min(1.0),
        Cut::GiveUp => 1.0,
    };
    for _ in 0..settings.step_halvings {
        let mut trial = state.field.clone();
        add(&mut trial.u, share, &u);
        let trial_rows = pressed.row_states(&trial)?;
        let far = || largest_change(rows, &trial_rows) > settings.largest_step;
        if cut == Cut::GiveUp && (share < 1.0 || far()) {
            return Err(Status::IterationLimit);
        }
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

/// Of the displacement gradient between two states of the rows.
fn largest_change(from: &[RowState], to: &[RowState]) -> f64 {
    let pairs = points(from).zip(points(to));
    let changes = pairs.flat_map(|(from, to)| (0..4).map(move |k| (to.f[k] - from.f[k]).abs()));
    changes.fold(0.0, f64::max)
}

fn smallest_jacobian(rows: &[RowState]) -> f64 {
    points(rows)
        .map(|point| point.j)
        .fold(f64::INFINITY, f64::min)
}

fn points(rows: &[RowState]) -> impl Iterator<Item = &Deformation> {
    rows.iter().flat_map(|row| row.deformation.iter().flatten())
}
