//! Inverses of complex matrices of a few rows, of which there is one per harmonic and element row:
//! a general solver spends longer on its calls than on them.

use crate::spectral::Complex64;

/// Replace a small square matrix, column-major, by its inverse (Gauss-Jordan elimination with partial
/// pivoting); false if it is singular.
pub fn invert(matrix: &mut [Complex64], size: usize) -> bool {
    let mut exchanged = Vec::with_capacity(size);
    for k in 0..size {
        let largest = |a: &usize, b: &usize| {
            let norm = |i: usize| matrix[k * size + i].norm_sqr();
            norm(*a).total_cmp(&norm(*b))
        };
        let pivot = (k..size).max_by(largest).unwrap_or(k);
        exchanged.push(pivot);
        if pivot != k {
            (0..size).for_each(|j| matrix.swap(j * size + k, j * size + pivot));
        }
        let inverse = matrix[k * size + k].inv();
        if !inverse.is_finite() {
            return false;
        }
        matrix[k * size + k] = Complex64::new(1.0, 0.0);
        for j in 0..size {
            matrix[j * size + k] *= inverse;
        }
        for i in (0..size).filter(|&i| i != k) {
            let factor = std::mem::take(&mut matrix[k * size + i]);
            for j in 0..size {
                let above = matrix[j * size + k];
                matrix[j * size + i] -= factor * above;
            }
        }
    }
    for (k, &pivot) in exchanged.iter().enumerate().rev() {
        (0..size).for_each(|i| matrix.swap(k * size + i, pivot * size + i));
    }
    true
}
