//! The block pressed on its rigid profile: gaps, and the frictionless unilateral contact.

pub mod complementarity;
pub mod edges;
pub mod harmonics;
pub mod held;
pub mod hertz;
pub mod pivoting;
pub mod profile;
pub mod surface;
pub mod touching;

use crate::fem::block::{Block, Field, RowState};
use crate::fem::mesh::Mesh;
use crate::status::Status;
use crate::watch::Watch;
use profile::Heights;

/// Everything that changes while solving.
#[derive(Debug, Clone)]
pub struct State {
    pub field: Field,
    /// Vertical contact force of every surface node.
    pub force: Vec<f64>,
    pub active: Vec<bool>,
    /// How far the profile is pushed up into the block.
    pub approach: f64,
}

impl State {
    pub fn at_rest(mesh: &Mesh) -> Self {
        Self {
            field: Field::at_rest(mesh),
            force: vec![0.0; mesh.layer_nodes()],
            active: vec![false; mesh.layer_nodes()],
            approach: 0.0,
        }
    }

    /// The same with its stresses in another unit, `stress` of which are one of this.
    pub fn restressed(&self, stress: f64) -> Self {
        let mut out = self.clone();
        for value in out.field.pressure.iter_mut().chain(&mut out.force) {
            *value *= stress;
        }
        out
    }
}

/// The block on its profile.
pub struct PressedBlock<'a> {
    pub block: Block<'a>,
    pub heights: &'a Heights,
    /// Whether to go on.
    pub watch: &'a Watch<'a>,
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
            .map(|a| a as f64 * mesh.node_spacing() + field.u[mesh.place(a, 0)] - shift)
            .collect()
    }

    /// Gaps of the surface nodes at the abscissae `x`.
    pub fn gaps(&self, state: &State, x: &[f64]) -> Vec<f64> {
        let height = |a: usize| state.field.u[self.mesh().place(a, 1)] - state.approach;
        (0..x.len())
            .map(|a| height(a) - self.heights.height(x[a]))
            .collect()
    }

    pub fn row_states(&self, field: &Field) -> Result<Vec<RowState>, Status> {
        let (block, mesh) = (&self.block, self.mesh());
        let state = |row| block.row_state(row, &field.u);
        self.watch.map(32 * mesh.points(), mesh.rows, state)
    }
}
