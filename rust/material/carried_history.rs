//! The temporary networks' states A_i at all Gauss points, carried with the rubber through the mesh.
//!
//! One step moves the rubber by one column, exactly (unit CFL number), and lets time dt pass:
//!     A_i <- exp(-x) A_i + leaving(x) Y_old + arriving(x) Y_new,   x = dt / tau_i.
//! The part with Y_new is a multiple of the local Y, which DEV removes: the step is solved with a
//! known state of the networks.

use super::kinematics::{Symmetric, UNIT};
use super::maxwell::{arriving, leaving, recurrence, Maxwell};

/// Values at all Gauss points, `[row][line][column * points + point]`.
pub type Points = Vec<Vec<Vec<Symmetric>>>;

#[derive(Debug, Clone)]
pub struct CarriedHistory {
    /// State of every network, one per Maxwell element.
    states: Vec<Points>,
    /// Y at the end of the last step.
    y: Points,
    columns: usize,
}

impl CarriedHistory {
    /// All networks fully relaxed in the deformation of `y`: at rest, or in static contact.
    pub fn relaxed(y: Points, columns: usize, maxwell: &Maxwell) -> Self {
        Self { states: vec![y.clone(); maxwell.moduli.len()], y, columns }
    }

    /// The networks of a steady state whose mean has been loaded for `load_time`; times of `maxwell`
    /// and `load_time` in passages.
    pub fn steady(y: Points, columns: usize, maxwell: &Maxwell, load_time: f64) -> Self {
        let state = |time: f64| {
            let weights = recurrence(columns, time);
            let kept = (-load_time / time).exp();
            per_line(&y, |line| steady_line(line, &weights, kept))
        };
        Self { states: maxwell.times.iter().map(|&time| state(time)).collect(), y, columns }
    }

    /// Move all states with the rubber by one column, downstream if `forward`.
    pub fn carry(&mut self, forward: bool) {
        for points in self.states.iter_mut().chain([&mut self.y]) {
            for line in points.iter_mut().flatten() {
                let per_column = line.len() / self.columns;
                if forward {
                    line.rotate_right(per_column);
                } else {
                    line.rotate_left(per_column);
                }
            }
        }
    }

    /// Contribution of the networks to H after time `dt`, without the multiples of the new local Y.
    pub fn known_part(&self, maxwell: &Maxwell, dt: f64) -> Points {
        let mut sum: Points = per_line(&self.y, |line| vec![[0.0; 4]; line.len()]);
        let networks = self.states.iter().zip(&maxwell.moduli).zip(&maxwell.times);
        for ((state, &modulus), &time) in networks {
            let (kept, from_old) = (modulus * (-dt / time).exp(), modulus * leaving(dt / time));
            for (sum, (state, y)) in flat_mut(&mut sum).zip(flat(state).zip(flat(&self.y))) {
                for k in 0..4 {
                    sum[k] += kept * state[k] + from_old * y[k];
                }
            }
        }
        sum
    }

    /// Complete the step: update the networks to the new deformation.
    pub fn advance(&mut self, new: Points, maxwell: &Maxwell, dt: f64) {
        for (state, &time) in self.states.iter_mut().zip(&maxwell.times) {
            let x = dt / time;
            let (kept, from_old, from_new) = ((-x).exp(), leaving(x), arriving(x));
            for (state, (old, new)) in flat_mut(state).zip(flat(&self.y).zip(flat(&new))) {
                for k in 0..4 {
                    state[k] = kept * state[k] + from_old * old[k] + from_new * new[k];
                }
            }
        }
        self.y = new;
    }
}

fn flat(points: &Points) -> impl Iterator<Item = &Symmetric> {
    points.iter().flatten().flatten()
}

fn flat_mut(points: &mut Points) -> impl Iterator<Item = &mut Symmetric> {
    points.iter_mut().flatten().flatten()
}

fn per_line(points: &Points, line: impl Fn(&Vec<Symmetric>) -> Vec<Symmetric>) -> Points {
    points.iter().map(|row| row.iter().map(&line).collect()).collect()
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
                let sum: f64 = (0..columns).map(|m| weights[m] * value(column + columns - m)).sum();
                out[column * points + point][k] = sum - kept * (mean - UNIT[k]);
            }
        }
    }
    out
}
