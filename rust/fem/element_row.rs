//! One row of elements: deformation and memory at its Gauss points, and its residual forces and volumes,
//!     R_u = int P : grad(N) dV,   R_p = int m (J - 1) dV - M p / K   (m: pressure modes, M: their mass)
//! with the pressure an independent unknown, updated linearly.

use super::block::{Block, Field, Memory, RowState};
use crate::material::kinematics::{remembered, Deformation, Gradient, Symmetric, UNIT};
use crate::material::stress::stress;
use crate::spectral::convolve_points;

impl RowState {
    /// Y at the points of the row, which the temporary networks remember, `[line][column * points + point]`.
    pub fn remembered(&self) -> Vec<Vec<Symmetric>> {
        let lines = self.deformation.iter();
        lines.map(|line| line.iter().map(remembered).collect()).collect()
    }
}

impl Block<'_> {
    /// Deformation gradients of one row for displacements `u`, or increments if `identity` is 0.
    pub fn gradients(&self, row: usize, u: &[f64], identity: f64) -> Vec<Vec<Gradient>> {
        let element = &self.mesh.elements[row];
        let points = self.points();
        let offset = self.row_offset(row);
        let mut out = vec![vec![[0.0; 4]; self.mesh.columns * points]; points];
        for column in 0..self.mesh.columns {
            let unknowns = self.local_unknowns(column);
            for (at, line, q) in self.gauss_points(column) {
                let f = &mut out[line][q];
                *f = [identity, 0.0, 0.0, identity];
                for (slope, unknowns) in element.gradient[at].iter().zip(&unknowns) {
                    let [ux, uz] = unknowns.map(|unknown| u[offset + unknown]);
                    f[0] += ux * slope[0];
                    f[1] += ux * slope[1];
                    f[2] += uz * slope[0];
                    f[3] += uz * slope[1];
                }
            }
        }
        out
    }

    pub fn row_state(&self, row: usize, u: &[f64]) -> RowState {
        let gradients = self.gradients(row, u, 1.0).into_iter();
        let deformation: Vec<Vec<Deformation>> =
            gradients.map(|line| line.iter().map(Deformation::from).collect()).collect();
        let h = (0..deformation.len())
            .map(|line| self.network_stress(row, line, &deformation[line]))
            .collect();
        RowState { deformation, h }
    }

    /// H along one line: permanent network and memory.
    fn network_stress(&self, row: usize, line: usize, along: &[Deformation]) -> Vec<Symmetric> {
        let mut h: Vec<Symmetric> =
            along.iter().map(|f| self.energy.network(f).map(|b| self.equilibrium * b)).collect();
        match self.memory {
            Memory::Relaxed => {}
            Memory::Sliding(history) => {
                let y: Vec<Symmetric> = along.iter().map(remembered).collect();
                let past = convolve_points(&history.lines, &history.spectrum, &y);
                for (h, past) in h.iter_mut().zip(past) {
                    for k in 0..4 {
                        h[k] += past[k] + history.frozen_modulus * UNIT[k];
                    }
                }
            }
            Memory::Given(contribution) => {
                for (h, memory) in h.iter_mut().zip(&contribution[row][line]) {
                    for k in 0..4 {
                        h[k] += memory[k];
                    }
                }
            }
        }
        h
    }

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
