//! A sequence of meshes, each twice as fine as the one before, the last two telling the error.
//! With a tolerance an odd number of columns is halved too, and rounded up.
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
    /// Up to the mesh asked for, or with a tolerance beyond it; less of it is needed where there is
    /// a solution to `start` from. No mesh has less than half of the
    /// `fewest_nodes` that resolve the profile: it would find contacts that are not there, and
    /// finer meshes may keep them.
    pub fn new(
        finest: &MeshSize,
        tolerance: Option<f64>,
        start: Option<&MeshSolution>,
        fewest_nodes: usize,
        settings: &Settings,
    ) -> Self {
        let coarsest = settings.coarsest_nodes.max(fewest_nodes / 2);
        let mut columns = vec![finest.columns];
        // Two meshes tell the error of the finer one: with a tolerance any mesh has a coarser one.
        let halves = |count: usize| tolerance.is_some() || count % 4 == 0;
        while halves(columns[0]) && finest.order * columns[0].div_ceil(2) >= coarsest {
            columns.insert(0, columns[0].div_ceil(2));
        }
        if let Some(tolerance) = tolerance {
            while columns[columns.len() - 1] * 2 <= settings.finest_columns {
                columns.push(columns[columns.len() - 1] * 2);
            }
            let least = start.map_or(0, |start| start.columns_within(tolerance, settings) / 2);
            let last_two = columns.len().saturating_sub(2);
            let coarser = columns.iter().filter(|&&count| count < least).count();
            columns.drain(..coarser.min(last_two));
        } else if start.is_some() {
            columns.drain(..columns.len().saturating_sub(2));
        }
        let size = |count| finest.with_columns(count, settings.row_exponent);
        Self(columns.into_iter().map(size).collect())
    }

    /// Solve on one mesh after the other by `on_mesh(mesh, coarser solution)`, until time is over.
    pub fn solve(
        &self,
        tolerance: Option<f64>,
        settings: &Settings,
        mut on_mesh: impl FnMut(Mesh, Option<&MeshSolution>) -> Result<MeshSolution, KernelError>,
    ) -> Result<MeshSolution, KernelError> {
        let mut last: Option<MeshSolution> = None;
        let mut met = false;
        for size in &self.0 {
            let coarse = last.filter(MeshSolution::converged);
            let mut fine = on_mesh(Mesh::new(size), coarse.as_ref())?;
            if fine.report.status == Status::TimeLimit {
                return Ok(fine);
            }
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
    /// Columns of the coarsest mesh known to meet `tolerance`, by errors that fall to a quarter at
    /// most where columns are doubled; nothing is known from errors that were not estimated.
    fn columns_within(&self, tolerance: f64, settings: &Settings) -> usize {
        if self.friction_error.is_nan() {
            return 0;
        }
        let (mut columns, mut at_half) = (self.mesh.columns, tolerance / 4.0);
        while columns > 1 && self.meets(at_half, settings) {
            (columns, at_half) = (columns / 2, at_half / 4.0);
        }
        columns
    }

    /// What is left if there was no time for a finer mesh.
    pub fn out_of_time(&self) -> Self {
        let mut left = self.clone();
        left.report.status = Status::TimeLimit;
        left
    }

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
