//! The block pressed on its rigid profile: gaps, and frictionless unilateral contact.

pub mod active_set_system;
pub mod complementarity_problem;
pub mod edges;
pub mod harmonics;
pub mod linear_complementarity;
mod pivoting;
pub mod profile;
pub mod sampling;
pub mod surface_compliance;
#[cfg(test)]
mod tests;

use crate::executor::Executor;
use crate::fem::block::{Block, Field, RowState};
use crate::fem::mesh::Mesh;
use crate::status::Status;
use profile::Heights;
use sampling::{SampledProfile, Sampling};

/// The unknowns of the block in contact.
#[derive(Debug, Clone)]
pub struct State {
    pub field: Field,
    /// Vertical contact force of every surface node.
    pub force: Vec<f64>,
    /// Surface nodes in contact.
    pub active_set: Vec<bool>,
    /// How far the profile is pushed up into the block.
    pub approach: f64,
}

impl State {
    pub fn at_rest(mesh: &Mesh) -> Self {
        Self {
            field: Field::at_rest(mesh),
            force: vec![0.0; mesh.layer_nodes()],
            active_set: vec![false; mesh.layer_nodes()],
            approach: 0.0,
        }
    }

    /// The same state with stresses in another unit; `ratio` is this state's unit over the new one.
    pub fn in_stress_unit(&self, ratio: f64) -> Self {
        let mut out = self.clone();
        for value in out.field.pressure.iter_mut().chain(&mut out.force) {
            *value *= ratio;
        }
        out
    }
}

/// The block on its profile, and the executor of all work on it.
pub struct PressedBlock<'a> {
    pub block: Block<'a>,
    pub heights: &'a Heights,
    pub sampling: Sampling,
    pub executor: &'a Executor<'a>,
}

impl PressedBlock<'_> {
    pub(crate) fn mesh(&self) -> &Mesh {
        self.block.mesh
    }

    /// Deformed abscissae of the surface nodes in the frame of the profile.
    pub fn abscissae(&self, field: &Field) -> Vec<f64> {
        let mesh = self.mesh();
        let shift = mesh.mean_shift(&field.u);
        (0..mesh.layer_nodes())
            .map(|a| a as f64 * mesh.node_spacing() + field.u[mesh.position(a, 0)] - shift)
            .collect()
    }

    /// The profile under the surface nodes.
    pub fn sampled(&self, field: &Field) -> SampledProfile {
        SampledProfile::new(self.heights, self.sampling, self.mesh(), self.abscissae(field))
    }

    /// Gaps of the surface nodes over the `profile` under them.
    pub fn gaps(&self, state: &State, profile: &SampledProfile) -> Vec<f64> {
        let height = |a: usize| state.field.u[self.mesh().position(a, 1)] - state.approach;
        let heights = profile.height.iter().enumerate();
        heights.map(|(a, profile)| height(a) - profile).collect()
    }

    pub fn row_states(&self, field: &Field) -> Result<Vec<RowState>, Status> {
        let (block, mesh) = (&self.block, self.mesh());
        let state = |row| block.row_state(row, &field.u);
        self.executor.map(32 * mesh.points(), mesh.rows, state)
    }
}
