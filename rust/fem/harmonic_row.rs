//! One element row in one harmonic of x, for slopes that are the same in all columns.
//!
//! The next column is this one times t = exp(2 pi i k / N), so that grad u = (E + t E') u: E acts on the
//! nodes of this column, E' on the right-hand nodes, which belong to the next column. With the stiffness D
//! at fixed memory, the memory's stiffness M and harmonic w, the matrix is a sum of real ones:
//!     (E + t E')^H (D + w M) (E + t E') = D_0 + t D_1 + D_2 / t + w (M_0 + t M_1 + M_2 / t)

use super::mesh::Mesh;
use super::point_slopes::AveragedSlopes;
use crate::spectral::Complex64;

pub struct HarmonicRow {
    /// Displacement unknowns, those of the layer above included.
    pub size: usize,
    /// Factors of 1, t and 1 / t, column-major, pressures condensed.
    stiffness: [Vec<f64>; 3],
    memory: [Vec<f64>; 3],
    /// Forces per unit pressure mode, factors of 1 and 1 / t, `[mode][unknown]`.
    pressing: [Vec<f64>; 2],
}

impl HarmonicRow {
    pub fn new(mesh: &Mesh, row: usize, averages: &[AveragedSlopes], bulk_modulus: f64) -> Self {
        let element = &mesh.elements[row];
        let order = mesh.order;
        let size = 2 * order * (order + 1);
        let zeros = || std::array::from_fn(|_| vec![0.0; size * size]);
        let mut out = Self {
            size,
            stiffness: zeros(),
            memory: zeros(),
            pressing: std::array::from_fn(|_| vec![0.0; size * mesh.modes()]),
        };
        for (at, average) in averages.iter().enumerate() {
            // Slopes of F by every unknown, of this column and of the next.
            let mut slopes = [vec![[0.0; 4]; size], vec![[0.0; 4]; size]];
            for (node, slope) in element.gradient[at].iter().enumerate() {
                let (layer, sub) = (node / (order + 1), node % (order + 1));
                for direction in 0..2 {
                    let unknown = (2 * layer + direction) * order + sub % order;
                    let to = &mut slopes[usize::from(sub == order)][unknown];
                    to[2 * direction] += slope[0];
                    to[2 * direction + 1] += slope[1];
                }
            }
            add_products(&mut out.stiffness, &slopes, &average.stiffness);
            if let Some(memory) = &average.memory {
                add_products(&mut out.memory, &slopes, memory);
            }
            for (m, mode) in element.mode[at].iter().enumerate() {
                for (pressing, slopes) in out.pressing.iter_mut().zip(&slopes) {
                    for (i, slope) in slopes.iter().enumerate() {
                        let volume: f64 =
                            slope.iter().zip(average.volume).map(|(s, v)| s * v).sum();
                        pressing[m * size + i] += mode * volume;
                    }
                }
            }
        }
        for (m, mass) in element.mode_mass.iter().enumerate() {
            out.condense(m, bulk_modulus / mass);
        }
        out
    }

    /// Add K / M (b + b' / t) (b + t b')^T of one pressure mode.
    fn condense(&mut self, mode: usize, stiffness: f64) {
        let size = self.size;
        let [this, next] = [0, 1].map(|side| &self.pressing[side][mode * size..][..size]);
        let [by_one, by_t, by_back] = &mut self.stiffness;
        for j in 0..size {
            for i in 0..size {
                let at = j * size + i;
                by_one[at] += stiffness * (this[i] * this[j] + next[i] * next[j]);
                by_t[at] += stiffness * this[i] * next[j];
                by_back[at] += stiffness * next[i] * this[j];
            }
        }
    }

    /// The matrix of a harmonic, column-major, for t = `phase` and the memory's harmonic `weight`.
    pub fn matrix(&self, phase: Complex64, weight: Option<Complex64>, out: &mut [Complex64]) {
        let sum = |parts: &[Vec<f64>; 3], at: usize| {
            parts[0][at] + phase * parts[1][at] + phase.conj() * parts[2][at]
        };
        for (at, entry) in out.iter_mut().enumerate() {
            *entry = sum(&self.stiffness, at);
            if let Some(weight) = weight {
                *entry += weight * sum(&self.memory, at);
            }
        }
    }

    /// Forces per unit pressure modes in a harmonic, `[mode][unknown]`.
    pub fn pressing(&self, phase: Complex64) -> impl Iterator<Item = Complex64> + '_ {
        let [this, next] = &self.pressing;
        let pairs = this.iter().zip(next);
        pairs.map(move |(this, next)| this + phase.conj() * next)
    }
}

/// Add the products of the slopes with a 4 x 4 matrix in between, by powers of t.
fn add_products(to: &mut [Vec<f64>; 3], slopes: &[Vec<[f64; 4]>; 2], between: &[f64; 16]) {
    let size = slopes[0].len();
    for (side_j, by_j) in slopes.iter().enumerate() {
        for (j, slope_j) in by_j.iter().enumerate() {
            let stress: [f64; 4] =
                std::array::from_fn(|a| (0..4).map(|b| between[4 * a + b] * slope_j[b]).sum());
            for (side_i, by_i) in slopes.iter().enumerate() {
                let power = match (side_i, side_j) {
                    (0, 1) => 1,
                    (1, 0) => 2,
                    _ => 0,
                };
                for (i, slope_i) in by_i.iter().enumerate() {
                    let force: f64 = slope_i.iter().zip(stress).map(|(s, p)| s * p).sum();
                    to[power][j * size + i] += force;
                }
            }
        }
    }
}
