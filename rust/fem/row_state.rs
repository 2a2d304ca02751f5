//! Deformation gradients and remembered state at the Gauss points of one element row.

use super::block::{Block, Memory, RowState};
use crate::material::kinematics::{contract, isochoric, remembered, Gradient, Symmetric, UNIT};

impl RowState {
    /// What the temporary networks remember of the row's deformation, `[line][column * points + point]`.
    pub fn remembered(&self) -> Vec<Vec<Symmetric>> {
        let lines = self.gradient.iter();
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
                for (node, slope) in element.gradient[at].iter().enumerate() {
                    let ux = u[offset + unknowns[2 * node]];
                    let uz = u[offset + unknowns[2 * node + 1]];
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
                let y: Vec<Symmetric> = gradient.iter().map(remembered).collect();
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
        let element = &self.mesh.elements[row];
        let points = self.points();
        let Memory::Sliding(history) = self.memory else {
            return 0.0;
        };
        let mut lost = 0.0;
        for (line, gradient) in state.gradient.iter().enumerate() {
            let y: Vec<Symmetric> = gradient.iter().map(remembered).collect();
            let rate = convolve(&history.dissipation, &y);
            for (q, f) in gradient.iter().enumerate() {
                let weight = element.weight[line * points + q % points];
                lost += 0.5 * weight * contract(&rate[q], &isochoric(f));
            }
        }
        lost
    }
}

/// sum over columns e' of weights[e - e'] y(e'), for every point of a column by itself.
fn convolve(weights: &[f64], y: &[Symmetric]) -> Vec<Symmetric> {
    pulp::Arch::new().dispatch(|| convolve_vectorised(weights, y))
}

#[inline(always)]
fn convolve_vectorised(weights: &[f64], y: &[Symmetric]) -> Vec<Symmetric> {
    let columns = weights.len();
    let points = y.len() / columns;
    let turned: Vec<f64> = weights.iter().rev().copied().collect();
    let mut out = vec![[0.0; 4]; y.len()];
    // One component of one point, twice over, so that every sum runs over a contiguous slice.
    let mut line = vec![0.0; 2 * columns];
    for point in 0..points {
        for k in 0..4 {
            for (column, value) in line.iter_mut().enumerate() {
                *value = y[column % columns * points + point][k];
            }
            for column in 0..columns {
                let window = &line[column + 1..column + 1 + columns];
                out[column * points + point][k] = dot_by_eights(&turned, window);
            }
        }
    }
    out
}

/// Dot product in eight running sums, which vectors can hold.
#[inline(always)]
fn dot_by_eights(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_chunks, b_chunks) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a_chunks
        .remainder()
        .iter()
        .zip(b_chunks.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in a_chunks.zip(b_chunks) {
        for i in 0..8 {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}
