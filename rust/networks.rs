//! The temporary networks' states A_i at all Gauss points, carried with the rubber through the mesh.
//!
//! One step moves the rubber by one column, exactly (unit CFL number), and lets time dt pass:
//!     A_i <- exp(-dt/tau_i) A_i + leaving(dt/tau_i) Y_old + arriving(dt/tau_i) Y_new,
//! exact for Y linear in time (Taylor, Pister & Goudreau, Int. J. Numer. Methods Eng. 2 (1970) 45).
//! The part with Y_new is a multiple of the local Y, which DEV removes: the step is solved with a
//! known state of the networks.

use crate::assembly::RowState;
use crate::memory::{arriving, leaving, recurrence, Maxwell};
use crate::network::{self, Symmetric, UNIT};

/// Values at all Gauss points, `[row][line][column * points + point]`.
pub type Points = Vec<Vec<Vec<Symmetric>>>;

#[derive(Debug, Clone)]
pub struct Networks {
    /// State of every network, one per Maxwell element.
    pub states: Vec<Points>,
    /// Y at the end of the last step.
    pub y: Points,
    columns: usize,
}

impl Networks {
    /// All networks at rest in the undeformed rubber.
    pub fn at_rest(rows: &[RowState], columns: usize, maxwell: &Maxwell) -> Self {
        let unit: Points = map(rows, |_| UNIT);
        Self {
            states: vec![unit.clone(); maxwell.moduli.len()],
            y: unit,
            columns,
        }
    }

    /// The networks of a steady state whose mean has been loaded for `load_time`.
    pub fn steady(rows: &[RowState], columns: usize, maxwell: &Maxwell, load_time: f64) -> Self {
        let y = map(rows, network::remembered);
        let state = |time: f64| {
            let weights = recurrence(columns, time);
            let kept = (-load_time / time).exp();
            per_line(&y, |line| steady_line(line, &weights, kept))
        };
        Self {
            states: maxwell.times.iter().map(|&time| state(time)).collect(),
            y,
            columns,
        }
    }

    /// Carry all with the rubber by one column, downstream if `forward`.
    pub fn carry(&mut self, forward: bool) {
        let columns = self.columns;
        for points in self.states.iter_mut().chain([&mut self.y]) {
            for line in points.iter_mut().flatten() {
                let per_column = line.len() / columns;
                if forward {
                    line.rotate_right(per_column);
                } else {
                    line.rotate_left(per_column);
                }
            }
        }
    }

    /// What the networks contribute to H after time `dt`, but for multiples of the new local Y.
    pub fn known_part(&self, maxwell: &Maxwell, dt: f64) -> Points {
        let mut sum: Points = per_line(&self.y, |line| vec![[0.0; 4]; line.len()]);
        for ((state, &modulus), &time) in
            self.states.iter().zip(&maxwell.moduli).zip(&maxwell.times)
        {
            let (kept, left) = (modulus * (-dt / time).exp(), modulus * leaving(dt / time));
            for (sum, (state, y)) in flat(&mut sum).zip(
                state
                    .iter()
                    .flatten()
                    .flatten()
                    .zip(self.y.iter().flatten().flatten()),
            ) {
                for k in 0..4 {
                    sum[k] += kept * state[k] + left * y[k];
                }
            }
        }
        sum
    }

    /// Close the step: the networks follow to the new deformation.
    pub fn advance(&mut self, rows: &[RowState], maxwell: &Maxwell, dt: f64) {
        let new = map(rows, network::remembered);
        for (state, &time) in self.states.iter_mut().zip(&maxwell.times) {
            let x = dt / time;
            let (kept, left, arrived) = ((-x).exp(), leaving(x), arriving(x));
            let both = self
                .y
                .iter()
                .flatten()
                .flatten()
                .zip(new.iter().flatten().flatten());
            for (state, (old, new)) in flat(state).zip(both) {
                for k in 0..4 {
                    state[k] = kept * state[k] + left * old[k] + arrived * new[k];
                }
            }
        }
        self.y = new;
    }
}

fn flat(points: &mut Points) -> impl Iterator<Item = &mut Symmetric> {
    points.iter_mut().flatten().flatten()
}

fn map(rows: &[RowState], value: impl Fn(&network::Gradient) -> Symmetric) -> Points {
    rows.iter()
        .map(|row| {
            row.gradient
                .iter()
                .map(|line| line.iter().map(&value).collect())
                .collect()
        })
        .collect()
}

fn per_line(points: &Points, line: impl Fn(&Vec<Symmetric>) -> Vec<Symmetric>) -> Points {
    points
        .iter()
        .map(|row| row.iter().map(&line).collect())
        .collect()
}

/// A of one network along a line in steady state, its mean relaxed for the load time only.
fn steady_line(y: &[Symmetric], weights: &[f64], kept: f64) -> Vec<Symmetric> {
    let columns = weights.len();
    let points = y.len() / columns;
    let mut out = vec![[0.0; 4]; y.len()];
    for point in 0..points {
        for k in 0..4 {
            let value = |column: usize| y[column % columns * points + point][k];
            let mean = (0..columns).map(value).sum::<f64>() / columns as f64;
            for column in 0..columns {
                let sum: f64 = (0..columns)
                    .map(|m| weights[m] * value(column + columns - m))
                    .sum();
                out[column * points + point][k] = sum - kept * (mean - UNIT[k]);
            }
        }
    }
    out
}
