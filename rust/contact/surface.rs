//! How the gaps of a block that is alike in all columns answer contact forces: a convolution.
//!
//! A force f_b along the gradient of its gap g_b, (-w'(x_b), 1), moves the surface by G(a - b), diagonal
//! in the harmonics, and opens gap a by (-w'(x_a), 1) . (G - mean of G along x), as the profile follows
//! the mean displacement.

use super::touching::{Compliance, Inverse};
use crate::fem::harmonic_band::invert_each;
use crate::fem::mesh::Mesh;
use crate::fem::uniform::{convolved, Uniform};
use crate::spectral::{Complex64, Lines};

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

impl Surface<'_> {
    /// Harmonics of the compliance where the profile everywhere has the slope it has at the nodes of
    /// `set` in the mean, over 1 + slope^2 and inverted: `[(to, from)][harmonic]`; none where forces do
    /// not open the gaps in all of them.
    fn inverses(&self, set: &[usize]) -> Option<Vec<Complex64>> {
        let (order, count) = (self.mesh.order, self.lines.harmonics());
        let unknowns = 2 * order;
        let mean = |of: fn(f64) -> f64| {
            let slopes = set.iter().map(|&a| of(self.slope[a]));
            slopes.sum::<f64>() / set.len() as f64
        };
        let (once, twice) = (mean(|slope| slope), mean(|slope| slope * slope));
        let entry = |to: usize, from: usize, k: usize| {
            let moved = |along: usize, by: usize| {
                self.uniform.surface
                    [((by * order + from) * unknowns + along * order + to) * count + k]
            };
            // Along the profile a mean is not felt.
            let along = if k == 0 { 0.0 } else { 1.0 };
            let sheared = moved(0, 0) * twice - (moved(0, 1) + moved(1, 0)) * once;
            (moved(1, 1) + sheared * along) / (1.0 + along * twice)
        };
        // What is the same everywhere is the approach's, and may be as large as the first wave's.
        let raised = entry(0, 0, 1.min(count - 1)).norm();
        let mut blocks = Vec::with_capacity(order * order * count);
        for (from, to) in (0..order).flat_map(|from| (0..order).map(move |to| (from, to))) {
            blocks.extend((0..count).map(|k| entry(to, from, k)));
            blocks[(from * order + to) * count] += raised;
        }
        let closing = positive(&blocks, order, count) && invert_each(&mut blocks, order, count);
        closing.then_some(blocks)
    }

    /// Forces at all nodes, by `inverses`, that nearly make an `opening`.
    fn nearly_opening(&self, inverses: &[Complex64], opening: &[f64]) -> Vec<f64> {
        let size = |a: usize| self.slope[a].hypot(1.0);
        let mut lines = vec![0.0; opening.len()];
        for (a, opening) in opening.iter().enumerate() {
            lines[self.mesh.place(a, 0)] = opening / size(a);
        }
        let forces = convolved(inverses, &lines, &mut self.lines.clone());
        let force = |a: usize| forces[self.mesh.place(a, 0)] / size(a);
        (0..opening.len()).map(force).collect()
    }
}

/// Whether the Hermitian parts of all blocks, of one or two rows, are positive definite.
fn positive(blocks: &[Complex64], size: usize, count: usize) -> bool {
    let entry = |to: usize, from: usize, k: usize| blocks[(from * size + to) * count + k];
    let last = size - 1;
    (0..count).all(|k| {
        let (first, second) = (entry(0, 0, k).re, entry(last, last, k).re);
        let between = 0.5 * (entry(last, 0, k) + entry(0, last, k).conj());
        let off = if size == 1 { 0.0 } else { between.norm() };
        first > 0.0 && first * second > off * off
    })
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

    fn inverse(&self, set: &[usize]) -> Option<Inverse<'_>> {
        let inverses = self.inverses(set)?;
        Some(Box::new(move |opening| {
            self.nearly_opening(&inverses, opening)
        }))
    }
}
