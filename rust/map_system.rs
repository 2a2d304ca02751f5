//! The linear system of the points of a map in contact, as that of a line in `line_system`.

use crate::executor::Executor;
use crate::gap_extension::MapExtension;
use crate::line_system::without_mean;
use crate::linear::single_gmres::{gmres, Approximation};
use crate::map_filter::{MapFilter, RowBuffers};
use crate::spectral::Complex32;
use crate::status::Status;

/// The operator Q K on some points of a map.
pub struct MapSystem<'a> {
    pub filter: &'a MapFilter,
    /// Places of the points on the map, row after row, rising.
    pub places: &'a [i64],
    /// K and S of each wave.
    pub compliance: &'a [Complex32],
    pub stiffness: &'a [Complex32],
    /// E.
    pub extension: &'a MapExtension,
    /// Factor on Q r.
    pub factor: f32,
}

impl MapSystem<'_> {
    /// Whether all places are of the map and rise, for a system of so many points.
    pub fn fits(&self, points: usize) -> bool {
        let all = (self.filter.rows() * self.filter.columns()) as i64;
        let within = self.places.first().is_none_or(|&at| at >= 0)
            && self.places.last().is_none_or(|&at| at < all);
        points == self.places.len()
            && within
            && self.places.is_sorted()
            && self.extension.shape() == (self.filter.rows(), self.filter.columns())
    }

    /// The pressures whose Q K is `right`, of unit length; see `gmres`.
    pub fn solution(
        &self,
        executor: &Executor<'_>,
        right: Vec<f32>,
        target: f64,
        most: usize,
        memory: &mut [Complex32],
    ) -> Result<Approximation, Status> {
        let rows = self.filter.rows();
        let starts = self.starts();
        let row = |values: &'_ [f32], i: usize, to: &mut [f32]| {
            let points = starts[i]..starts[i + 1];
            let first = (i * self.filter.columns()) as i64;
            to.fill(0.0);
            for (&place, &value) in self.places[points.clone()].iter().zip(&values[points]) {
                to[(place - first) as usize] = value;
            }
        };
        let at_points = |i: usize, row: &[f32], to: &mut [f32]| {
            let first = (i * self.filter.columns()) as i64;
            for (&place, to) in self.places[starts[i]..].iter().zip(to) {
                *to = row[(place - first) as usize];
            }
        };
        let apply = |pressure: &[f32]| {
            let mut gap = vec![0.0; pressure.len()];
            let of_pressure = |i: usize, b: &mut RowBuffers| row(pressure, i, &mut b.row);
            let out = by_row(&mut gap, &starts);
            self.filter.apply(executor, self.compliance, memory, of_pressure, out, at_points)?;
            let gap = without_mean(gap);
            let mut missing = vec![0.0; gap.len()];
            let of_gap = |i: usize, b: &mut RowBuffers| {
                row(&gap, (i + rows - 1) % rows, &mut b.above);
                row(&gap, (i + 1) % rows, &mut b.below);
                row(&gap, i, &mut b.row);
                self.extension.extend_row(i, &b.above, &mut b.row, &b.below);
            };
            let out = by_row(&mut missing, &starts);
            self.filter.apply(executor, self.stiffness, memory, of_gap, out, at_points)?;
            let mut missing = without_mean(missing);
            missing.iter_mut().for_each(|value| *value *= self.factor);
            Ok(missing)
        };
        gmres(apply, right, target, most)
    }

    /// Where the points of each row begin, and the end of the last.
    fn starts(&self) -> Vec<usize> {
        let columns = self.filter.columns();
        let before = |i| self.places.partition_point(|&at| at < (i * columns) as i64);
        (0..=self.filter.rows()).map(before).collect()
    }
}

/// Values at the points, cut into those of each row.
fn by_row<'v>(mut values: &'v mut [f32], starts: &[usize]) -> Vec<&'v mut [f32]> {
    let mut rows = Vec::with_capacity(starts.len());
    for ends in starts.windows(2) {
        let (row, rest) = values.split_at_mut(ends[1] - ends[0]);
        rows.push(row);
        values = rest;
    }
    rows
}
