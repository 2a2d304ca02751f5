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
    match matrix.col_mut(index).try_as_col_major_mut() {
        Some(column) => column.as_slice_mut(),
        None => &mut [],
    }
}

pub fn column_ref(matrix: &Mat<f64>, index: usize) -> &[f64] {
    match matrix.col(index).try_as_col_major() {
        Some(column) => column.as_slice(),
        None => &[],
    }
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

/// One element row: its matrix over the node layers it spans, lowest layer first.
pub struct RowSystem {
    pub matrix: Mat<f64>,
    pub right: Vec<f64>,
}

/// What elimination leaves behind: u_upper = offset - coupling u_lowest, for every element row.
pub struct Elimination {
    rows: Vec<(Mat<f64>, Vec<f64>)>,
    /// Stiffness condensed to the contact surface.
    pub surface_matrix: Mat<f64>,
    /// Residual condensed to the contact surface (right-hand sides carry the sign of K u = right).
    pub surface_right: Vec<f64>,
    layer: usize,
}

/// Eliminates the node layers from the lid down to the contact surface.
///
/// `row(r)` builds element row r; the lid (last layer) is fixed. Cost per row of bilinear
/// elements: 14/3 n^3 flops with n unknowns in a layer.
pub fn eliminate(
    rows: usize,
    layer: usize,
    mut row: impl FnMut(usize) -> RowSystem,
) -> Elimination {
    let mut kept: Vec<(Mat<f64>, Vec<f64>)> = Vec::with_capacity(rows);
    let mut above: Option<(Mat<f64>, Vec<f64>)> = None;
    for r in (0..rows).rev() {
        let mut system = row(r);
        let full = system.right.len();
        let top = full - layer;
        // The lid is fixed: its layer leaves the system of the uppermost row.
        let size = if above.is_none() { top } else { full };
        if let Some((matrix, right)) = above.take() {
            add_block(&mut system, top, &matrix, &right);
        }
        let (lower, upper) = (layer, size - layer);
        if upper == 0 {
            kept.push((Mat::zeros(0, layer), Vec::new()));
            above = Some((
                system.matrix.submatrix(0, 0, lower, lower).to_owned(),
                system.right[..lower].to_vec(),
            ));
            continue;
        }
        let factor = Factor::new(system.matrix.submatrix(lower, lower, upper, upper));
        let mut solved = Mat::from_fn(upper, lower + 1, |i, j| {
            if j < lower {
                system.matrix[(lower + i, j)]
            } else {
                system.right[lower + i]
            }
        });
        factor.solve(&mut solved);
        let mut product = Mat::<f64>::zeros(lower, lower + 1);
        matmul(
            product.as_mut(),
            Accum::Replace,
            system.matrix.submatrix(0, lower, lower, upper),
            solved.as_ref(),
            1.0,
            Par::Seq,
        );
        let matrix = Mat::from_fn(lower, lower, |i, j| system.matrix[(i, j)] - product[(i, j)]);
        let right = (0..lower)
            .map(|i| system.right[i] - product[(i, lower)])
            .collect();
        let offset = (0..upper).map(|i| solved[(i, lower)]).collect();
        kept.push((solved.submatrix(0, 0, upper, lower).to_owned(), offset));
        above = Some((matrix, right));
    }
    kept.reverse();
    let (surface_matrix, surface_right) =
        above.unwrap_or_else(|| (Mat::zeros(layer, layer), vec![0.0; layer]));
    Elimination {
        rows: kept,
        surface_matrix,
        surface_right,
        layer,
    }
}

impl Elimination {
    /// All layers' unknowns (the lid excluded) from those of the contact surface.
    pub fn expand(&self, surface: &[f64]) -> Vec<f64> {
        let mut all = surface.to_vec();
        for (coupling, offset) in &self.rows {
            let lowest = column(&all[all.len() - self.layer..]);
            let mut upper = column(offset);
            matmul(
                upper.as_mut(),
                Accum::Add,
                coupling.as_ref(),
                lowest.as_ref(),
                -1.0,
                Par::Seq,
            );
            all.extend((0..offset.len()).map(|i| upper[(i, 0)]));
        }
        all
    }
}

fn add_block(system: &mut RowSystem, at: usize, matrix: &Mat<f64>, right: &[f64]) {
    for j in 0..right.len() {
        for i in 0..right.len() {
            system.matrix[(at + i, at + j)] += matrix[(i, j)];
        }
        system.right[at + j] += right[j];
    }
}
