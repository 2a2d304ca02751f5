//! Sums round the periodic line of columns: over contiguous slices that vectors can hold where they are
//! few, in harmonics where they are many.

use crate::material::kinematics::Symmetric;
use crate::material::sliding_history::SlidingHistory;
use crate::spectral::{Complex64, Lines};

/// Most columns that are summed directly.
const DIRECTLY: usize = 128;

/// Whether sums over this many columns are taken directly.
pub fn directly(columns: usize) -> bool {
    columns <= DIRECTLY
}

/// H of what is remembered: the sum over columns e' of weights[e - e'] y(e'), for every point of a
/// column by itself.
pub fn convolve(history: &SlidingHistory, y: &[Symmetric]) -> Vec<Symmetric> {
    if directly(history.stress.len()) {
        let weights = &history.stress;
        return pulp::Arch::new().dispatch(|| convolve_vectorised(weights, y));
    }
    let mut lines = history.lines.clone();
    let (columns, mut out) = (lines.len(), vec![[0.0; 4]; y.len()]);
    let points = y.len() / columns;
    let mut line = vec![0.0; columns];
    for point in 0..points {
        for k in 0..4 {
            let from = y.iter().skip(point).step_by(points);
            line.iter_mut()
                .zip(from)
                .for_each(|(value, y)| *value = y[k]);
            lines.convolve(&history.spectrum, &mut line);
            let to = out.iter_mut().skip(point).step_by(points);
            to.zip(&line).for_each(|(h, value)| h[k] = *value);
        }
    }
    out
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

/// Add `weight` sum over columns e of y(e - m) c(e) to both of `sums[m]`.
pub fn correlate(weight: f64, y: &[f64], c: &[f64], sums: [&mut [f64]; 2]) {
    pulp::Arch::new().dispatch(|| correlate_vectorised(weight, y, c, sums));
}

#[inline(always)]
fn correlate_vectorised(weight: f64, y: &[f64], c: &[f64], [one, other]: [&mut [f64]; 2]) {
    let columns = c.len();
    let twice = [y, y].concat();
    for (m, (one, other)) in one.iter_mut().zip(other).enumerate() {
        let sum = weight * dot_by_eights(&twice[columns - m..2 * columns - m], c);
        *one += sum;
        *other += sum;
    }
}

/// Sums over columns e of y(e - m) c(e), for every m, of many pairs of lines together.
pub struct Correlations {
    lines: Lines,
    harmonics: [Vec<Complex64>; 2],
    sum: Vec<Complex64>,
}

impl Correlations {
    pub fn new(columns: usize) -> Self {
        let lines = Lines::new(columns);
        let nothing = vec![Complex64::default(); lines.harmonics()];
        Self {
            lines,
            harmonics: [nothing.clone(), nothing.clone()],
            sum: nothing,
        }
    }

    /// Add `weight` times the sums of one pair.
    pub fn add(&mut self, weight: f64, y: &[f64], c: &[f64]) {
        let [of_y, of_c] = &mut self.harmonics;
        self.lines.forward(y, of_y);
        self.lines.forward(c, of_c);
        for (sum, (y, c)) in self.sum.iter_mut().zip(of_y.iter().zip(of_c)) {
            *sum += weight * y.conj() * *c;
        }
    }

    /// The sums of all pairs, to begin anew.
    pub fn take(&mut self) -> Vec<f64> {
        let mut sums = vec![0.0; self.lines.len()];
        self.lines.inverse(&self.sum, &mut sums);
        self.sum.fill(Complex64::default());
        sums
    }
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
