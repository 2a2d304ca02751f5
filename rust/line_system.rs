//! The linear system of the points of a line in contact, in single precision; the bindings' alone:
//!     Q K p = Q r,    Q r = P S E P r,    P r = r - mean r,
//! with K the displacement under a pressure, S its inverse, and E the extension of a gap beyond the
//! points: see `gripscale.half_space.active_set`, which refines the solution in double precision.

use std::convert::Infallible;

use crate::gap_extension::GapExtension;
use crate::line_filter::{LineFilter, PackedLine};
use crate::linear::single_gmres::{gmres, Approximation};
use crate::spectral::Complex32;

/// The operator Q K on some points of a line.
pub struct LineSystem<'a> {
    pub filter: &'a LineFilter,
    /// Places of the points on the line, rising.
    pub places: &'a [i64],
    /// K and S of each wave.
    pub compliance: &'a [Complex32],
    pub stiffness: &'a [Complex32],
    /// E.
    pub extension: &'a GapExtension,
    /// Factor on Q r.
    pub factor: f32,
}

impl LineSystem<'_> {
    /// Whether all places are of the line, for a system of so many points.
    pub fn fits(&self, points: usize) -> bool {
        let within = |at: &i64| (0..self.filter.points() as i64).contains(at);
        points == self.places.len()
            && self.places.iter().all(within)
            && self.extension.points() == self.filter.points()
    }

    /// The pressures whose Q K is `right`, of unit length; see `gmres`.
    pub fn solution(&self, right: Vec<f32>, target: f64, most: usize) -> Approximation {
        let (mut line, mut packed) = (vec![0.0; self.filter.points()], self.filter.line());
        let apply = |pressure: &[f32]| {
            self.spread(pressure, &mut line);
            packed.fill(&line);
            self.filter.apply(self.compliance, &mut packed);
            self.spread(&without_mean(self.at_points(&packed)), &mut line);
            self.extension.extend(&mut line);
            packed.fill(&line);
            self.filter.apply(self.stiffness, &mut packed);
            let mut missing = without_mean(self.at_points(&packed));
            missing.iter_mut().for_each(|value| *value *= self.factor);
            Ok::<_, Infallible>(missing)
        };
        match gmres(apply, right, target, most) {
            Ok(found) => found,
        }
    }

    fn at_points(&self, line: &PackedLine) -> Vec<f32> {
        self.places.iter().map(|&at| line.get(at as usize)).collect()
    }

    fn spread(&self, values: &[f32], line: &mut [f32]) {
        line.fill(0.0);
        for (&place, &value) in self.places.iter().zip(values) {
            line[place as usize] = value;
        }
    }
}

/// `values` less their mean.
pub fn without_mean(mut values: Vec<f32>) -> Vec<f32> {
    let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
    let mean = (sum / values.len() as f64) as f32;
    values.iter_mut().for_each(|value| *value -= mean);
    values
}
