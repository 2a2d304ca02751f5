//! Filters of periodic maps in single precision: each wave times its factor,
//!     g = F^-1 (c F f),
//! by transforms of the rows, of the columns, and back. The result does not depend on the number of threads.

use std::sync::Arc;

use rustfft::{Fft, FftPlanner};

use crate::executor::Executor;
use crate::spectral::{Complex32, Lines};
use crate::status::Status;

/// Side of the squares of waves that spectra are stored in: they are read by rows and by columns, and memory is
/// fast where a whole square follows.
const SIDE: usize = 16;
/// Waves after which rows fall on the same lines of a cache, and by how many they are shifted.
const CACHE_PERIOD: usize = 512;
const SHIFT: usize = 8;

/// Filter of maps of one shape.
pub struct MapFilter {
    rows: usize,
    columns: usize,
    lines: Lines<f32>,
    forward: Arc<dyn Fft<f32>>,
    inverse: Arc<dyn Fft<f32>>,
}

/// A row, and memory for the rows beside it.
pub struct RowBuffers {
    pub row: Vec<f32>,
    pub above: Vec<f32>,
    pub below: Vec<f32>,
}

impl MapFilter {
    pub fn new(rows: usize, columns: usize) -> Self {
        let mut planner = FftPlanner::new();
        Self {
            rows,
            columns,
            lines: Lines::new(columns),
            forward: planner.plan_fft_forward(rows),
            inverse: planner.plan_fft_inverse(rows),
        }
    }

    pub fn rows(&self) -> usize {
        self.rows
    }

    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of factors.
    pub fn waves(&self) -> usize {
        self.rows * self.lines.harmonics()
    }

    /// Complex numbers of the memory for two spectra in squares.
    pub fn memory(&self) -> usize {
        2 * SIDE * SIDE * self.row_groups() * self.column_groups()
    }

    /// Filter the map whose rows `read` sets; `write` takes each filtered row to its part of `out`.
    pub fn apply(
        &self,
        executor: &Executor<'_>,
        factors: &[Complex32],
        memory: &mut [Complex32],
        read: impl Fn(usize, &mut RowBuffers) + Sync,
        out: Vec<&mut [f32]>,
        write: impl Fn(usize, &[f32], &mut [f32]) + Sync,
    ) -> Result<(), Status> {
        let (by_rows, by_columns) = memory.split_at_mut(self.memory() / 2);
        let size = 4 * self.waves();
        let zeros = || vec![0.0; self.columns];
        let buffers = || RowBuffers { row: zeros(), above: zeros(), below: zeros() };
        let waves = |rows: usize, stride: usize| vec![Complex32::default(); rows * stride];
        let harmonics = SIDE * self.column_groups();

        let work = || (self.lines.clone(), buffers(), waves(1, harmonics));
        let groups = by_rows.chunks_mut(SIDE * harmonics).enumerate();
        executor.share(size, work, groups, |(lines, buffers, waves), (group, to)| {
            for i in SIDE * group..self.rows.min(SIDE * (group + 1)) {
                read(i, buffers);
                lines.forward(&buffers.row, &mut waves[..lines.harmonics()]);
                for (square, waves) in to.chunks_mut(SIDE * SIDE).zip(waves.chunks(SIDE)) {
                    square[i % SIDE * SIDE..][..SIDE].copy_from_slice(waves);
                }
            }
        })?;

        let work = || (waves(SIDE, padded(self.rows)), self.scratch());
        let groups = by_columns.chunks_mut(SIDE * SIDE * self.row_groups()).enumerate();
        executor.share(size, work, groups, |(columns, scratch), (group, to)| {
            let squares = by_rows[group * SIDE * SIDE..].chunks(SIDE * harmonics);
            self.filter_columns(group, squares, factors, to, columns, scratch);
        })?;

        let work = || (self.lines.clone(), zeros(), waves(SIDE, padded(harmonics)));
        let mut out = out.into_iter();
        let groups = (0..self.row_groups()).map(|group| {
            let to: Vec<_> = out.by_ref().take(SIDE).collect();
            (group, to)
        });
        executor.share(size, work, groups, |(lines, row, waves), (group, to)| {
            let squares = by_columns[group * SIDE * SIDE..].chunks(SIDE * SIDE * self.row_groups());
            for (k, square) in squares.enumerate() {
                for (i, part) in square[..SIDE * SIDE].chunks(SIDE).enumerate() {
                    waves[i * padded(harmonics) + k * SIDE..][..SIDE].copy_from_slice(part);
                }
            }
            for (i, to) in to.into_iter().enumerate() {
                lines.inverse(&waves[i * padded(harmonics)..][..lines.harmonics()], row);
                write(SIDE * group + i, row, to);
            }
        })
    }

