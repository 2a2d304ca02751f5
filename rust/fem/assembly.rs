//! Element rows: what is out of balance of forces and volumes,
//!     R_u = int P : grad(N) dV,   R_p = int m (J - 1) dV - M p / K   (m: pressure modes, M: their mass)
//! with the pressure an independent unknown, updated linearly.

use super::block::{Block, Field, RowState};
use crate::material::kinematics::jacobian;
use crate::material::stress::stress;

impl Block<'_> {
    /// Residual of the pressure equation of one element.
    fn pressure_residual(
        &self,
        field: &Field,
        state: &RowState,
        row: usize,
        column: usize,
    ) -> Vec<f64> {
        let element = &self.mesh.elements[row];
        let pressure = self.element_pressure(field, row, column);
        let mut residual: Vec<f64> = (0..pressure.len())
            .map(|m| -element.mode_mass[m] * pressure[m] / self.bulk_modulus)
            .collect();
        for (at, line, q) in self.gauss_points(column) {
            let f = &state.gradient[line][q];
            let volume = element.weight[at] * (jacobian(f) - 1.0);
            for (r, mode) in residual.iter_mut().zip(&element.mode[at]) {
                *r += mode * volume;
            }
        }
        residual
    }

    /// Residuals of the pressure equations of one row, `[column][mode]`.
    pub fn row_volumes(&self, row: usize, field: &Field, state: &RowState) -> Vec<f64> {
        let columns = 0..self.mesh.columns;
        columns
            .flat_map(|column| self.pressure_residual(field, state, row, column))
            .collect()
    }

    /// Internal forces of one row (over its layers) and the norm of its pressure residual.
    pub fn row_forces(&self, row: usize, field: &Field, state: &RowState) -> (Vec<f64>, f64) {
        let element = &self.mesh.elements[row];
        let mut forces = vec![0.0; (self.mesh.order + 1) * self.mesh.layer_size()];
        let mut volume_error = 0.0;
        for column in 0..self.mesh.columns {
            let unknowns = self.local_unknowns(column);
            let pressure = self.element_pressure(field, row, column);
            let residual = self.pressure_residual(field, state, row, column);
            volume_error += residual.iter().map(|r| r * r).sum::<f64>();
            for (at, line, q) in self.gauss_points(column) {
                let level = dot(&element.mode[at], pressure);
                let p = stress(&state.gradient[line][q], &state.h[line][q], level);
                for (node, slope) in element.gradient[at].iter().enumerate() {
                    let w = element.weight[at];
                    forces[unknowns[2 * node]] += w * (p[0] * slope[0] + p[1] * slope[1]);
                    forces[unknowns[2 * node + 1]] += w * (p[2] * slope[0] + p[3] * slope[1]);
                }
            }
        }
        (forces, volume_error)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
