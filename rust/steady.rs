//! One wave from its problem to its solution: static contact or steady sliding.
//!
//! In the frame of the wave the steady state is one non-linear problem. Times are in passages
//! lambda / v, stresses in |G*(2 pi v / lambda)|, the modulus that the wave meets.

use std::f64::consts::TAU;

use crate::contact::State;
use crate::error::{positive, KernelError};
use crate::fem::block::Memory;
use crate::fem::mesh::Mesh;
use crate::material::sliding_history::SlidingHistory;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::problem::Problem;
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solve::judge::Judge;
use crate::solve::load_stepping::{raise, Counts};
use crate::solve::mesh_sequence::{MeshSequence, MeshSolution};
use crate::solve::newton;
use crate::solve::transfer::transfer;
use crate::status::Status;
use crate::watch::Watch;

/// Solve `problem`. With a `tolerance`, the largest estimated error (relative in friction, absolute
/// in contact fraction), the mesh is refined until it is met. `start`, of any rubber, profile and
/// load, is only a first guess. `watch` may end it early: with what was solved by then if its time is
/// over, with a refusal if the caller stopped.
pub fn solve(
    problem: &Problem,
    settings: &Settings,
    tolerance: Option<f64>,
    start: Option<&Solution>,
    watch: &Watch<'_>,
) -> Result<Solution, KernelError> {
    positive("tolerance", tolerance.unwrap_or(1.0))?;
    problem.profile.check_resolved(&problem.mesh)?;
    let passage = problem.profile.wavelength / problem.load.speed;
    let model = Model::new(&problem.rubber, &problem.profile, passage, TAU);
    let mut work = Work {
        problem,
        model: &model,
        settings,
        start,
        watch,
        counts: Counts::default(),
    };
    let first = start.map(|solution| &solution.finest);
    let heights = &model.heights;
    let judge = Judge::new(heights, problem.load.speed > 0.0, tolerance, settings);
    let sequence = MeshSequence::new(&problem.mesh, first, heights.fewest_nodes(), &judge);
    let on_mesh = |mesh: Mesh, coarse: Option<&MeshSolution>| work.on_mesh(mesh, coarse);
    let finest = sequence.solve(&judge, on_mesh)?;
    Ok(Solution {
        problem: problem.clone(),
        stress_unit: model.stress_unit,
        finest,
        counts: work.counts,
    })
}

struct Work<'a> {
    problem: &'a Problem,
    model: &'a Model,
    settings: &'a Settings,
    start: Option<&'a Solution>,
    watch: &'a Watch<'a>,
    counts: Counts,
}

impl Work<'_> {
    /// Solve on `mesh`: from the coarser mesh, else from the start, else by raising the load.
    fn on_mesh(
        &mut self,
        mesh: Mesh,
        coarse: Option<&MeshSolution>,
    ) -> Result<MeshSolution, KernelError> {
        let memory = self.memory(&mesh);
        let pressed = self.model.pressed(&mesh, &memory, self.watch);
        let load = self.problem.load.pressure / self.model.stress_unit;
        let mut solved = None;
        if let Some(mut state) = self.guess(&mesh, coarse) {
            let report = newton::solve(&pressed, &mut None, &mut state, load, self.settings);
            self.counts.iterations += report.iterations;
            self.counts.load_steps += 1;
            if report.status == Status::Converged {
                solved = Some((state, report, 1.0));
            }
        }
        let (state, report, load_reached) = solved.unwrap_or_else(|| {
            let mut state = State::at_rest(&mesh);
            let (report, reached) =
                raise(&pressed, &mut state, load, self.settings, &mut self.counts);
            (state, report, reached)
        });
        self.watch.unless_stopped()?;
        if let (Status::TimeLimit, Some(coarse)) = (report.status, coarse) {
            return Ok(coarse.out_of_time());
        }
        let to_the_end = self.watch.unlimited();
        let pressed = self.model.pressed(&mesh, &memory, &to_the_end);
        let outcome = Outcome::of(&pressed, &state, self.model.edge_law(&mesh, 1.0))
            .map_err(|_| KernelError::Stopped)?;
        Ok(MeshSolution {
            mesh,
            state,
            report,
            load_reached,
            outcome,
            judged_by: None,
            contact_fraction_error: f64::NAN,
            friction_error: f64::NAN,
            friction_bound: None,
        })
    }

    fn guess(&self, mesh: &Mesh, coarse: Option<&MeshSolution>) -> Option<State> {
        let (from, stress) = match (coarse, self.start) {
            (Some(coarse), _) => (coarse, 1.0),
            (None, Some(start)) => (&start.finest, start.stress_unit / self.model.stress_unit),
            (None, None) => return None,
        };
        Some(transfer(&from.mesh, &from.state, mesh, stress))
    }

    fn memory(&self, mesh: &Mesh) -> Memory {
        if self.model.maxwell.moduli.is_empty() {
            return Memory::Relaxed;
        }
        let load = &self.problem.load;
        let passages = load.load_time * load.speed / self.problem.profile.wavelength;
        let history = SlidingHistory::new(mesh.columns, &self.model.maxwell, passages);
        Memory::Sliding(history)
    }
}
