//! Newton's method for one load: tangent, condensation to the surface, exact linearised contact.
//!
//! The factored block is kept as long as it makes the residual fall fast enough (modified Newton).

use crate::assembly::{Block, Field, RowState};
use crate::cell::Cell;
use crate::linear::Elimination;
use crate::network;
use crate::wave::Wave;

/// Everything that changes while solving.
#[derive(Debug, Clone)]
pub struct State {
    pub field: Field,
    /// Vertical contact force of every surface node.
    pub force: Vec<f64>,
    pub active: Vec<bool>,
    /// How far the wave is pushed up into the block.
    pub approach: f64,
}

impl State {
    pub fn at_rest(cell: &Cell) -> Self {
        Self {
            field: Field::at_rest(cell),
            force: vec![0.0; cell.layer_nodes()],
            active: vec![false; cell.layer_nodes()],
            approach: 0.0,
        }
    }
}

/// Iterations without a smaller residual after which a load step is given up.
const PATIENCE: usize = 12;

/// The factored block is kept while the residual is below the first and falls to this share of
/// itself in every iteration.
const KEEP_FROM: f64 = 0.1;
const KEEP_BELOW: f64 = 0.3;

#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Newton iterations in one load step.
    pub iterations: usize,
    /// Newton iterations in one march.
    pub budget: usize,
    /// Residual force relative to the load, and gap relative to the amplitude.
    pub tolerance: f64,
    /// Largest change of the displacement gradient in one iteration.
    pub step: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    Converged,
    IterationLimit,
    ElementInverted,
    NoActiveSet,
    NotFinite,
    /// The load can be raised no further in steps of a thousandth.
    Fold,
    /// Solved, but the finest mesh allowed does not meet the accuracy asked for.
    ToleranceNotMet,
}

#[derive(Debug, Clone, Copy)]
pub struct Report {
    pub ending: Ending,
    pub iterations: usize,
    pub residual: f64,
}

/// A factored block and the state it was factored at. The volume change keeps the slope of that
/// state too: with a bulk modulus of hundreds of shear moduli a mixture of slopes would not converge.
pub struct Kept {
    elimination: Elimination,
    factored: Vec<RowState>,
}

/// The block on its wave.
pub struct Problem<'a> {
    pub block: Block<'a>,
    pub wave: Wave,
}

