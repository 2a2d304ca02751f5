//! LU of dense matrices of some hundred rows, with partial pivoting.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::MatMut;

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
