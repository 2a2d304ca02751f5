//! A sequence of meshes, each twice as fine as the one before, the last two telling the error.
//!
//! The coarsest mesh has the load raised step by step, every finer one starts from its predecessor's
//! solution. The sequence goes on until two agree as well as was asked, and the last can be trusted.

use super::judge::Judge;
use super::mesh_solution::MeshSolution;
use crate::contact::profile::Heights;
use crate::error::KernelError;
use crate::fem::mesh::{Mesh, MeshSize};
use crate::status::Status;

/// Nodes of the coarsest mesh that tells anything of a finer one.
const FEWEST_NODES: usize = 8;

/// Meshes, coarsest first, of which the first `required` are solved in any case.
pub struct MeshSequence {
    pub sizes: Vec<MeshSize>,
    pub required: usize,
    /// The mesh of half the first's columns where the profile is too rough to begin with it: solved
    /// afterwards, from the first's solution, to tell its error.
    pub below: Option<MeshSize>,
}

impl MeshSequence {
    /// Up to the mesh asked for, or with a tolerance to any that meets it, and beyond as long as no
    /// solution can be trusted; less of it is needed where there is a solution to `start` from. No
    /// mesh but the one asked for is coarser than the waves of `heights` need: it would find contacts
    /// that are not there, and finer meshes may keep them.
    pub fn new(
        finest: &MeshSize,
        start: Option<&MeshSolution>,
        heights: &Heights,
        judge: &Judge,
    ) -> Self {
        let settings = &judge.settings;
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
        // Without a coarser mesh nothing is known of the errors: one is as coarse as it must.
        if !halve(settings.coarsest_nodes) {
            halve(FEWEST_NODES);
        }
        while halve(settings.coarsest_nodes) {}
        let follows = |columns: usize| finest.order * columns >= heights.fewest_nodes() / 2;
        let below = finest.columns.div_ceil(2);
        let below = (smooth > 0 && columns.len() == 1 && follows(below)).then_some(below);
        let mut required = columns.len();
        let most = match judge.tolerance {
            Some(_) => settings.finest_columns,
            None => settings.rescue_columns.min(settings.finest_columns),
        };
        while columns[columns.len() - 1] * 2 <= most {
            columns.push(columns[columns.len() - 1] * 2);
        }
        let needed = if judge.tolerance.is_none() {
            start.map_or(0, |_| required.saturating_sub(2))
        } else {
            required = 0;
            let least = start.map_or(0, |start| judge.columns_within(start) / 2);
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

    /// Solve on one mesh after the other by `on_mesh(mesh, coarser solution)`, until time is over; the
    /// mesh below from the finer solution.
    pub fn solve(
        &self,
        judge: &Judge,
        mut on_mesh: impl FnMut(Mesh, Option<&MeshSolution>) -> Result<MeshSolution, KernelError>,
    ) -> Result<MeshSolution, KernelError> {
        let mut last: Option<MeshSolution> = None;
        for (i, size) in self.sizes.iter().enumerate() {
            let coarse = last.as_ref().filter(|last| last.converged());
            let fine = on_mesh(Mesh::new(size), coarse)?;
            if fine.report.status == Status::TimeLimit {
                return Ok(fine);
            }
            let below = match (&self.below, coarse) {
                (Some(size), None) if i == 0 && fine.converged() => {
                    Some(on_mesh(Mesh::new(size), Some(&fine))?).filter(MeshSolution::converged)
                }
                _ => None,
            };
            let fine = judge.judged(fine, coarse.or(below.as_ref()));
            // What was asked for failed, or what was solved has no finer solution: that is the answer.
            let ends = judge.tolerance.is_none() && i + 1 >= self.required && !fine.converged();
            if ends && i + 1 > self.required {
                break;
            }
            let enough = fine.converged()
                && i + 1 >= self.required
                && judge.meets(&fine, 1.0)
                && judge.verdict(&fine) == Status::Converged;
            last = Some(fine);
            if ends || enough {
                break;
            }
        }
        let finest = last.ok_or(KernelError::Internal("a sequence without a mesh"))?;
        Ok(judge.concluded(finest))
    }
}
