//! The energy lost in the block per sliding distance.

use super::block::{Block, Memory, RowState};
use crate::executor::Executor;
use crate::material::kinematics::{isochoric, remembered, Symmetric, UNIT};
use crate::spectral::Correlations;
use crate::status::Status;

/// Integral of Y(x - m columns) : Cbar(x) - 3, for every number m of columns.
pub struct StrainSince {
    /// Over the block, nowhere below zero.
    pub whole: Vec<f64>,
    /// Over each element row.
    pub rows: Vec<Vec<f64>>,
}

/// Energy lost per sliding distance.
pub struct Loss {
    pub whole: f64,
    /// Energy lost in each element row. Rows exchange energy, so that a single row may be below zero, but not
    /// their sum.
    pub rows: Vec<f64>,
}

impl Block<'_> {
    /// Energy lost in steady sliding; zero at rest.
    pub fn dissipation(&self, rows: &[RowState], executor: &Executor<'_>) -> Result<Loss, Status> {
        let Memory::Sliding(history) = self.memory else {
            let rows = vec![0.0; rows.len()];
            return Ok(Loss { whole: 0.0, rows });
        };
        let since = self.strain_since(rows, executor)?;
        let curve = history.dissipation.curve(&since.whole);
        let lost = |part: &Vec<f64>| history.dissipation.lost_on(&curve, part);
        Ok(Loss { whole: lost(&since.whole), rows: since.rows.iter().map(lost).collect() })
    }

    /// The sums of y(x - m) : c(x) - y(x) : c(x) with y = Y - I and c = Cbar - I, which keep the digits of
    /// the squares of small strains.
    pub fn strain_since(
        &self,
        rows: &[RowState],
        executor: &Executor<'_>,
    ) -> Result<StrainSince, Status> {
        let mut whole = vec![0.0; self.mesh.columns];
        let correlations = Correlations::new(self.mesh.columns);
        let of_row = |row: usize| {
            let mut correlations = correlations.clone();
            self.add_pairs(row, &rows[row], &mut correlations);
            correlations.take()
        };
        let mut parts = executor.map(100 * self.mesh.points(), rows.len(), of_row)?;
        for part in &mut parts {
            whole.iter_mut().zip(part.iter()).for_each(|(sum, product)| *sum += product);
            let undelayed = part[0];
            part.iter_mut().for_each(|product| *product -= undelayed);
        }
        let undelayed = whole[0];
        for (m, product) in whole.iter_mut().enumerate() {
            // A negative difference is round-off; NaN must stay.
            if *product < undelayed {
                parts.iter_mut().for_each(|part| part[m] = 0.0);
                *product = 0.0;
            } else {
                *product -= undelayed;
            }
        }
        let rows = parts;
        Ok(StrainSince { whole, rows })
    }

    /// Add every pair of lines of y and c in a row.
    fn add_pairs(&self, row: usize, state: &RowState, correlations: &mut Correlations) {
        let points = self.points();
        let less_unit = |tensor: Symmetric, k: usize| tensor[k] - UNIT[k];
        for (line, along) in state.deformation.iter().enumerate() {
            for point in 0..points {
                let weight = self.mesh.elements[row].weight[line * points + point];
                let column = along.iter().skip(point).step_by(points);
                for (k, times) in [1.0, 1.0, 2.0, 1.0].into_iter().enumerate() {
                    let column = column.clone();
                    let (y, c): (Vec<f64>, Vec<f64>) = column
                        .map(|f| (less_unit(remembered(f), k), less_unit(isochoric(f), k)))
                        .unzip();
                    correlations.add(times * weight, &y, &c);
                }
            }
        }
    }
}
