//! Dense matrices: LU with partial pivoting for some hundred rows, and inverses of complex blocks of a few
//! rows.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::MatMut;

use crate::spectral::Complex64;

pub use faer::Mat as Matrix;

pub struct Factor(PartialPivLu<f64>);

impl Factor {
    /// Of a square matrix.
    pub fn new(matrix: &Matrix<f64>) -> Self {
        Self(PartialPivLu::new(matrix.as_ref()))
    }

    /// Replace `right` by the solution; false if the matrix is singular to working precision.
    #[must_use]
    pub fn solve(&self, right: &mut [f64]) -> bool {
        let size = right.len();
        let column = MatMut::from_column_major_slice_mut(right, size, 1);
        self.0.solve_in_place(column);
        right.iter().all(|value| value.is_finite())
    }
}

/// Replace a small square matrix, column-major, by its inverse (Gauss-Jordan elimination with partial
/// pivoting); false if it is singular.
///
/// There is one such matrix for every harmonic and element row. The calls of a general solver would take
/// longer than the inversion.
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
