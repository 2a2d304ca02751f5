//! The tangent of one element at fixed memory, assembled,
//!     k = int grad(N) : dP/dF : grad(N) dV,   b = int m cof F : grad(N) dV
//! and its pressures condensed: k + sum over modes m of K / M b b^T.

use super::block::{Block, Field, RowState};
use super::jacobian::add_network_slope;
use crate::material::kinematics::cofactor;
use crate::material::stress::tangent;

pub struct ElementTangent {
    /// Row by row, unknown 2 node + direction; symmetric.
    pub stiffness: Vec<f64>,
    /// b, `[mode][unknown]`.
    pub volume: Vec<f64>,
}

impl ElementTangent {
    pub fn new(block: &Block<'_>) -> Self {
        let size = 2 * block.mesh.elements[0].nodes();
        Self { stiffness: vec![0.0; size * size], volume: vec![0.0; size * block.mesh.modes()] }
    }

    /// Assemble the element in `row` and `column` in the state of `field`, its pressures condensed.
    pub fn assemble_condensed(
        &mut self,
        block: &Block<'_>,
        field: &Field,
        state: &RowState,
        (row, column): (usize, usize),
    ) {
        self.assemble_lower(block, field, state, (row, column));
        self.condense(&block.mesh.elements[row].mode_mass, block.bulk_modulus);
        self.mirror();
    }

    /// b, and the lower triangle of k.
    pub(crate) fn assemble_lower(
        &mut self,
        block: &Block<'_>,
        field: &Field,
        state: &RowState,
        (row, column): (usize, usize),
    ) {
        let element = &block.mesh.elements[row];
        let size = 2 * element.nodes();
        let pressure = block.element_pressure(field, row, column);
        self.stiffness.fill(0.0);
        self.volume.fill(0.0);
        for (at, line, q) in block.gauss_points(column) {
            let (point, h) = (&state.deformation[line][q], &state.h[line][q]);
            let mode = &element.mode[at];
            let weight = element.weight[at];
            let level = mode.iter().zip(pressure).map(|(mode, p)| mode * p).sum();
            let mut slopes = tangent(point, h, level);
            add_network_slope(block, point, &mut slopes);
            let cof = cofactor(&point.f);
            for (j, &[x, z]) in element.gradient[at].iter().enumerate() {
                for d in 0..2 {
                    let unknown = 2 * j + d;
                    let along = |of: &[f64; 4]| weight * (of[2 * d] * x + of[2 * d + 1] * z);
                    let stress: [f64; 4] = std::array::from_fn(|a| along(&slopes[a]));
                    for (i, &[x, z]) in element.gradient[at].iter().enumerate().skip(j) {
                        for e in 0..2 {
                            self.stiffness[(2 * i + e) * size + unknown] +=
                                x * stress[2 * e] + z * stress[2 * e + 1];
                        }
                    }
                    let volume = along(&cof);
                    for (m, mode) in mode.iter().enumerate() {
                        self.volume[m * size + unknown] += mode * volume;
                    }
                }
            }
        }
    }

    /// Eliminate the pressures from the lower triangle.
    fn condense(&mut self, masses: &[f64], bulk_modulus: f64) {
        let size = self.volume.len() / masses.len();
        for (b, mass) in self.volume.chunks_exact(size).zip(masses) {
            let lines = self.stiffness.chunks_exact_mut(size).zip(b);
            for (i, (line, by)) in lines.enumerate() {
                let by = bulk_modulus / mass * by;
                for (k, b) in line[..=i].iter_mut().zip(b) {
                    *k += by * b;
                }
            }
        }
    }

    /// Copy the lower triangle to the upper one.
    pub(crate) fn mirror(&mut self) {
        let size = self.stiffness.len().isqrt();
        for i in 0..size {
            for j in i + 1..size {
                self.stiffness[i * size + j] = self.stiffness[j * size + i];
            }
        }
    }
}
