//! What a state leaves out of balance: forces, those of the contact among them, volumes and gaps.

use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::linear::norm;
use crate::status::Status;

pub struct Balance {
    /// Of all layers, the fixed lid's included.
    pub forces: Vec<f64>,
    /// `[row][mode][column]`.
    pub volumes: Vec<f64>,
    /// Deformed abscissae of the surface nodes, slope of the profile there, and the gap.
    pub x: Vec<f64>,
    pub slope: Vec<f64>,
    pub gap: Vec<f64>,
}

impl Balance {
    /// Of `state`, whose rows are in the states `rows`.
    pub fn new(
        pressed: &PressedBlock<'_>,
        state: &State,
        rows: &[RowState],
    ) -> Result<Self, Status> {
        let (mesh, block, field) = (pressed.mesh(), &pressed.block, &state.field);
        let mut forces = vec![0.0; field.u.len()];
        let mut volumes = Vec::with_capacity(field.pressure.len());
        let of_row = |row: usize| {
            let forces = block.row_forces(row, field, &rows[row]);
            (forces, block.row_volumes(row, field, &rows[row]))
        };
        let of_rows = pressed.watch.map(16 * mesh.points(), mesh.rows, of_row)?;
        for (row, (local, volume)) in of_rows.into_iter().enumerate() {
            let offset = row * mesh.order * mesh.layer_size();
            for (total, force) in forces[offset..].iter_mut().zip(local) {
                *total += force;
            }
            volumes.extend(volume);
        }
        let x = pressed.abscissae(field);
        let slope: Vec<f64> = x.iter().map(|&x| pressed.heights.slope(x)).collect();
        for (a, force) in state.force.iter().enumerate() {
            forces[mesh.place(a, 0)] += slope[a] * force;
            forces[mesh.place(a, 1)] -= force;
        }
        Ok(Self {
            forces,
            volumes,
            gap: pressed.gaps(state, &x),
            x,
            slope,
        })
    }

    /// Forces relative to the load, those that pull among them, gaps relative to half the range: the
    /// largest.
    pub fn residual(&self, pressed: &PressedBlock<'_>, state: &State, load: f64) -> f64 {
        let unbalanced = norm(self.free_forces(pressed)) / load;
        let total = (state.force.iter().sum::<f64>() / load - 1.0).abs();
        let wrong = |(gap, active): (&f64, &bool)| if *active { gap.abs() } else { -gap };
        let wrong = self.gap.iter().zip(&state.active).map(wrong);
        let overlap = wrong.fold(0.0, f64::max) / pressed.heights.half_range();
        let pull = state.force.iter().fold(0.0_f64, |most, f| most.max(-f)) / load;
        // f64::max would drop a NaN.
        let all = [unbalanced, total, pull, norm(&self.volumes), overlap];
        if all.iter().any(|v| v.is_nan()) {
            return f64::NAN;
        }
        all.into_iter().fold(0.0, f64::max)
    }

    /// What a Newton step is to undo: forces, the lid's left out, then volumes.
    pub fn to_undo(&self, pressed: &PressedBlock<'_>) -> Vec<f64> {
        let forces = self.free_forces(pressed).iter();
        forces.chain(&self.volumes).map(|value| -value).collect()
    }

    /// Contact force times curvature of the profile, at every node.
    pub fn bend(&self, pressed: &PressedBlock<'_>, state: &State) -> Vec<f64> {
        let nodes = self.x.iter().zip(&state.force);
        nodes
            .map(|(&x, force)| force * pressed.heights.curvature(x))
            .collect()
    }

    fn free_forces(&self, pressed: &PressedBlock<'_>) -> &[f64] {
        &self.forces[..self.forces.len() - pressed.mesh().layer_size()]
    }
}
