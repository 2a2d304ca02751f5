//! Compliance of the surface of the laterally averaged block: a convolution.
//!
//! A force f_b along the gradient of its gap g_b, (-S_bc, 1) over the nodes c around it, displaces the surface
//! by G(a - c), which is diagonal in the harmonics, and opens gap a by (-S_ac, 1) . (G - mean of G along x),
//! because the profile follows the mean displacement.

use super::complementarity_problem::{ApproximateInverse, Compliance};
use super::sampling::Band;
use crate::fem::averaged_jacobian::{convolve, AveragedJacobian};
use crate::fem::harmonic_block::invert_each;
use crate::fem::mesh::Mesh;
use crate::spectral::{Complex64, Lines};

pub struct SurfaceCompliance<'a> {
    average: &'a AveragedJacobian<'a>,
    mesh: &'a Mesh,
    /// Slope of the profile under every node.
    slope: &'a Band,
    lines: Lines,
    /// Displacement in a column by a unit force in another: `[(from, to)][columns between]`.
    by_distance: Vec<f64>,
    /// Mean horizontal displacement of the surface by a unit force on every unknown of a column.
    mean_shift: Vec<f64>,
}

impl<'a> SurfaceCompliance<'a> {
    pub fn new(average: &'a AveragedJacobian<'a>, slope: &'a Band) -> Self {
        let mesh = average.mesh;
        let mut lines = Lines::new(mesh.columns);
        let (columns, count) = (mesh.columns, lines.harmonics());
        let mut by_distance = vec![0.0; average.surface.len() / count * columns];
        let spectra = average.surface.chunks_exact(count);
        for (spectrum, line) in spectra.zip(by_distance.chunks_exact_mut(columns)) {
            lines.inverse(spectrum, line);
        }
        let unknowns = 2 * mesh.order;
        let mean_shift = |from: usize| {
            let horizontal =
                (0..mesh.order).map(|to| average.surface[(from * unknowns + to) * count].re);
            horizontal.sum::<f64>() / mesh.layer_nodes() as f64
        };
        Self {
            average,
            mesh,
            slope,
            lines,
            by_distance,
            mean_shift: (0..unknowns).map(mean_shift).collect(),
        }
    }

