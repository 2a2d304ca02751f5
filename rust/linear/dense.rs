//! Dense matrices: LU factorisation and solutions.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::matmul::matmul;
use faer::linalg::solvers::PartialPivLu;
use faer::perm::{permute_rows_in_place, permute_rows_in_place_scratch, PermRef};
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par};

use crate::status::Status;
use crate::threads::Threads;
use crate::watch::Watch;

pub use faer::Mat as Matrix;

/// Most columns of a matrix that are worked on at a time: some ten milliseconds of work at the
/// sizes of the finest meshes.
const TILE: usize = 512;
/// Columns after a panel that a thread takes at a time.
const STRIP: usize = 128;

/// LU factorisation with partial pivoting of a square matrix, panel by panel of `TILE` columns.
///
/// Right-looking (Golub & Van Loan, Matrix Computations, 4th ed., section 3.4.7): a panel of all
/// rows still left is factored, its exchanges of rows and its U done to the columns that follow.
pub struct Factor {
    panels: Vec<Panel>,
}

struct Panel {
    /// First row and column.
    at: usize,
    lu: PartialPivLu<f64>,
    /// Rows of the panel in the columns after it.
    after: Mat<f64>,
}

impl Factor {
    /// Factor `matrix`; looks at the watch between panels and tiles.
    pub fn new(matrix: MatRef<'_, f64>, watch: &Watch<'_>) -> Result<Self, Status> {
        let size = matrix.nrows();
        if size <= TILE {
            watch.look()?;
            let (lu, after) = (PartialPivLu::new(matrix), Mat::zeros(size, 0));
            return Ok(Self {
                panels: vec![Panel { at: 0, lu, after }],
            });
        }
        let mut panels = Vec::new();
        let mut left = matrix.to_owned();
        for at in (0..size).step_by(TILE) {
            watch.look()?;
            let width = TILE.min(size - at);
            let lu = PartialPivLu::new(left.get(.., ..width));
            let mut rest = left.get(.., width..).to_owned();
            let panel = Panel {
                at,
                lu,
                after: Mat::zeros(width, 0),
            };
            panel.forward_all(rest.as_mut(), watch)?;
            left = rest.get(width.., ..).to_owned();
            let after = rest.get(..width, ..).to_owned();
            panels.push(Panel { after, ..panel });
        }
        Ok(Self { panels })
    }

    /// Replace `right` by the solution, tile by tile of its columns.
    pub fn solve(&self, right: &mut Mat<f64>, watch: &Watch<'_>) -> Result<(), Status> {
        for tile in tiles(right.ncols()) {
            let mut part = right.get_mut(.., tile);
            for panel in &self.panels {
                watch.look()?;
                panel.forward(part.rb_mut().get_mut(panel.at.., ..));
            }
            for panel in self.panels.iter().rev() {
                watch.look()?;
                panel.backward(part.rb_mut().get_mut(panel.at.., ..));
            }
        }
        Ok(())
    }
}

impl Panel {
    fn width(&self) -> usize {
        self.lu.U().ncols()
    }

    /// `forward` for the columns after the panel.
    fn forward_all(&self, columns: MatMut<'_, f64>, watch: &Watch<'_>) -> Result<(), Status> {
        let size = 2 * self.width() / 16 * columns.nrows() * columns.ncols();
        let (mut strips, mut left) = (Vec::new(), columns);
        while left.ncols() > 0 {
            let width = left.ncols().min(STRIP);
            let (strip, rest) = left.split_at_col_mut(width);
            strips.push(strip);
            left = rest;
        }
        let mut rooms = vec![(); watch.threads.on(size)];
        let look = || watch.look();
        watch
            .threads
            .share_until(size, &mut rooms, strips.into_iter(), look, |(), strip| {
                self.forward(strip);
            })
    }

    /// From the right-hand side of the rows that were left to L^-1 of it, and those below less
    /// their share.
    fn forward(&self, mut right: MatMut<'_, f64>) {
        let (factor, width) = (self.lu.L(), self.width());
        permute_rows(right.rb_mut(), self.lu.P());
        let (mut own, below) = right.split_at_row_mut(width);
        factor
            .get(..width, ..)
            .solve_unit_lower_triangular_in_place(own.rb_mut());
        matmul(
            below,
            Accum::Add,
            factor.get(width.., ..),
            own.rb(),
            -1.0,
            Par::Seq,
        );
    }

    /// Back substitution in the rows of the panel, those below solved.
    fn backward(&self, right: MatMut<'_, f64>) {
        let (mut own, below) = right.split_at_row_mut(self.width());
        let after = self.after.as_ref();
        matmul(own.rb_mut(), Accum::Add, after, below.rb(), -1.0, Par::Seq);
        self.lu.U().solve_upper_triangular_in_place(own);
    }
}

fn permute_rows(mut target: MatMut<'_, f64>, order: PermRef<'_, usize>) {
    let scratch = permute_rows_in_place_scratch::<usize, f64>(target.nrows(), target.ncols());
    let mut memory = MemBuffer::new(scratch);
    permute_rows_in_place(target.rb_mut(), order, MemStack::new(&mut memory));
}

fn tiles(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count)
        .step_by(TILE)
        .map(move |from| from..count.min(from + TILE))
}

/// Solve a small dense system; None if it is singular to working precision.
pub fn solve_dense(
    matrix: &Mat<f64>,
    right: &[f64],
    watch: &Watch<'_>,
) -> Result<Option<Vec<f64>>, Status> {
    let solved = solve_columns(matrix, column(right), watch)?;
    Ok(solved.map(|x| column_ref(&x, 0).to_vec()))
}

/// The same for every column of `right`.
pub fn solve_columns(
    matrix: &Mat<f64>,
    mut right: Mat<f64>,
    watch: &Watch<'_>,
) -> Result<Option<Mat<f64>>, Status> {
    Factor::new(matrix.as_ref(), watch)?.solve(&mut right, watch)?;
    let columns = 0..right.ncols();
    let finite = |j: usize| column_ref(&right, j).iter().all(|v| v.is_finite());
    Ok(columns.into_iter().all(finite).then_some(right))
}

/// The square matrix of these entries by row and column.
pub fn from_entries(
    size: usize,
    entry: impl Fn(usize, usize) -> f64 + Sync,
    threads: &Threads,
) -> Mat<f64> {
    let mut matrix = Mat::zeros(size, size);
    let work = 16 * size * size;
    let mut rooms = vec![(); threads.on(work)];
    let columns = matrix.col_iter_mut().enumerate();
    threads.share(work, &mut rooms, columns, |(), (j, column)| {
        for (i, value) in column.iter_mut().enumerate() {
            *value = entry(i, j);
        }
    });
    matrix
}

pub fn column(values: &[f64]) -> Mat<f64> {
    Mat::from_fn(values.len(), 1, |i, _| values[i])
}

/// The entries of one column.
pub fn column_ref(matrix: &Mat<f64>, index: usize) -> &[f64] {
    matrix.col_as_slice(index)
}
