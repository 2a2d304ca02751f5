//! Residual forces and volumes of an element row,
//!     R_u = int P : grad(N) dV,   R_p = int m (J - 1) dV - M p / K   (m: pressure modes, M: their mass)
//! with the pressure an independent unknown, updated linearly.

use super::block::{Block, Field, RowState};
use crate::material::stress::stress;

impl Block<'_> {
    /// Residuals of the pressure equations of one row, `[mode][column]`.
    pub fn row_volumes(&self, row: usize, field: &Field, state: &RowState) -> Vec<f64> {
        let element = &self.mesh.elements[row];
        let (columns, modes) = (self.mesh.columns, self.mesh.modes());
        let mut residual = vec![0.0; modes * columns];
        for column in 0..columns {
            let pressure = self.element_pressure(field, row, column);
            for (m, mass) in element.mode_mass.iter().enumerate() {
                residual[m * columns + column] = -mass * pressure[m] / self.bulk_modulus;
            }
            for (at, line, q) in self.gauss_points(column) {
                let volume = element.weight[at] * (state.deformation[line][q].j - 1.0);
                for (m, mode) in element.mode[at].iter().enumerate() {
                    residual[m * columns + column] += mode * volume;
                }
            }
        }
        residual
    }

    /// Internal forces of one row, over its layers.
    pub fn row_forces(&self, row: usize, field: &Field, state: &RowState) -> Vec<f64> {
        let element = &self.mesh.elements[row];
        let mut forces = vec![0.0; (self.mesh.order + 1) * self.mesh.layer_size()];
        for column in 0..self.mesh.columns {
            let unknowns = self.local_unknowns(column);
            let pressure = self.element_pressure(field, row, column);
            for (at, line, q) in self.gauss_points(column) {
                let level = dot(&element.mode[at], pressure);
                let p = stress(state.deformation[line][q], &state.h[line][q], level);
                for (slope, [x, z]) in element.gradient[at].iter().zip(unknowns) {
                    let w = element.weight[at];
                    forces[x] += w * (p[0] * slope[0] + p[1] * slope[1]);
                    forces[z] += w * (p[2] * slope[0] + p[3] * slope[1]);
                }
            }
        }
        forces
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
