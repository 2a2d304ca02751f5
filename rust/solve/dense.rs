//! The linearised problem of a Newton step by dense elimination of the node layers: the compliance of
//! the surface is exact, and so is its contact.

use super::increment::Increment;
use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::linear::Elimination;
use crate::settings::Settings;
use crate::status::Status;

/// A factored block and the state it was factored at. The volume change keeps the slope of that
/// state too: with a bulk modulus of hundreds of shear moduli a mixture of slopes would not converge.
pub struct Factored {
    elimination: Elimination,
    rows: Vec<RowState>,
}

impl Factored {
    pub fn new(
        pressed: &PressedBlock<'_>,
        state: &State,
        rows: &[RowState],
    ) -> Result<Self, Status> {
        let (block, watch) = (&pressed.block, pressed.watch);
        let matrix = |row: usize| block.row_matrix(row, &state.field, &rows[row], watch);
        let uppermost = pressed.mesh().rows - 1;
        let layer = pressed.mesh().layer_size();
        let below = (0..uppermost).rev().map(matrix);
        Ok(Self {
            elimination: Elimination::new(layer, matrix(uppermost)?, below, watch)?,
            rows: rows.to_vec(),
        })
    }

    /// Increment of a step from `state`, whose rows are in the states `rows`, under `load`.
    pub fn increment(
        &self,
        pressed: &PressedBlock<'_>,
        state: &State,
        rows: &[RowState],
        load: f64,
        settings: &Settings,
    ) -> Result<Increment, Status> {
        let (block, watch) = (&pressed.block, pressed.watch);
        let rights: Vec<Vec<f64>> = (0..rows.len())
            .map(|row| block.row_right(row, &state.field, &rows[row], &self.rows[row]))
            .collect();
        let reduced = self.elimination.reduce(&rights, watch)?;
        let right = &reduced.surface_right;
        let (surface, contact) =
            pressed.linearised_contact(state, &self.elimination, right, load, settings)?;
        let mut u = self.elimination.expand(&reduced, &surface, watch)?;
        u.resize(state.field.u.len(), 0.0);
        let mut pressure = Vec::with_capacity(state.field.pressure.len());
        for (row, (now, old)) in rows.iter().zip(&self.rows).enumerate() {
            pressure.extend(block.pressure_increments(row, now, old, &u, &state.field));
        }
        Ok(Increment {
            u,
            pressure,
            contact,
            products: 0,
        })
    }
}
