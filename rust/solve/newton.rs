//! Newton's method for one load: tangent, condensation to the surface, exact linearised contact.
//!
//! The factored block is kept as long as it makes the residual fall fast enough (modified Newton).

use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::linear::Elimination;
use crate::material::kinematics::jacobian;
use crate::settings::Settings;
use crate::status::Status;

#[derive(Debug, Clone, Copy)]
pub struct Report {
    pub status: Status,
    pub iterations: usize,
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

/// A factored block and the state it was factored at. The volume change keeps the slope of that
/// state too: with a bulk modulus of hundreds of shear moduli a mixture of slopes would not converge.
pub struct Factored {
    elimination: Elimination,
    rows: Vec<RowState>,
}

/// Iterate on `state` under `load` (mean pressure times one wavelength), starting from the factored
/// block in `kept` and leaving the last one there.
pub fn solve(
    pressed: &PressedBlock<'_>,
    kept: &mut Option<Factored>,
    state: &mut State,
    load: f64,
    settings: &Settings,
) -> Report {
    let mut report = Report {
        status: Status::Converged,
        iterations: 0,
        residual: f64::INFINITY,
    };
    if let Err(status) = iterate(pressed, kept, state, load, settings, &mut report) {
        report.status = status;
    }
    report
}

fn iterate(
    pressed: &PressedBlock<'_>,
    kept: &mut Option<Factored>,
    state: &mut State,
    load: f64,
    settings: &Settings,
    report: &mut Report,
) -> Result<(), Status> {
    let mut rows = pressed.row_states(&state.field)?;
    let (mut best, mut best_at) = (f64::INFINITY, 0);
    loop {
        let before = report.residual;
        report.residual = residual(pressed, state, &rows, load);
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
        let falling = before.is_infinite() || report.residual < settings.reuse_reduction * before;
        if !(falling && report.residual < settings.reuse_below) {
            *kept = None;
        }
        report.iterations += 1;
        step(pressed, kept, state, &mut rows, load, settings)?;
    }
}

/// One Newton step, limited in displacement gradient and kept from turning elements over.
fn step(
    pressed: &PressedBlock<'_>,
    kept: &mut Option<Factored>,
    state: &mut State,
    rows: &mut Vec<RowState>,
    load: f64,
    settings: &Settings,
) -> Result<(), Status> {
    let (block, watch) = (&pressed.block, pressed.watch);
    let factored = match kept {
        Some(factored) => factored,
        None => kept.insert(factor(pressed, state, rows)?),
    };
    let rights: Vec<Vec<f64>> = (0..rows.len())
        .map(|row| block.row_right(row, &state.field, &rows[row], &factored.rows[row]))
        .collect();
    let elimination = &factored.elimination;
    let reduced = elimination.reduce(&rights, watch)?;
    let (surface, contact) =
        pressed.linearised_contact(state, elimination, &reduced.surface_right, load, settings)?;
    let mut du = elimination.expand(&reduced, &surface, watch)?;
    du.resize(state.field.u.len(), 0.0);
    if du.iter().any(|value| !value.is_finite()) {
        return Err(Status::NotFinite);
    }
    let mut share = (settings.largest_step / largest_gradient(pressed, &du)).min(1.0);
    for _ in 0..settings.step_halvings {
        let mut trial = state.field.clone();
        for (u, d) in trial.u.iter_mut().zip(&du) {
            *u += share * d;
        }
        let trial_rows = pressed.row_states(&trial)?;
        if smallest_jacobian(&trial_rows) > settings.smallest_volume_ratio {
            for (row, (now, old)) in rows.iter().zip(&factored.rows).enumerate() {
                block.update_pressure(row, now, old, &du, share, &mut trial);
            }
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

fn factor(
    pressed: &PressedBlock<'_>,
    state: &State,
    rows: &[RowState],
) -> Result<Factored, Status> {
    let (block, watch) = (&pressed.block, pressed.watch);
    let matrix = |row: usize| block.row_matrix(row, &state.field, &rows[row], watch);
    let uppermost = pressed.mesh().rows - 1;
    let layer = pressed.mesh().layer_size();
    let below = (0..uppermost).rev().map(matrix);
    Ok(Factored {
        elimination: Elimination::new(layer, matrix(uppermost)?, below, watch)?,
        rows: rows.to_vec(),
    })
}

/// The residual of a state that nothing was done to; infinite where it has none.
pub fn missed(pressed: &PressedBlock<'_>, state: &State, load: f64) -> f64 {
    let found = pressed.row_states(&state.field);
    let residual = found.map(|rows| residual(pressed, state, &rows, load));
    residual.map_or(
        f64::INFINITY,
        |r| if r.is_nan() { f64::INFINITY } else { r },
    )
}

/// Forces out of balance relative to the load, gaps relative to half the range: the largest.
fn residual(pressed: &PressedBlock<'_>, state: &State, rows: &[RowState], load: f64) -> f64 {
    let mesh = pressed.mesh();
    let layer = mesh.layer_size();
    let mut forces = vec![0.0; state.field.u.len()];
    let mut volume_error = 0.0;
    for (row, row_state) in rows.iter().enumerate() {
        let (local, error) = pressed.block.row_forces(row, &state.field, row_state);
        let offset = row * mesh.order * layer;
        for (total, force) in forces[offset..].iter_mut().zip(&local) {
            *total += force;
        }
        volume_error += error;
    }
    let mut gap_error = 0.0_f64;
    let x = pressed.abscissae(&state.field);
    for (a, gap) in pressed.gaps(state, &x).into_iter().enumerate() {
        forces[mesh.place(a, 0)] += state.force[a] * pressed.heights.slope(x[a]);
        forces[mesh.place(a, 1)] -= state.force[a];
        let violated = if state.active[a] { gap.abs() } else { -gap };
        gap_error = gap_error.max(violated);
    }
    let free = forces.len() - layer;
    let unbalanced = forces[..free].iter().map(|f| f * f).sum::<f64>().sqrt() / load;
    let total = (state.force.iter().sum::<f64>() / load - 1.0).abs();
    let overlap = gap_error / pressed.heights.half_range();
    // f64::max would drop a NaN.
    let all = [unbalanced, total, volume_error.sqrt(), overlap];
    if all.iter().any(|v| v.is_nan()) {
        return f64::NAN;
    }
    all.into_iter().fold(0.0, f64::max)
}

fn largest_gradient(pressed: &PressedBlock<'_>, du: &[f64]) -> f64 {
    (0..pressed.mesh().rows)
        .flat_map(|row| pressed.block.gradients(row, du, 0.0))
        .flatten()
        .flatten()
        .fold(1e-300, |m: f64, value| m.max(value.abs()))
}

fn smallest_jacobian(rows: &[RowState]) -> f64 {
    rows.iter()
        .flat_map(|row| row.gradient.iter().flatten())
        .map(jacobian)
        .fold(f64::INFINITY, f64::min)
}
