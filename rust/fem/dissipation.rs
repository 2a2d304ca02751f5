//! The energy lost in the block per sliding distance.

use super::block::{Block, Memory, RowState};
use super::circular::correlate;
use crate::material::kinematics::{isochoric, remembered, Gradient, Symmetric, UNIT};
use crate::status::Status;
use crate::watch::Watch;

impl Block<'_> {
    /// Energy lost in each element row per sliding distance in steady sliding; what is at rest loses
    /// none. Rows exchange energy: one alone may be below zero, all together cannot.
    pub fn dissipation(&self, rows: &[RowState], watch: &Watch<'_>) -> Result<Vec<f64>, Status> {
        let Memory::Sliding(history) = self.memory else {
            return Ok(vec![0.0; rows.len()]);
        };
        let parts = self.strain_since(rows, watch)?;
        let curve = history.dissipation.curve(&total(&parts));
        let lost = parts
            .iter()
            .map(|part| history.dissipation.lost_on(&curve, part));
        Ok(lost.collect())
    }

    /// Integral of Y(x - m columns) : Cbar(x) - 3 over each element row, for every number m of
    /// columns; nowhere below zero in the sum over the rows.
    ///
    /// As sum y(x - m) : c(x) - y(x) : c(x) with y = Y - I and c = Cbar - I, which leaves the
    /// squares of small strains their digits.
    pub fn strain_since(
        &self,
        rows: &[RowState],
        watch: &Watch<'_>,
    ) -> Result<Vec<Vec<f64>>, Status> {
        let mut parts = vec![vec![0.0; self.mesh.columns]; rows.len()];
        for (row, (state, product)) in rows.iter().zip(&mut parts).enumerate() {
            watch.look()?;
            for (line, gradient) in state.gradient.iter().enumerate() {
                self.add_products(row, line, gradient, product);
            }
            let own = product[0];
            product.iter_mut().for_each(|product| *product -= own);
        }
        for (m, whole) in total(&parts).into_iter().enumerate() {
            // Below zero is round-off; NaN must stay.
            if whole < 0.0 {
                parts.iter_mut().for_each(|part| part[m] = 0.0);
            }
        }
        Ok(parts)
    }

    /// Add the integral of y(x - m columns) : c(x) along one line.
    fn add_products(&self, row: usize, line: usize, gradient: &[Gradient], product: &mut [f64]) {
        let points = self.points();
        let less_unit = |tensor: Symmetric, k: usize| tensor[k] - UNIT[k];
        for point in 0..points {
            let weight = self.mesh.elements[row].weight[line * points + point];
            let column = gradient.iter().skip(point).step_by(points);
            for (k, times) in [1.0, 1.0, 2.0, 1.0].into_iter().enumerate() {
                let column = column.clone();
                let (y, c): (Vec<f64>, Vec<f64>) = column
                    .map(|f| (less_unit(remembered(f), k), less_unit(isochoric(f), k)))
                    .unzip();
                correlate(times * weight, &y, &c, product);
            }
        }
    }
}

/// The sum over the rows, for every number of columns.
pub fn total(parts: &[Vec<f64>]) -> Vec<f64> {
    let columns = parts.first().map_or(0, Vec::len);
    let whole = |m: usize| parts.iter().map(|part| part[m]).sum();
    (0..columns).map(whole).collect()
}
