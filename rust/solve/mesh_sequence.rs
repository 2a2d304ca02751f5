//! A sequence of meshes, each twice as fine as the one before; the last two give the error estimate.
//!
//! On the coarsest mesh the load is raised step by step, every finer mesh starts from the solution on its
//! predecessor. The sequence ends when two solutions agree to the tolerance and the last can be trusted.

use super::error_estimator::ErrorEstimator;
use crate::contact::profile::Heights;
use crate::error::KernelError;
use crate::fem::mesh::{Mesh, MeshSize};
use crate::solution::MeshSolution;
use crate::status::Status;

/// Fewest nodes along the wave on the coarsest mesh of a sequence.
pub const COARSEST_NODES: usize = 32;

/// Nodes of the coarsest mesh from which the error of a finer one can be estimated.
const FEWEST_NODES: usize = 8;

/// Meshes, coarsest first. The first `required` are always solved.
pub struct MeshSequence {
    pub sizes: Vec<MeshSize>,
    pub required: usize,
    /// The mesh of half the first's columns, if the profile is too rough to begin with it: it is solved
    /// after the first, from the first's solution, to estimate the error of the first.
    pub below: Option<MeshSize>,
}

impl MeshSequence {
    /// Up to the mesh of size `finest`, or with a tolerance to any that meets it, and beyond as long as no
    /// solution can be trusted; fewer meshes are needed with a solution to `start` from. Except `finest`,
    /// no mesh is too coarse for the waves of `heights`: it would have contacts that do not exist, and
    /// finer meshes may keep them.
    pub fn new(
        finest: &MeshSize,
        start: Option<&MeshSolution>,
        heights: &Heights,
        estimator: &ErrorEstimator,
    ) -> Self {
        let settings = &estimator.settings;
        let smooth = match heights.waves() {
            1 => 0,
            waves => settings.nodes_per_wave * waves,
        };
        let mut columns = vec![finest.columns];
        let mut halve = |least: usize| {
            let coarser = columns[0].div_ceil(2);
            let enough = coarser < columns[0] && finest.order * coarser >= least.max(smooth);
            if enough {
                columns.insert(0, coarser);
            }
            enough
        };
        // Without a coarser mesh there is no error estimate, so one may be as coarse as necessary.
        if !halve(COARSEST_NODES) {
            halve(FEWEST_NODES);
        }
        while halve(COARSEST_NODES) {}
        let follows = |columns: usize| finest.order * columns >= heights.fewest_nodes() / 2;
        let below = finest.columns.div_ceil(2);
        let below = (smooth > 0 && columns.len() == 1 && follows(below)).then_some(below);
        let mut required = columns.len();
        let most = match estimator.tolerance {
            Some(_) => settings.finest_columns,
            None => settings.rescue_columns.min(settings.finest_columns),
        };
        while columns[columns.len() - 1] * 2 <= most {
            columns.push(columns[columns.len() - 1] * 2);
        }
        let needed = if estimator.tolerance.is_none() {
            start.map_or(0, |_| required.saturating_sub(2))
        } else {
            required = 0;
            let least = start.map_or(0, |start| estimator.columns_within(start) / 2);
            let coarser = columns.iter().filter(|&&count| count < least).count();
            coarser.min(columns.len().saturating_sub(2))
        };
        columns.drain(..needed);
        let size = |count| finest.with_columns(count, settings.row_exponent);
        Self {
            sizes: columns.into_iter().map(size).collect(),
            required: required.saturating_sub(needed),
            below: below.map(size),
        }
    }

    /// Solve on one mesh after the other by `on_mesh(mesh, coarser solution)`; the mesh `below` starts from
    /// the finer solution instead.
    pub fn solve(
        &self,
        estimator: &ErrorEstimator,
        mut on_mesh: impl FnMut(Mesh, Option<&MeshSolution>) -> Result<MeshSolution, KernelError>,
    ) -> Result<MeshSolution, KernelError> {
        let mut last: Option<MeshSolution> = None;
        for (i, size) in self.sizes.iter().enumerate() {
            // Solve, from the solution on the mesh before.
            let coarse = last.as_ref().filter(|last| last.converged());
            let fine = on_mesh(Mesh::new(size), coarse)?;
            if fine.report.status == Status::TimeLimit {
                return Ok(fine);
            }
            // Estimate the errors, if necessary from a coarser mesh solved for that alone.
            let below = match (&self.below, coarse) {
                (Some(size), None) if i == 0 && fine.converged() => {
                    Some(on_mesh(Mesh::new(size), Some(&fine))?).filter(MeshSolution::converged)
                }
                _ => None,
            };
            let fine = estimator.with_errors(fine, coarse.or(below.as_ref()));
            // Either the mesh of the problem failed, or its solution cannot be continued to a finer mesh.
            let ends = estimator.tolerance.is_none() && i + 1 >= self.required && !fine.converged();
            if ends && i + 1 > self.required {
                break;
            }
            let enough = fine.converged()
                && i + 1 >= self.required
                && estimator.meets(&fine, 1.0)
                && estimator.verdict(&fine) == Status::Converged;
            last = Some(fine);
            if ends || enough {
                break;
            }
        }
        let finest = last.ok_or(KernelError::Internal("a sequence without a mesh"))?;
        Ok(estimator.conclude(finest))
    }
}
