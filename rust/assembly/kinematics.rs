//! Deformation gradients and remembered state at the Gauss points of one element row.

use super::{Block, Memory, RowState};
use crate::network::{self, Gradient, Symmetric, UNIT};

impl Block<'_> {
    /// Deformation gradients of one row for displacements `u`, or increments if `identity` is 0.
    pub fn gradients(&self, row: usize, u: &[f64], identity: f64) -> Vec<Vec<Gradient>> {
        let element = &self.cell.elements[row];
        let points = self.points();
        let offset = self.row_offset(row);
        let mut out = vec![vec![[0.0; 4]; self.cell.columns * points]; points];
        for column in 0..self.cell.columns {
            let unknowns = self.local_unknowns(column);
            for line in 0..points {
                for point in 0..points {
                    let mut f = [identity, 0.0, 0.0, identity];
                    let shape = &element.gradient[line * points + point];
                    for (node, slope) in shape.iter().enumerate() {
                        let ux = u[offset + unknowns[2 * node]];
                        let uz = u[offset + unknowns[2 * node + 1]];
                        f[0] += ux * slope[0];
                        f[1] += ux * slope[1];
                        f[2] += uz * slope[0];
                        f[3] += uz * slope[1];
                    }
                    out[line][column * points + point] = f;
                }
            }
        }
        out
    }

    pub fn row_state(&self, row: usize, u: &[f64]) -> RowState {
        let gradient = self.gradients(row, u, 1.0);
        let h = (0..gradient.len())
            .map(|line| self.remember(row, line, &gradient[line]))
            .collect();
        RowState { gradient, h }
    }

    /// H along one line: permanent network and memory.
    fn remember(&self, row: usize, line: usize, gradient: &[Gradient]) -> Vec<Symmetric> {
        let mut h: Vec<Symmetric> = gradient
            .iter()
            .map(|f| self.energy.network(f).map(|b| self.equilibrium * b))
            .collect();
        match self.memory {
            Memory::Relaxed => {}
            Memory::Sliding(history) => {
                let y: Vec<Symmetric> = gradient.iter().map(network::remembered).collect();
                for (h, past) in h.iter_mut().zip(convolve(&history.stress, &y)) {
                    for k in 0..4 {
                        h[k] += past[k] + history.frozen_modulus * UNIT[k];
                    }
                }
            }
            Memory::Given(state) => {
                for (h, given) in h.iter_mut().zip(&state[row][line]) {
                    for k in 0..4 {
                        h[k] += given[k];
                    }
                }
            }
        }
        h
    }

    /// Energy lost per sliding distance in one row: 1/2 sum weight Y : Cbar.
    pub fn row_dissipation(&self, row: usize, state: &RowState) -> f64 {
        let element = &self.cell.elements[row];
        let points = self.points();
        let Memory::Sliding(history) = self.memory else {
            return 0.0;
        };
        let mut lost = 0.0;
        for (line, gradient) in state.gradient.iter().enumerate() {
            let y: Vec<Symmetric> = gradient.iter().map(network::remembered).collect();
            let rate = convolve(&history.dissipation, &y);
            for (q, f) in gradient.iter().enumerate() {
                let weight = element.weight[line * points + q % points];
                lost += 0.5 * weight * network::contract(&rate[q], &network::isochoric(f));
            }
        }
        lost
    }
}

/// sum over columns e' of weights[e - e'] y(e'), for every point of a column by itself.
fn convolve(weights: &[f64], y: &[Symmetric]) -> Vec<Symmetric> {
    let columns = weights.len();
    let points = y.len() / columns;
    let mut out = vec![[0.0; 4]; y.len()];
    for point in 0..points {
        for column in 0..columns {
            let sum = &mut out[column * points + point];
            for (distance, weight) in weights.iter().enumerate() {
                let source = (column + columns - distance) % columns;
                for (s, value) in sum.iter_mut().zip(&y[source * points + point]) {
                    *s += weight * value;
                }
            }
        }
    }
    out
}
