//! How the gaps of a block that is alike in all columns answer contact forces: a convolution.
//!
//! A force f_b along the gradient of its gap g_b, (-w'(x_b), 1), moves the surface by G(a - b), diagonal
//! in the harmonics, and opens gap a by (-w'(x_a), 1) . (G - mean of G along x), as the profile follows
//! the mean displacement.

use super::touching::{Compliance, Inverse};
use crate::fem::harmonic_band::product;
use crate::fem::mesh::Mesh;
use crate::fem::uniform::Uniform;
use crate::linear::invert;
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
        let size = order * order;
        let mut inverses = vec![Complex64::default(); size * count];
        // What is the same everywhere is the approach's, and may be as large as the first wave's.
        let raised = entry(0, 0, 1.min(count - 1)).norm();
        let mut block = vec![Complex64::default(); size];
        for k in 0..count {
            for (at, value) in block.iter_mut().enumerate() {
                *value = entry(at % order, at / order, k);
                if k == 0 {
                    *value += raised;
                }
            }
            if !positive(&block, order) || !invert(&mut block, order) {
                return None;
            }
            for (at, value) in block.iter().enumerate() {
                inverses[at * count + k] = *value;
            }
        }
        Some(inverses)
    }

    /// Forces at all nodes, by `inverses`, that nearly make an `opening`.
    fn opened_by(&self, inverses: &[Complex64], opening: &[f64]) -> Vec<f64> {
        let (order, columns) = (self.mesh.order, self.mesh.columns);
        let mut lines = self.lines.clone();
        let count = lines.harmonics();
        let size = |a: usize| self.slope[a].hypot(1.0);
        let mut line = vec![0.0; columns];
        let mut spectra = vec![Complex64::default(); order * count];
        for (sub, spectrum) in spectra.chunks_exact_mut(count).enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                let a = column * order + sub;
                *value = opening[a] / size(a);
            }
            lines.forward(&line, spectrum);
        }
        let mut forces = vec![Complex64::default(); order * count];
        product(&mut forces, inverses, &spectra, 1.0, count);
        let mut force = vec![0.0; opening.len()];
        for (sub, spectrum) in forces.chunks_exact(count).enumerate() {
            lines.inverse(spectrum, &mut line);
            for (column, value) in line.iter().enumerate() {
                let a = column * order + sub;
                force[a] = value / size(a);
            }
        }
        force
    }
}

/// Whether the Hermitian part of a block of one or two rows is positive definite.
fn positive(block: &[Complex64], size: usize) -> bool {
    let diagonal = |i: usize| block[i * size + i].re;
    let off = if size == 1 {
        0.0
    } else {
        (0.5 * (block[1] + block[2].conj())).norm()
    };
    diagonal(0) > 0.0 && diagonal(0) * diagonal(size - 1) > off * off
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
        Some(Box::new(move |opening| self.opened_by(&inverses, opening)))
    }
}
