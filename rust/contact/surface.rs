//! How the gaps of a block that is alike in all columns answer contact forces: a convolution.
//!
//! A force f_b along the gradient of its gap g_b, (-w'(x_b), 1), moves the surface by G(a - b), diagonal
//! in the harmonics, and opens gap a by (-w'(x_a), 1) . (G - mean of G along x), as the profile follows
//! the mean displacement.

use super::touching::Compliance;
use crate::fem::mesh::Mesh;
use crate::fem::uniform::Uniform;
use crate::spectral::Lines;

pub struct Surface<'a> {
    uniform: &'a Uniform<'a>,
    mesh: &'a Mesh,
    /// Slope of the profile under every node.
    slope: &'a [f64],
    lines: Lines,
    /// Displacement in a column by forces in another: `[(from, to)][columns between]`.
    between: Vec<f64>,
    /// Mean horizontal displacement of the surface by a force on every unknown of a column.
    shift: Vec<f64>,
}

impl<'a> Surface<'a> {
    pub fn new(uniform: &'a Uniform<'a>, slope: &'a [f64]) -> Self {
        let mesh = uniform.mesh;
        let mut lines = Lines::new(mesh.columns);
        let (columns, count) = (mesh.columns, lines.harmonics());
        let mut between = vec![0.0; uniform.surface.len() / count * columns];
        let spectra = uniform.surface.chunks_exact(count);
        for (spectrum, line) in spectra.zip(between.chunks_exact_mut(columns)) {
            lines.inverse(spectrum, line);
        }
        let unknowns = 2 * mesh.order;
        let mean = |from: usize| {
            let along =
                (0..mesh.order).map(|to| uniform.surface[(from * unknowns + to) * count].re);
            along.sum::<f64>() / mesh.layer_nodes() as f64
        };
        Self {
            uniform,
            mesh,
            slope,
            lines,
            between,
            shift: (0..unknowns).map(mean).collect(),
        }
    }

    /// Forces on the surface layer by contact forces at its nodes.
    pub fn forces(&self, contact: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.mesh.layer_size()];
        for (a, force) in contact.iter().enumerate() {
            forces[self.mesh.place(a, 0)] = -self.slope[a] * force;
            forces[self.mesh.place(a, 1)] = *force;
        }
        forces
    }

    /// Displacements of the surface layer by forces on it.
    pub fn answer(&self, forces: &[f64]) -> Vec<f64> {
        self.uniform.answer(forces, &mut self.lines.clone())
    }

    /// What displacements of the surface layer add to the gaps.
    pub fn opening(&self, u: &[f64]) -> Vec<f64> {
        let shift = self.mesh.mean_shift(u);
        let opening = |(a, slope): (usize, &f64)| {
            u[self.mesh.place(a, 1)] - slope * (u[self.mesh.place(a, 0)] - shift)
        };
        self.slope.iter().enumerate().map(opening).collect()
    }
}

impl Compliance for Surface<'_> {
    fn between(&self, to: usize, from: usize) -> f64 {
        let (order, columns) = (self.mesh.order, self.mesh.columns);
        let (ahead, behind) = (to / order, from / order);
        let round = if ahead < behind { columns } else { 0 };
        let apart = ahead + round - behind;
        let unknowns = 2 * order;
        let moved = |direction: usize, by: usize| {
            let source = by * order + from % order;
            let target = direction * order + to % order;
            self.between[(source * unknowns + target) * columns + apart]
        };
        let by_force =
            |direction: usize| moved(direction, 1) - self.slope[from] * moved(direction, 0);
        let shift = |by: usize| self.shift[by * order + from % order];
        let shifted = shift(1) - self.slope[from] * shift(0);
        by_force(1) - self.slope[to] * (by_force(0) - shifted)
    }

    fn open(&self, force: &[f64], gap: &mut [f64]) {
        let opened = self.opening(&self.answer(&self.forces(force)));
        for (gap, opened) in gap.iter_mut().zip(opened) {
            *gap += opened;
        }
    }
}
