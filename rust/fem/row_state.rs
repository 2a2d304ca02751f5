//! Deformation gradients and memory at the Gauss points of one element row.

use super::block::{Block, Memory, RowState};
use crate::material::kinematics::{remembered, Deformation, Gradient, Symmetric, UNIT};
use crate::spectral::convolve_points;

impl RowState {
    /// What the temporary networks remember of the row's deformation, `[line][column * points + point]`.
    pub fn remembered(&self) -> Vec<Vec<Symmetric>> {
        let lines = self.deformation.iter();
        lines
            .map(|line| line.iter().map(remembered).collect())
            .collect()
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
        let deformation: Vec<Vec<Deformation>> = gradients
            .map(|line| line.iter().map(Deformation::from).collect())
            .collect();
        let h = (0..deformation.len())
            .map(|line| self.network_stress(row, line, &deformation[line]))
            .collect();
        RowState { deformation, h }
    }

    /// H along one line: permanent network and memory.
    fn network_stress(&self, row: usize, line: usize, along: &[Deformation]) -> Vec<Symmetric> {
        let mut h: Vec<Symmetric> = along
            .iter()
            .map(|f| self.energy.network(f).map(|b| self.equilibrium * b))
            .collect();
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
}
