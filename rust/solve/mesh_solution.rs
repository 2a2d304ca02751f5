//! What was found on one mesh of a sequence.

use super::newton::Report;
use crate::contact::State;
use crate::fem::mesh::Mesh;
use crate::outcome::Outcome;
use crate::status::Status;

#[derive(Debug, Clone)]
pub struct MeshSolution {
    pub mesh: Mesh,
    pub state: State,
    pub report: Report,
    /// Pressure that was reached over the pressure asked for.
    pub load_reached: f64,
    pub outcome: Outcome,
    /// The coarser mesh that tells the errors, if there is one, with what was found on it.
    pub judged_by: Option<(Mesh, State)>,
    /// Estimated discretisation errors, NaN where there is no mesh to judge from.
    pub contact_fraction_error: f64,
    pub friction_error: f64,
    /// Largest difference of the two frictions that is allowed; none at rest.
    pub friction_bound: Option<f64>,
}

impl MeshSolution {
    /// What is left if there was no time for a finer mesh.
    pub fn out_of_time(&self) -> Self {
        let mut left = self.clone();
        left.report.status = Status::TimeLimit;
        left
    }

    /// What was found on this very mesh, if anything was.
    pub fn found_on(&self, mesh: &Mesh) -> Option<&State> {
        let coarser = self.judged_by.iter().map(|(mesh, state)| (mesh, state));
        let mut all = std::iter::once((&self.mesh, &self.state)).chain(coarser);
        all.find(|(own, _)| own.same(mesh)).map(|(_, state)| state)
    }

    pub fn converged(&self) -> bool {
        self.report.status == Status::Converged
    }
}
