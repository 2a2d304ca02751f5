//! A sequence of meshes, each twice as fine as the one before, the last two telling the error.
//!
//! The coarsest mesh has the load raised step by step, every finer one starts from its predecessor's
//! solution; with a tolerance the sequence goes on until two agree well enough.

use super::newton::Report;
use crate::contact::State;
use crate::error::KernelError;
use crate::fem::mesh::{Mesh, MeshSize};
use crate::outcome::Outcome;
use crate::settings::Settings;
use crate::status::Status;

/// What was found on one mesh.
#[derive(Debug, Clone)]
pub struct MeshSolution {
    pub mesh: Mesh,
    pub state: State,
    pub report: Report,
    /// Pressure that was reached over the pressure asked for.
    pub load_reached: f64,
    pub outcome: Outcome,
    /// Estimated discretisation errors, NaN where there is only one mesh to judge from.
    pub contact_fraction_error: f64,
    pub friction_error: f64,
}

/// Meshes, coarsest first.
pub struct MeshSequence(pub Vec<MeshSize>);

impl MeshSequence {
    /// Up to the mesh asked for, or with a tolerance beyond it; less of it is needed where a
    /// solution on `start_columns` is there to start from. No mesh has less than half of the
    /// `fewest_nodes` that resolve the profile: it would find contacts that are not there, and
    /// finer meshes may keep them.
    pub fn new(
        finest: &MeshSize,
        tolerance: Option<f64>,
        start_columns: Option<usize>,
        fewest_nodes: usize,
        settings: &Settings,
    ) -> Self {
        let coarsest = settings.coarsest_nodes.max(fewest_nodes / 2);
        let mut columns = vec![finest.columns];
        while columns[0] % 4 == 0 && finest.order * columns[0] / 2 >= coarsest {
            columns.insert(0, columns[0] / 2);
        }
        if tolerance.is_some() {
            while columns[columns.len() - 1] * 2 <= settings.finest_columns {
                columns.push(columns[columns.len() - 1] * 2);
            }
            // A neighbour that met its tolerance tells which meshes are worth a look.
            let most = columns[columns.len() - 1];
            let least = most.min(start_columns.unwrap_or(0) / 2);
            columns.retain(|&count| count >= least);
        } else if start_columns.is_some() {
            columns.drain(..columns.len().saturating_sub(2));
        }
        let size = |count| finest.with_columns(count, settings.row_exponent);
        Self(columns.into_iter().map(size).collect())
    }

    /// Solve on one mesh after the other by `on_mesh(mesh, coarser solution)`.
    pub fn solve(
        &self,
        tolerance: Option<f64>,
        settings: &Settings,
        mut on_mesh: impl FnMut(Mesh, Option<&MeshSolution>) -> MeshSolution,
    ) -> Result<MeshSolution, KernelError> {
        let mut last: Option<MeshSolution> = None;
        let mut met = false;
        for size in &self.0 {
            let coarse = last.filter(MeshSolution::converged);
            let mut fine = on_mesh(Mesh::new(size), coarse.as_ref());
            fine.estimate_errors(coarse.as_ref(), settings);
            met = tolerance.is_none_or(|tolerance| fine.meets(tolerance, settings));
            let done = tolerance.is_some() && met && fine.converged();
            last = Some(fine);
            if done {
                break;
            }
        }
        let mut finest = last.ok_or(KernelError::Internal("a sequence without a mesh"))?;
        if finest.converged() && !met {
            finest.report.status = Status::ToleranceNotMet;
        }
        Ok(finest)
    }
}

impl MeshSolution {
    fn converged(&self) -> bool {
        self.report.status == Status::Converged
    }

    /// Errors from the change since the mesh of half the resolution, never below what the contact
    /// edges and the two friction measures leave open.
    fn estimate_errors(&mut self, coarse: Option<&Self>, settings: &Settings) {
        let Some(coarse) = coarse else {
            return;
        };
        let (fine, rough) = (&self.outcome, &coarse.outcome);
        let full = fine.contact_fraction == 1.0 && rough.contact_fraction == 1.0;
        let edges = if full {
            0.0
        } else {
            settings.edge_error * self.mesh.node_spacing()
        };
        let fraction = (fine.contact_fraction - rough.contact_fraction).abs();
        let change = (fine.friction - rough.friction).abs();
        let mismatch = (fine.friction - fine.friction_from_dissipation).abs();
        self.contact_fraction_error = settings.error_safety * fraction.max(edges);
        self.friction_error = change.max(mismatch);
    }

    fn meets(&self, tolerance: f64, settings: &Settings) -> bool {
        let friction = self.outcome.friction.abs();
        // At rest friction is nothing but round-off.
        let friction_met =
            self.friction_error <= tolerance * friction || friction < settings.friction_noise;
        friction_met && self.contact_fraction_error <= tolerance
    }
}