    /// Set the squares of a group of columns: transformed, each wave times its factor, and back.
    fn filter_columns<'s>(
        &self,
        group: usize,
        from: impl Iterator<Item = &'s [Complex32]>,
        factors: &[Complex32],
        to: &mut [Complex32],
        columns: &mut [Complex32],
        scratch: &mut [Complex32],
    ) {
        let (stride, harmonics) = (padded(self.rows), self.lines.harmonics());
        let share = 1.0 / self.rows as f32;
        for (row, square) in from.enumerate() {
            for (k, column) in columns.chunks_mut(stride).enumerate() {
                for (i, wave) in column[row * SIDE..][..SIDE].iter_mut().enumerate() {
                    *wave = square[i * SIDE + k];
                }
            }
        }
        for column in columns.chunks_mut(stride) {
            self.forward.process_with_scratch(&mut column[..self.rows], scratch);
        }
        let mut square = [Complex32::default(); SIDE * SIDE];
        let rows = factors.chunks(harmonics).map(|row| &row[SIDE * group..]);
        for (first, rows) in rows.collect::<Vec<_>>().chunks(SIDE).enumerate() {
            for (to, row) in square.chunks_mut(SIDE).zip(rows) {
                let count = row.len().min(SIDE);
                to[..count].copy_from_slice(&row[..count]);
            }
            for (k, column) in columns.chunks_mut(stride).enumerate() {
                for (i, wave) in column[first * SIDE..][..SIDE].iter_mut().enumerate() {
                    *wave = *wave * square[i * SIDE + k] * share;
                }
            }
        }
        for column in columns.chunks_mut(stride) {
            self.inverse.process_with_scratch(&mut column[..self.rows], scratch);
        }
        for (row, square) in to.chunks_mut(SIDE * SIDE).enumerate() {
            for (k, column) in columns.chunks(stride).enumerate() {
                for (i, wave) in column[row * SIDE..][..SIDE].iter().enumerate() {
                    square[i * SIDE + k] = *wave;
                }
            }
        }
    }

    fn scratch(&self) -> Vec<Complex32> {
        let forward = self.forward.get_inplace_scratch_len();
        vec![Complex32::default(); forward.max(self.inverse.get_inplace_scratch_len())]
    }

    fn row_groups(&self) -> usize {
        self.rows.div_ceil(SIDE)
    }

    fn column_groups(&self) -> usize {
        self.lines.harmonics().div_ceil(SIDE)
    }
}

/// Waves from one row to the next that do not fall on the same lines of a cache, for at least `waves`.
fn padded(waves: usize) -> usize {
    waves.next_multiple_of(CACHE_PERIOD) + SHIFT
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::*;
    use crate::tests::fixture::{noise, serial};

    /// Each wave times exp(-i q s): the map moved by s, round its period.
    #[test]
    fn a_map_is_moved_by_its_phases() {
        for (rows, columns) in [(5, 6), (40, 34)] {
            let filter = MapFilter::new(rows, columns);
            let values: Vec<f32> = (0..rows * columns).map(|i| noise(i) as f32).collect();
            let phase = |i: usize, k: usize| {
                let turns = i as f32 / rows as f32 + 2.0 * k as f32 / columns as f32;
                Complex32::from_polar(1.0, -TAU * turns)
            };
            let harmonics = columns / 2 + 1;
            let factors: Vec<_> =
                (0..rows * harmonics).map(|at| phase(at / harmonics, at % harmonics)).collect();
            let mut memory = vec![Complex32::default(); filter.memory()];
            let mut moved = vec![0.0; values.len()];
            let read = |i: usize, buffers: &mut RowBuffers| {
                buffers.row.copy_from_slice(&values[i * columns..][..columns]);
            };
            let write = |_: usize, row: &[f32], to: &mut [f32]| to.copy_from_slice(row);
            let out = moved.chunks_mut(columns).collect();
            assert!(filter.apply(&serial(), &factors, &mut memory, read, out, write).is_ok());
            for (at, value) in moved.iter().enumerate() {
                let (i, j) = (at / columns + rows - 1, at % columns + columns - 2);
                let expected = values[i % rows * columns + j % columns];
                assert!((value - expected).abs() < 1e-5, "{at}: {value} {expected}");
            }
        }
    }
}
