//! The one file with faer: dense LU, products, and the block elimination of node layers.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Accum, Mat, MatRef, Par};

pub use faer::Mat as Matrix;

/// LU factorisation with partial pivoting of a square matrix.
pub struct Factor(PartialPivLu<f64>);

impl Factor {
    pub fn new(matrix: MatRef<'_, f64>) -> Self {
        Self(PartialPivLu::new(matrix))
    }

    pub fn solve(&self, right: &mut Mat<f64>) {
        self.0.solve_in_place(right.as_mut());
    }
}

/// Solve a small dense system; None if it is singular to working precision.
pub fn solve_dense(matrix: &Mat<f64>, right: &[f64]) -> Option<Vec<f64>> {
    let mut x = column(right);
    Factor::new(matrix.as_ref()).solve(&mut x);
    let x: Vec<f64> = (0..right.len()).map(|i| x[(i, 0)]).collect();
    x.iter().all(|v| v.is_finite()).then_some(x)
}

pub fn column(values: &[f64]) -> Mat<f64> {
    Mat::from_fn(values.len(), 1, |i, _| values[i])
}

/// The entries of one column.
pub fn column_mut(matrix: &mut Mat<f64>, index: usize) -> &mut [f64] {
    matrix.col_as_slice_mut(index)
}

pub fn column_ref(matrix: &Mat<f64>, index: usize) -> &[f64] {
    matrix.col_as_slice(index)
}

/// target = left right.
pub fn product(target: &mut Mat<f64>, left: &Mat<f64>, right: &Mat<f64>) {
    matmul(
        target.as_mut(),
        Accum::Replace,
        left.as_ref(),
        right.as_ref(),
        1.0,
        Par::Seq,
    );
}

/// The node layers of a block, eliminated from the lid (fixed) down to the contact surface.
///
/// Every element row couples `layers` of unknowns, lowest first. Cost per row of bilinear elements:
/// 14/3 n^3 flops with n unknowns in a layer; a further right-hand side costs 6 n^2 a row.
pub struct Elimination {
    /// Contact surface first.
    rows: Vec<EliminatedRow>,
    layer: usize,
    /// Stiffness condensed to the contact surface.
    pub surface_matrix: Mat<f64>,
}

struct EliminatedRow {
    /// Factors of the upper layers' own block; None where only the fixed lid is above.
    factor: Option<Factor>,
    /// Rows of the lowest layer in the columns of the upper ones.
    lower_upper: Mat<f64>,
    /// u_upper = offset - coupling u_lowest.
    coupling: Mat<f64>,
}

/// A right-hand side carried down to the surface, with what is needed on the way back up.
pub struct Reduced {
    offsets: Vec<Mat<f64>>,
    pub surface_right: Vec<f64>,
}

impl Elimination {
    /// Factor a block whose layers have `layer` unknowns, from the matrices of its element rows:
    /// the uppermost, its last layer the fixed lid, and those below from the top down.
    pub fn new(layer: usize, uppermost: Mat<f64>, below: impl Iterator<Item = Mat<f64>>) -> Self {
        let (row, mut surface_matrix) =
            eliminate_row(&uppermost, layer, uppermost.nrows() - 2 * layer);
        let mut rows = vec![row];
        for mut matrix in below {
            let upper = matrix.nrows() - layer;
            add_block(&mut matrix, upper, &surface_matrix);
            let (row, schur) = eliminate_row(&matrix, layer, upper);
            rows.push(row);
            surface_matrix = schur;
        }
        rows.reverse();
        Self {
            rows,
            layer,
            surface_matrix,
        }
    }

    /// Carry the right-hand sides of all element rows down to the surface.
    pub fn reduce(&self, rights: &[Vec<f64>]) -> Reduced {
        let mut offsets = Vec::with_capacity(self.rows.len());
        let mut above = vec![0.0; self.layer];
        for (row, right) in self.rows.iter().zip(rights).rev() {
            let upper = row.lower_upper.ncols();
            let mut offset = Mat::from_fn(upper, 1, |i, _| right[self.layer + i]);
            if self.layer + upper == right.len() {
                // The uppermost layer is free: another row stands on it.
                for (i, value) in above.iter().enumerate() {
                    offset[(upper - self.layer + i, 0)] += value;
                }
            }
            if let Some(factor) = &row.factor {
                factor.solve(&mut offset);
            }
            let mut lower = column(&right[..self.layer]);
            if upper > 0 {
                add_product(&mut lower, &row.lower_upper, &offset, -1.0);
            }
            above = column_ref(&lower, 0).to_vec();
            offsets.push(offset);
        }
        offsets.reverse();
        Reduced {
            offsets,
            surface_right: above,
        }
    }

    /// All layers' unknowns (the lid excluded) from those of the contact surface.
    pub fn expand(&self, reduced: &Reduced, surface: &[f64]) -> Vec<f64> {
        let mut all = surface.to_vec();
        for (row, offset) in self.rows.iter().zip(&reduced.offsets) {
            let lowest = column(&all[all.len() - self.layer..]);
            let mut upper = offset.clone();
            if upper.nrows() > 0 {
                add_product(&mut upper, &row.coupling, &lowest, -1.0);
                all.extend_from_slice(column_ref(&upper, 0));
            }
        }
        all
    }
}

/// Eliminate the `upper` unknowns above the lowest layer of one element row.
fn eliminate_row(matrix: &Mat<f64>, lower: usize, upper: usize) -> (EliminatedRow, Mat<f64>) {
    let lower_upper = matrix.submatrix(0, lower, lower, upper).to_owned();
    let mut coupling = matrix.submatrix(lower, 0, upper, lower).to_owned();
    let mut schur = matrix.submatrix(0, 0, lower, lower).to_owned();
    let factor = (upper > 0).then(|| {
        let factor = Factor::new(matrix.submatrix(lower, lower, upper, upper));
        factor.solve(&mut coupling);
        add_product(&mut schur, &lower_upper, &coupling, -1.0);
        factor
    });
    let row = EliminatedRow {
        factor,
        lower_upper,
        coupling,
    };
    (row, schur)
}

/// target += factor left right.
fn add_product(target: &mut Mat<f64>, left: &Mat<f64>, right: &Mat<f64>, factor: f64) {
    let (left, right) = (left.as_ref(), right.as_ref());
    matmul(target.as_mut(), Accum::Add, left, right, factor, Par::Seq);
}

fn add_block(target: &mut Mat<f64>, at: usize, block: &Mat<f64>) {
    for j in 0..block.ncols() {
        let column = &mut column_mut(target, at + j)[at..];
        for (t, b) in column.iter_mut().zip(column_ref(block, j)) {
            *t += b;
        }
    }
}
