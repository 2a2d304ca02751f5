//! The residual of a state: forces out of balance, those of the contact included, volumes and gaps.

use crate::contact::sampling::{Band, SampledProfile};
use crate::contact::{PressedBlock, State};
use crate::fem::block::RowState;
use crate::linear::norm;
use crate::status::Status;

pub struct Residual {
    /// Forces on all layers, including the fixed lid.
    pub forces: Vec<f64>,
    /// `[row][mode][column]`.
    pub volumes: Vec<f64>,
    /// The profile under the surface nodes, and their gaps.
    pub profile: SampledProfile,
    pub gap: Vec<f64>,
}

impl Residual {
    /// The residual of `state`, whose rows are in the states `rows`.
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
        let of_rows = pressed.executor.map(16 * mesh.points(), mesh.rows, of_row)?;
        for (row, (row_forces, row_volumes)) in of_rows.into_iter().enumerate() {
            let offset = row * mesh.order * mesh.layer_size();
            for (total, force) in forces[offset..].iter_mut().zip(row_forces) {
                *total += force;
            }
            volumes.extend(row_volumes);
        }
        let profile = pressed.sampled(field);
        let along = profile.slope.transposed(&state.force);
        for (a, (along, force)) in along.iter().zip(&state.force).enumerate() {
            forces[mesh.position(a, 0)] += along;
            forces[mesh.position(a, 1)] -= force;
        }
        Ok(Self { forces, volumes, gap: pressed.gaps(state, &profile), profile })
    }

    /// The largest of: residual forces, missing load and tensile contact forces over the load; residual
    /// volumes; wrong gaps over half the range of heights.
    pub fn norm(&self, pressed: &PressedBlock<'_>, state: &State, load: f64) -> f64 {
        let forces = norm(self.free_forces(pressed)) / load;
        let missing = (state.force.iter().sum::<f64>() / load - 1.0).abs();
        let tension = state.force.iter().fold(0.0_f64, |most, f| most.max(-f)) / load;
        let wrong = |(gap, active): (&f64, &bool)| if *active { gap.abs() } else { -gap };
        let wrong = self.gap.iter().zip(&state.active_set).map(wrong);
        let gaps = wrong.fold(0.0, f64::max) / pressed.heights.half_range();
        // f64::max would drop a NaN.
        let parts = [forces, missing, tension, norm(&self.volumes), gaps];
        if parts.iter().any(|v| v.is_nan()) {
            return f64::NAN;
        }
        parts.into_iter().fold(0.0, f64::max)
    }

    /// The right-hand side of a Newton step: minus the free forces, then minus the volumes.
    pub fn right_hand_side(&self, pressed: &PressedBlock<'_>) -> Vec<f64> {
        let forces = self.free_forces(pressed).iter();
        forces.chain(&self.volumes).map(|value| -value).collect()
    }

    /// The stiffness of contact forces that turn with the profile.
    pub fn turning_stiffness(&self, pressed: &PressedBlock<'_>, state: &State) -> Band {
        self.profile.turning_stiffness(pressed.heights, &state.force)
    }

    fn free_forces(&self, pressed: &PressedBlock<'_>) -> &[f64] {
        &self.forces[..self.forces.len() - pressed.mesh().layer_size()]
    }
}