    /// Nodal forces on the surface layer by contact forces at its nodes.
    pub fn nodal_forces(&self, contact: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.mesh.layer_size()];
        let along = self.slope.transposed(contact);
        for (a, (along, force)) in along.iter().zip(contact).enumerate() {
            forces[self.mesh.position(a, 0)] = -along;
            forces[self.mesh.position(a, 1)] = *force;
        }
        forces
    }

    /// Displacements of the surface layer by nodal forces on it.
    pub fn displacements(&self, forces: &[f64]) -> Vec<f64> {
        convolve(&self.average.surface, forces, &mut self.lines.clone())
    }

    /// What displacements of the surface layer add to the gaps.
    pub fn opening(&self, u: &[f64]) -> Vec<f64> {
        let shift = self.mesh.mean_shift(u);
        let along = |a: usize| u[self.mesh.position(a, 0)] - shift;
        let opening = |a: usize| u[self.mesh.position(a, 1)] - self.slope.product(along, a);
        (0..self.mesh.layer_nodes()).map(opening).collect()
    }

    /// Inverse harmonics `[(to, from)][harmonic]` of the compliance divided by 1 + slope^2, as if the
    /// profile had the mean slope of the active nodes everywhere; None if forces do not open the gaps in
    /// every harmonic.
    fn inverse_harmonics(&self, active_nodes: &[usize]) -> Option<Vec<Complex64>> {
        let (order, count) = (self.mesh.order, self.lines.harmonics());
        let unknowns = 2 * order;
        let mean = |of: fn(f64) -> f64| {
            let slopes = active_nodes.iter().map(|&a| of(self.slope.row_sum(a)));
            slopes.sum::<f64>() / active_nodes.len() as f64
        };
        let (slope, square) = (mean(|slope| slope), mean(|slope| slope * slope));
        let entry = |to: usize, from: usize, k: usize| {
            let displacement = |direction: usize, by: usize| {
                self.average.surface
                    [((by * order + from) * unknowns + direction * order + to) * count + k]
            };
            // The profile follows the mean horizontal displacement, which therefore opens no gap.
            let horizontal = if k == 0 { 0.0 } else { 1.0 };
            let sheared =
                displacement(0, 0) * square - (displacement(0, 1) + displacement(1, 0)) * slope;
            (displacement(1, 1) + sheared * horizontal) / (1.0 + horizontal * square)
        };
        // The mean opening belongs to the approach and may be shifted freely, here to the size of the
        // first harmonic.
        let raised = entry(0, 0, 1.min(count - 1)).norm();
        let mut blocks = Vec::with_capacity(order * order * count);
        for (from, to) in (0..order).flat_map(|from| (0..order).map(move |to| (from, to))) {
            blocks.extend((0..count).map(|k| entry(to, from, k)));
            blocks[(from * order + to) * count] += raised;
        }
        let invertible =
            positive_definite(&blocks, order, count) && invert_each(&mut blocks, order, count);
        invertible.then_some(blocks)
    }

    /// Forces at all nodes, by `inverse_harmonics`, that nearly make an `opening`.
    fn nearly_opening(&self, inverse_harmonics: &[Complex64], opening: &[f64]) -> Vec<f64> {
        let size = |a: usize| self.slope.row_sum(a).hypot(1.0);
        let mut lines = vec![0.0; opening.len()];
        for (a, opening) in opening.iter().enumerate() {
            lines[self.mesh.position(a, 0)] = opening / size(a);
        }
        let forces = convolve(inverse_harmonics, &lines, &mut self.lines.clone());
        let force = |a: usize| forces[self.mesh.position(a, 0)] / size(a);
        (0..opening.len()).map(force).collect()
    }
}

/// Whether the Hermitian parts of all blocks, of one or two rows, are positive definite.
fn positive_definite(blocks: &[Complex64], size: usize, count: usize) -> bool {
    let entry = |to: usize, from: usize, k: usize| blocks[(from * size + to) * count + k];
    let last = size - 1;
    (0..count).all(|k| {
        let (first, second) = (entry(0, 0, k).re, entry(last, last, k).re);
        let between = 0.5 * (entry(last, 0, k) + entry(0, last, k).conj());
        let off = if size == 1 { 0.0 } else { between.norm() };
        first > 0.0 && first * second > off * off
    })
}

impl Compliance for SurfaceCompliance<'_> {
    fn entry(&self, to: usize, from: usize) -> f64 {
        let (order, columns) = (self.mesh.order, self.mesh.columns);
        let unknowns = 2 * order;
        let displacement = |(direction, to): (usize, usize), (by, from): (usize, usize)| {
            let (ahead, behind) = (to / order, from / order);
            let around = if ahead < behind { columns } else { 0 };
            let source = by * order + from % order;
            let target = direction * order + to % order;
            self.by_distance[(source * unknowns + target) * columns + ahead + around - behind]
        };
        let by_force = |direction: usize, to: usize| {
            let along = |from: usize| displacement((direction, to), (0, from));
            displacement((direction, to), (1, from)) - self.slope.product(along, from)
        };
        let shift = |by: usize, from: usize| self.mean_shift[by * order + from % order];
        let shifted = shift(1, from) - self.slope.product(|b| shift(0, b), from);
        by_force(1, to) - self.slope.product(|b| by_force(0, b) - shifted, to)
    }

    fn add_opening(&self, force: &[f64], gap: &mut [f64]) {
        let opening = self.opening(&self.displacements(&self.nodal_forces(force)));
        for (gap, opening) in gap.iter_mut().zip(opening) {
            *gap += opening;
        }
    }

    fn approximate_inverse(&self, active_nodes: &[usize]) -> Option<ApproximateInverse<'_>> {
        let harmonics = self.inverse_harmonics(active_nodes)?;
        Some(Box::new(move |opening| self.nearly_opening(&harmonics, opening)))
    }
}
