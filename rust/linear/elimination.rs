//! Block elimination of the node layers of a mesh, dense within a layer.

use faer::Mat;

use super::dense::{add_block, add_product, column, column_ref, Factor};
use crate::status::Status;
use crate::watch::Watch;

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
    pub fn new(
        layer: usize,
        uppermost: Mat<f64>,
        below: impl Iterator<Item = Result<Mat<f64>, Status>>,
        watch: &Watch<'_>,
    ) -> Result<Self, Status> {
        let upper = uppermost.nrows() - 2 * layer;
        let (row, mut surface_matrix) = eliminate_row(&uppermost, layer, upper, watch)?;
        let mut rows = vec![row];
        for matrix in below {
            let mut matrix = matrix?;
            let upper = matrix.nrows() - layer;
            add_block(&mut matrix, upper, &surface_matrix);
            let (row, schur) = eliminate_row(&matrix, layer, upper, watch)?;
            rows.push(row);
            surface_matrix = schur;
        }
        rows.reverse();
        Ok(Self {
            rows,
            layer,
            surface_matrix,
        })
    }

    /// Carry the right-hand sides of all element rows down to the surface.
    pub fn reduce(&self, rights: &[Vec<f64>], watch: &Watch<'_>) -> Result<Reduced, Status> {
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
                factor.solve(&mut offset, watch)?;
            }
            let mut lower = column(&right[..self.layer]);
            if upper > 0 {
                add_product(&mut lower, &row.lower_upper, &offset, -1.0, watch)?;
            }
            above = column_ref(&lower, 0).to_vec();
            offsets.push(offset);
        }
        offsets.reverse();
        Ok(Reduced {
            offsets,
            surface_right: above,
        })
    }

    /// All layers' unknowns (the lid excluded) from those of the contact surface.
    pub fn expand(
        &self,
        reduced: &Reduced,
        surface: &[f64],
        watch: &Watch<'_>,
    ) -> Result<Vec<f64>, Status> {
        let mut all = surface.to_vec();
        for (row, offset) in self.rows.iter().zip(&reduced.offsets) {
            let lowest = column(&all[all.len() - self.layer..]);
            let mut upper = offset.clone();
            if upper.nrows() > 0 {
                add_product(&mut upper, &row.coupling, &lowest, -1.0, watch)?;
                all.extend_from_slice(column_ref(&upper, 0));
            }
        }
        Ok(all)
    }
}

/// Eliminate the `upper` unknowns above the lowest layer of one element row.
fn eliminate_row(
    matrix: &Mat<f64>,
    lower: usize,
    upper: usize,
    watch: &Watch<'_>,
) -> Result<(EliminatedRow, Mat<f64>), Status> {
    // Even copies of the largest blocks take their time.
    let copy = |row, column, rows, columns| {
        watch.look()?;
        Ok(matrix.submatrix(row, column, rows, columns).to_owned())
    };
    let mut row = EliminatedRow {
        factor: None,
        lower_upper: copy(0, lower, lower, upper)?,
        coupling: copy(lower, 0, upper, lower)?,
    };
    let mut schur = copy(0, 0, lower, lower)?;
    if upper > 0 {
        let factor = Factor::new(matrix.submatrix(lower, lower, upper, upper), watch)?;
        factor.solve(&mut row.coupling, watch)?;
        add_product(&mut schur, &row.lower_upper, &row.coupling, -1.0, watch)?;
        row.factor = Some(factor);
    }
    Ok((row, schur))
}
