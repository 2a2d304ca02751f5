//! Element rows: residual, tangent with the dense memory coupling along x, condensed pressure.
//!
//! R_u = int P : grad(N) dV,   R_p = int m (J - 1) dV - M p / K   (m: pressure modes, M: their mass)
//! The pressure is an independent unknown, updated linearly and condensed element by element:
//!     dp = K M^-1 (R_p + B^T du),   K_cond = K_uu + B K M^-1 B^T.

use super::block::{Block, Field, Memory, RowState};
use crate::linear::{self, Matrix};
use crate::material::kinematics::{cofactor, jacobian, Gradient};
use crate::material::stress::{memory_slope, stress, tangent};
use crate::status::Status;
use crate::watch::Watch;

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

    /// Right-hand side of one row, -(R_u + B K M^-1 R_p), with B of the state `factored`.
    pub fn row_right(
        &self,
        row: usize,
        field: &Field,
        state: &RowState,
        factored: &RowState,
    ) -> Vec<f64> {
        let element = &self.mesh.elements[row];
        let (forces, _) = self.row_forces(row, field, state);
        let mut right: Vec<f64> = forces.iter().map(|force| -force).collect();
        for column in 0..self.mesh.columns {
            let unknowns = self.local_unknowns(column);
            let mut level = self.pressure_residual(field, state, row, column);
            for (m, value) in level.iter_mut().enumerate() {
                *value *= self.bulk_modulus / element.mode_mass[m];
            }
            for (at, line, q) in self.gauss_points(column) {
                let cof = cofactor(&factored.gradient[line][q]);
                let p = element.weight[at] * dot(&element.mode[at], &level);
                for (node, slope) in element.gradient[at].iter().enumerate() {
                    for i in 0..2 {
                        let b = cof[2 * i] * slope[0] + cof[2 * i + 1] * slope[1];
                        right[unknowns[2 * node + i]] -= p * b;
                    }
                }
            }
        }
        right
    }

    /// Tangent of one row with its pressures condensed.
    pub fn row_matrix(
        &self,
        row: usize,
        field: &Field,
        state: &RowState,
        watch: &Watch<'_>,
    ) -> Result<Matrix<f64>, Status> {
        let size = (self.mesh.order + 1) * self.mesh.layer_size();
        let mut matrix = Matrix::zeros(size, size);
        for column in 0..self.mesh.columns {
            watch.look()?;
            self.add_local(row, column, field, state, &mut matrix);
        }
        if let Memory::Sliding(history) = self.memory {
            self.add_memory(row, history, &state.gradient, &mut matrix, watch)?;
        }
        Ok(matrix)
    }

    /// Tangent of one element at fixed memory, with its pressure condensed.
    fn add_local(
        &self,
        row: usize,
        column: usize,
        field: &Field,
        state: &RowState,
        matrix: &mut Matrix<f64>,
    ) {
        let element = &self.mesh.elements[row];
        let unknowns = self.local_unknowns(column);
        let count = unknowns.len();
        let pressure = self.element_pressure(field, row, column);
        let mut local = vec![0.0; count * count];
        let mut coupling = vec![vec![0.0; count]; pressure.len()];
        for (at, line, q) in self.gauss_points(column) {
            let f = &state.gradient[line][q];
            let weight = element.weight[at];
            let level = dot(&element.mode[at], pressure);
            let mut d = tangent(f, &state.h[line][q], level);
            self.add_network_slope(f, &mut d);
            let cof = cofactor(f);
            let slopes = &element.gradient[at];
            add_stiffness(&mut local, count, slopes, &d, weight);
            for (node, slope) in slopes.iter().enumerate() {
                for i in 0..2 {
                    let b = cof[2 * i] * slope[0] + cof[2 * i + 1] * slope[1];
                    for (entry, mode) in coupling.iter_mut().zip(&element.mode[at]) {
                        entry[2 * node + i] += weight * mode * b;
                    }
                }
            }
        }
        for (m, entry) in coupling.iter().enumerate() {
            let stiffness = self.bulk_modulus / element.mode_mass[m];
            for j in 0..count {
                for i in 0..count {
                    local[j * count + i] += stiffness * entry[i] * entry[j];
                }
            }
        }
        for j in 0..count {
            let target = linear::column_mut(matrix, unknowns[j]);
            for i in 0..count {
                target[unknowns[i]] += local[j * count + i];
            }
        }
    }

    /// Stiffness from the permanent network where its b changes with the strain.
    pub(super) fn add_network_slope(&self, f: &Gradient, d: &mut [Gradient; 4]) {
        let Some(slope) = self.energy.network_slope(f) else {
            return;
        };
        let by_h = memory_slope(f);
        for a in 0..4 {
            for k in 0..4 {
                let sum: f64 = (0..4).map(|c| by_h[a][c] * slope[c][k]).sum();
                d[a][k] += self.equilibrium * sum;
            }
        }
    }

    /// Pressure increments K M^-1 (R_p + B^T du) of one row, with B of the state `factored`.
    pub fn pressure_increments(
        &self,
        row: usize,
        state: &RowState,
        factored: &RowState,
        du: &[f64],
        field: &Field,
    ) -> Vec<f64> {
        let element = &self.mesh.elements[row];
        let increment = self.gradients(row, du, 0.0);
        let mut out = Vec::with_capacity(self.mesh.columns * self.mesh.modes());
        for column in 0..self.mesh.columns {
            let mut change = self.pressure_residual(field, state, row, column);
            for (at, line, q) in self.gauss_points(column) {
                let cof = cofactor(&factored.gradient[line][q]);
                let volume = element.weight[at] * dot(&cof, &increment[line][q]);
                for (c, mode) in change.iter_mut().zip(&element.mode[at]) {
                    *c += mode * volume;
                }
            }
            let masses = change.iter().zip(&element.mode_mass);
            out.extend(masses.map(|(change, mass)| self.bulk_modulus / mass * change));
        }
        out
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Add weight * grad(N)^T D grad(N) to a column-major element matrix.
fn add_stiffness(
    local: &mut [f64],
    count: usize,
    slopes: &[[f64; 2]],
    d: &[Gradient; 4],
    weight: f64,
) {
    for (node_b, b) in slopes.iter().enumerate() {
        for j in 0..2 {
            let mut column = [0.0; 4];
            for (value, d) in column.iter_mut().zip(d) {
                *value = weight * (d[2 * j] * b[0] + d[2 * j + 1] * b[1]);
            }
            let target = &mut local[(2 * node_b + j) * count..][..count];
            for (node_a, a) in slopes.iter().enumerate() {
                target[2 * node_a] += column[0] * a[0] + column[1] * a[1];
                target[2 * node_a + 1] += column[2] * a[0] + column[3] * a[1];
            }
        }
    }
}
