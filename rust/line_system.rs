//! The linear system of the points of a line in contact, in single precision; the bindings' alone:
//!     Q K p = Q r,    Q r = P S E P r,    P r = r - mean r,
//! with K the displacement under a pressure, S its inverse, and E the extension of a gap beyond the
//! points: see `gripscale.half_space.active_set`, which refines the solution in double precision.

use std::convert::Infallible;

use crate::linear::single_gmres::{gmres, Approximation};
use crate::spectral::{Complex32, Lines};

/// A matrix with the entries of its rows one after the other.
pub struct Rows<'a> {
    pub starts: &'a [i32],
    pub columns: &'a [i32],
    pub values: &'a [f32],
}

/// The operator Q K on some points of a line.
pub struct LineSystem<'a> {
    pub lines: &'a Lines<f32>,
    /// Places of the points on the line, rising.
    pub places: &'a [i64],
    /// K and S of each harmonic.
    pub compliance: &'a [Complex32],
    pub stiffness: &'a [Complex32],
    /// E, a row for each point of the line.
    pub extension: Rows<'a>,
    /// Factor on Q r.
    pub factor: f32,
}

impl LineSystem<'_> {
    /// Whether all places and rows are of the line, for a system of so many points.
    pub fn fits(&self, points: usize) -> bool {
        let Rows { starts, columns, values } = &self.extension;
        let within = |at: &i64| (0..self.lines.length() as i64).contains(at);
        let rising = starts.windows(2).all(|ends| ends[0] <= ends[1]);
        points == self.places.len()
            && self.places.iter().all(within)
            && starts.len() == self.lines.length() + 1
            && rising
            && starts.first() == Some(&0)
            && starts.last().is_some_and(|&end| end as usize == values.len())
            && columns.len() == values.len()
            && columns.iter().all(|&at| (0..points as i64).contains(&i64::from(at)))
    }

    /// The pressures whose Q K is `right`, of unit length; see `gmres`.
    pub fn solution(&self, right: Vec<f32>, target: f64, most: usize) -> Approximation {
        let mut lines = self.lines.clone();
        let mut line = vec![0.0; self.lines.length()];
        let apply = |pressure: &[f32]| {
            line.fill(0.0);
            for (&place, &value) in self.places.iter().zip(pressure) {
                line[place as usize] = value;
            }
            lines.convolve(self.compliance, &mut line);
            let gap = without_mean(self.at_points(&line));
            self.extend(&gap, &mut line);
            lines.convolve(self.stiffness, &mut line);
            let mut missing = without_mean(self.at_points(&line));
            missing.iter_mut().for_each(|value| *value *= self.factor);
            Ok::<_, Infallible>(missing)
        };
        match gmres(apply, right, target, most) {
            Ok(found) => found,
        }
    }

    fn at_points(&self, line: &[f32]) -> Vec<f32> {
        self.places.iter().map(|&at| line[at as usize]).collect()
    }

    fn extend(&self, gap: &[f32], line: &mut [f32]) {
        let Rows { starts, columns, values } = &self.extension;
        for (value, ends) in line.iter_mut().zip(starts.windows(2)) {
            let row = ends[0] as usize..ends[1] as usize;
            let parts = columns[row.clone()].iter().zip(&values[row]);
            *value = parts.map(|(&at, &weight)| weight * gap[at as usize]).sum();
        }
    }
}

fn without_mean(mut values: Vec<f32>) -> Vec<f32> {
    let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
    let mean = (sum / values.len() as f64) as f32;
    values.iter_mut().for_each(|value| *value -= mean);
    values
}
