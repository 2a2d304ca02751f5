//! The dense part of the tangent of steady sliding: all points of a line remember one another.
//!
//! M = sum over lines and pairs of points (q, q') of L_q weight(q - q') R_q', with L = dR_u/dH at q
//! and R = dY/du at q'. Cost per element row of order 1 with n columns: 1024 n^2 flops for the
//! product and a quarter of that for spreading.

use super::block::Block;
use crate::linear::{self, Matrix};
use crate::material::kinematics::{remembered_slope, Gradient};
use crate::material::sliding_history::SlidingHistory;
use crate::material::stress::memory_slope;
use crate::status::Status;
use crate::watch::Watch;

impl Block<'_> {
    /// Memory tangent of one row: sum of L_q weight(q - q') R_q' over all pairs of points of a line.
    ///
    /// For every source column the forces on all rows per unit of its remembered components are
    /// spread along the lines (long vectors), then multiplied by what its unknowns remember.
    pub(super) fn add_memory(
        &self,
        row: usize,
        history: &SlidingHistory,
        gradient: &[Vec<Gradient>],
        matrix: &mut Matrix<f64>,
        watch: &Watch<'_>,
    ) -> Result<(), Status> {
        let (columns, points) = (self.mesh.columns, self.points());
        let count = 2 * self.mesh.elements[row].nodes();
        let streams = 4 * points * points;
        let left = self.left_factors(row, gradient);
        let mut spread = Matrix::<f64>::zeros(points * self.mesh.layer_size(), streams);
        let mut right = Matrix::<f64>::zeros(streams, count);
        let mut product = Matrix::<f64>::zeros(points * self.mesh.layer_size(), count);
        let unknowns: Vec<Vec<usize>> = (0..columns).map(|c| self.local_unknowns(c)).collect();
        // The weights twice over, so that any shift of them is a contiguous slice.
        let weights = history.stress.repeat(2);
        let pulp = pulp::Arch::new();
        for source in 0..columns {
            watch.look()?;
            pulp.dispatch(|| self.spread(source, count, &left, &weights, &mut spread));
            self.right_factors(row, source, gradient, &mut right);
            linear::product(&mut product, &spread, &right);
            pulp.dispatch(|| {
                for (j, &unknown) in unknowns[source].iter().enumerate() {
                    let target = linear::column_mut(matrix, unknown);
                    for (t, p) in target.iter_mut().zip(linear::column_ref(&product, j)) {
                        *t += p;
                    }
                }
            });
        }
        Ok(())
    }

    /// Forces on the unknowns of a row per unit of each remembered component at `source`.
    #[inline(always)]
    fn spread(
        &self,
        source: usize,
        count: usize,
        left: &[f64],
        weights: &[f64],
        spread: &mut Matrix<f64>,
    ) {
        let (columns, points) = (self.mesh.columns, self.points());
        let weight = &weights[columns - source..2 * columns - source];
        for stream in 0..4 * points * points {
            let target = linear::column_mut(spread, stream);
            target.fill(0.0);
            for slot in 0..count {
                let factor = &left[(stream * count + slot) * columns..][..columns];
                let (start, wraps) = self.slot(slot);
                let target = &mut target[start..start + columns];
                if wraps {
                    for e in 0..columns - 1 {
                        target[e + 1] += weight[e] * factor[e];
                    }
                    target[0] += weight[columns - 1] * factor[columns - 1];
                } else {
                    for e in 0..columns {
                        target[e] += weight[e] * factor[e];
                    }
                }
            }
        }
    }

    /// Where local unknown `slot` of column 0 stands in a row, and whether it is the next column's.
    fn slot(&self, slot: usize) -> (usize, bool) {
        let order = self.mesh.order;
        let (node, direction) = (slot / 2, slot % 2);
        let (layer, sub) = (node / (order + 1), node % (order + 1));
        let within = if sub == order { 0 } else { sub };
        let start = layer * self.mesh.layer_size() + self.mesh.place(within, direction);
        (start, sub == order)
    }

    /// Residual per unit H component: `[line][point][component][unknown][column]`.
    fn left_factors(&self, row: usize, gradient: &[Vec<Gradient>]) -> Vec<f64> {
        let element = &self.mesh.elements[row];
        let (columns, points) = (self.mesh.columns, self.points());
        let count = 2 * element.nodes();
        let mut out = vec![0.0; points * points * 4 * count * columns];
        for (line, gradients) in gradient.iter().enumerate() {
            for (q, f) in gradients.iter().enumerate() {
                let (column, point) = (q / points, q % points);
                let at = line * points + point;
                let slope = memory_slope(f);
                for k in 0..4 {
                    for (node, s) in element.gradient[at].iter().enumerate() {
                        for i in 0..2 {
                            let force = slope[2 * i][k] * s[0] + slope[2 * i + 1][k] * s[1];
                            let index = (at * 4 + k) * count + 2 * node + i;
                            out[index * columns + column] = element.weight[at] * force;
                        }
                    }
                }
            }
        }
        out
    }

    /// Y components per unit displacement of the unknowns of one column.
    fn right_factors(
        &self,
        row: usize,
        column: usize,
        gradient: &[Vec<Gradient>],
        right: &mut Matrix<f64>,
    ) {
        let element = &self.mesh.elements[row];
        let points = self.points();
        for (line, gradients) in gradient.iter().enumerate() {
            for point in 0..points {
                let at = line * points + point;
                let slope = remembered_slope(&gradients[column * points + point]);
                for (node, s) in element.gradient[at].iter().enumerate() {
                    for i in 0..2 {
                        for (k, d) in slope.iter().enumerate() {
                            right[(at * 4 + k, 2 * node + i)] =
                                d[2 * i] * s[0] + d[2 * i + 1] * s[1];
                        }
                    }
                }
            }
        }
    }
}
