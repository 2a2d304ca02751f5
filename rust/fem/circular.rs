//! Sums round the periodic line of columns, over contiguous slices that vectors can hold.

use crate::material::kinematics::Symmetric;

/// sum over columns e' of weights[e - e'] y(e'), for every point of a column by itself.
pub fn convolve(weights: &[f64], y: &[Symmetric]) -> Vec<Symmetric> {
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