impl Problem<'_> {
    pub(crate) fn cell(&self) -> &Cell {
        self.block.cell
    }

    /// Deformed abscissae of the surface nodes in the frame of the wave.
    pub fn abscissae(&self, field: &Field) -> Vec<f64> {
        let cell = self.cell();
        let shift = cell.mean_shift(&field.u);
        (0..cell.layer_nodes())
            .map(|a| a as f64 * cell.node_spacing() + field.u[cell.place(a, 0)] - shift)
            .collect()
    }

    /// Gaps of the surface nodes at the abscissae `x`.
    pub fn gaps(&self, state: &State, x: &[f64]) -> Vec<f64> {
        let height = |a: usize| state.field.u[self.cell().place(a, 1)] - state.approach;
        (0..x.len())
            .map(|a| height(a) - self.wave.height(x[a]))
            .collect()
    }

    pub fn row_states(&self, field: &Field) -> Vec<RowState> {
        (0..self.cell().rows)
            .map(|row| self.block.row_state(row, &field.u))
            .collect()
    }

    /// Iterate on `state` under `load` (mean pressure times one wavelength).
    pub fn solve(&self, state: &mut State, load: f64, limits: &Limits) -> Report {
        self.solve_with(&mut None, state, load, limits)
    }

    /// The same, starting from the factored block in `kept` and leaving the last one there.
    pub fn solve_with(
        &self,
        kept: &mut Option<Kept>,
        state: &mut State,
        load: f64,
        limits: &Limits,
    ) -> Report {
        let mut report = Report {
            ending: Ending::IterationLimit,
            iterations: 0,
            residual: f64::INFINITY,
        };
        let mut rows = self.row_states(&state.field);
        let (mut best, mut best_at) = (f64::INFINITY, 0);
        loop {
            let before = report.residual;
            report.residual = self.residual(state, &rows, load);
            if !report.residual.is_finite() {
                report.ending = Ending::NotFinite;
                return report;
            }
            if report.residual < limits.tolerance {
                report.ending = Ending::Converged;
                return report;
            }
            if report.residual < best {
                (best, best_at) = (report.residual, report.iterations);
            }
            let stalled = report.iterations >= best_at + PATIENCE;
            if stalled || report.iterations >= limits.iterations {
                return report;
            }
            let falling = before.is_infinite() || report.residual < KEEP_BELOW * before;
            if !(falling && report.residual < KEEP_FROM) {
                *kept = None;
            }
            report.iterations += 1;
            if let Err(ending) = self.step(kept, state, &mut rows, load, limits) {
                report.ending = ending;
                return report;
            }
        }
    }

    /// One Newton step, limited in displacement gradient and kept from turning elements over.
    fn step(
        &self,
        kept: &mut Option<Kept>,
        state: &mut State,
        rows: &mut Vec<RowState>,
        load: f64,
        limits: &Limits,
    ) -> Result<(), Ending> {
        let (count, layer) = (self.cell().rows, self.cell().layer_size());
        let Kept {
            elimination,
            factored,
        } = kept.get_or_insert_with(|| Kept {
            elimination: Elimination::new(count, layer, |row| {
                self.block.row_matrix(row, &state.field, &rows[row])
            }),
            factored: rows.clone(),
        });
        let rights: Vec<Vec<f64>> = (0..count)
            .map(|row| {
                self.block
                    .row_right(row, &state.field, &rows[row], &factored[row])
            })
            .collect();
        let reduced = elimination.reduce(&rights);
        let (surface, contact) = self.contact(state, elimination, &reduced.surface_right, load)?;
        let mut du = elimination.expand(&reduced, &surface);
        du.resize(state.field.u.len(), 0.0);
        if du.iter().any(|value| !value.is_finite()) {
            return Err(Ending::NotFinite);
        }
        let largest = self.largest_gradient(&du);
        let mut share = (limits.step / largest).min(1.0);
        for _ in 0..8 {
            let mut trial = state.field.clone();
            for (u, d) in trial.u.iter_mut().zip(&du) {
                *u += share * d;
            }
            let trial_rows = self.row_states(&trial);
            if smallest_jacobian(&trial_rows) > 0.05 {
                for (row, (now, old)) in rows.iter().zip(factored.iter()).enumerate() {
                    self.block
                        .update_pressure(row, now, old, &du, share, &mut trial);
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
        Err(Ending::ElementInverted)
    }

    /// Forces out of balance relative to the load, gaps relative to the amplitude: the largest.
    fn residual(&self, state: &State, rows: &[RowState], load: f64) -> f64 {
        let layer = self.cell().layer_size();
        let mut forces = vec![0.0; state.field.u.len()];
        let mut volume_error = 0.0;
        for (row, row_state) in rows.iter().enumerate() {
            let (local, error) = self.block.row_forces(row, &state.field, row_state);
            let offset = row * self.cell().order * layer;
            for (total, force) in forces[offset..].iter_mut().zip(&local) {
                *total += force;
            }
            volume_error += error;
        }
        let mut gap_error = 0.0_f64;
        let x = self.abscissae(&state.field);
        for (a, gap) in self.gaps(state, &x).into_iter().enumerate() {
            forces[self.cell().place(a, 0)] += state.force[a] * self.wave.slope(x[a]);
            forces[self.cell().place(a, 1)] -= state.force[a];
            let violated = if state.active[a] { gap.abs() } else { -gap };
            gap_error = gap_error.max(violated);
        }
        let free = forces.len() - layer;
        let unbalanced = forces[..free].iter().map(|f| f * f).sum::<f64>().sqrt() / load;
        let total = (state.force.iter().sum::<f64>() / load - 1.0).abs();
        let volume = volume_error.sqrt();
        // f64::max would drop a NaN.
        let all = [unbalanced, total, volume, gap_error / self.wave.amplitude];
        if all.iter().any(|v| v.is_nan()) {
            return f64::NAN;
        }
        all.into_iter().fold(0.0, f64::max)
    }

    fn largest_gradient(&self, du: &[f64]) -> f64 {
        (0..self.cell().rows)
            .flat_map(|row| self.block.gradients(row, du, 0.0))
            .flatten()
            .flatten()
            .fold(1e-300, |m: f64, value| m.max(value.abs()))
    }
}

fn smallest_jacobian(rows: &[RowState]) -> f64 {
    rows.iter()
        .flat_map(|row| row.gradient.iter().flatten())
        .map(network::jacobian)
        .fold(f64::INFINITY, f64::min)
}
