//! The energy lost in the block per sliding distance.

use super::block::{Block, Memory, RowState};
use super::circular::correlate;
use crate::material::kinematics::{isochoric, remembered, Gradient, Symmetric, UNIT};
use crate::status::Status;
use crate::watch::Watch;

impl Block<'_> {
    /// Energy lost per sliding distance in steady sliding; what is at rest loses none.
    pub fn dissipation(&self, rows: &[RowState], watch: &Watch<'_>) -> Result<f64, Status> {
        Ok(match self.memory {
            Memory::Sliding(history) => history.dissipation.lost(&self.strain_since(rows, watch)?),
            Memory::Relaxed | Memory::Given(_) => 0.0,
        })
    }

    /// Integral of Y(x - m columns) : Cbar(x) - 3 over the block, for every number m of columns.
    ///
    /// As sum y(x - m) : c(x) - y(x) : c(x) with y = Y - I and c = Cbar - I, which leaves the
    /// squares of small strains their digits.
    pub fn strain_since(&self, rows: &[RowState], watch: &Watch<'_>) -> Result<Vec<f64>, Status> {
        let mut product = vec![0.0; self.mesh.columns];
        for (row, state) in rows.iter().enumerate() {
            watch.look()?;
            for (line, gradient) in state.gradient.iter().enumerate() {
                self.add_products(row, line, gradient, &mut product);
            }
        }
        let own = product[0];
        // Below zero is round-off; NaN must stay.
        let since = |product: f64| if product < own { 0.0 } else { product - own };
        Ok(product.into_iter().map(since).collect())
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
