//! One wave from its problem to its solution: static contact or steady sliding.
//!
//! In the frame of the wave the steady state is one non-linear problem. Times are in passages
//! lambda / v, stresses in |G*(2 pi v / lambda)|, the modulus that the wave meets.

use std::f64::consts::TAU;

use crate::contact::{PressedBlock, State};
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
use crate::solve::mesh_sequence::MeshSequence;
use crate::solve::mesh_solution::MeshSolution;
use crate::solve::newton;
use crate::solve::roughening::{Ended, Roughening};
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
        tolerance,
        counts: Counts::default(),
        waves_carried: 0,
    };
    let first = start.map(|solution| &solution.finest);
    let heights = &model.heights;
    let judge = Judge::new(heights, problem.load.speed > 0.0, tolerance, settings);
    let sequence = MeshSequence::new(&problem.mesh, first, heights, &judge);
    let too_narrow = work.too_narrow();
    let finest = match too_narrow {
        Some(_) => work.refused()?,
        None => {
            let on_mesh = |mesh: Mesh, coarse: Option<&MeshSolution>| work.on_mesh(mesh, coarse);
            let finest = sequence.solve(&judge, on_mesh)?;
            work.rescued(finest, &judge)?
        }
    };
    let too_rough = finest.report.status == Status::ProfileTooRough;
    Ok(Solution {
        problem: problem.clone(),
        stress_unit: model.stress_unit,
        finest,
        waves_carried: too_rough.then_some(work.waves_carried),
        counts: work.counts,
        too_narrow,
    })
}

struct Work<'a> {
    problem: &'a Problem,
    model: &'a Model,
    settings: &'a Settings,
    start: Option<&'a Solution>,
    watch: &'a Watch<'a>,
    tolerance: Option<f64>,
    counts: Counts,
    /// Waves of a rough profile that did carry the load.
    waves_carried: usize,
}

impl Work<'_> {
    fn load(&self) -> f64 {
        self.problem.load.pressure / self.model.stress_unit
    }

    /// The contact's width after Hertz and half the node spacing of the finest mesh allowed, in
    /// wavelengths, if the contact is the narrower.
    fn too_narrow(&self) -> Option<(f64, f64)> {
        let (size, settings) = (&self.problem.mesh, self.settings);
        let finest = match self.tolerance {
            Some(_) => settings.finest_columns,
            None => settings.rescue_columns,
        };
        let finest = size.order * size.columns.max(finest);
        let widths = (
            self.model.expected_contact(self.load()),
            0.5 / finest as f64,
        );
        (widths.0 < widths.1).then_some(widths)
    }

    /// Nothing solved: the block at rest.
    fn refused(&self) -> Result<MeshSolution, KernelError> {
        let mesh = Mesh::new(&self.problem.mesh);
        let memory = self.memory(&mesh);
        self.unsolved(mesh, &memory, Status::ContactTooNarrow)
    }

    /// The block at rest on a mesh for which nothing was found.
    fn unsolved(
        &self,
        mesh: Mesh,
        memory: &Memory,
        status: Status,
    ) -> Result<MeshSolution, KernelError> {
        let state = State::at_rest(&mesh);
        let report = newton::Report {
            status,
            iterations: 0,
            products: 0,
            residual: f64::NAN,
        };
        self.solution(mesh, memory, state, report, 0.0)
    }

    /// `finest` itself, or where its mesh did not carry the load what a mesh twice as fine gives:
    /// stretches that only a coarse mesh has end load paths that the rubber does not end.
    fn rescued(
        &mut self,
        finest: MeshSolution,
        judge: &Judge,
    ) -> Result<MeshSolution, KernelError> {
        let mesh_may_be_why = matches!(
            finest.report.status,
            Status::Fold
                | Status::IterationLimit
                | Status::ElementInverted
                | Status::NoActiveSet
                | Status::NotFinite
                | Status::MeanShear
        );
        let columns = 2 * finest.mesh.columns;
        if !mesh_may_be_why || columns > self.settings.rescue_columns {
            return Ok(finest);
        }
        let size = &self.problem.mesh;
        let finer = size.with_columns(columns, self.settings.row_exponent);
        let finer = self.on_mesh(Mesh::new(&finer), None)?;
        let solved = finer.report.status == Status::Converged;
        Ok(if solved {
            judge.concluded(judge.judged(finer, None))
        } else {
            finest
        })
    }

    /// Solve on `mesh`: from the coarser mesh, else from the start, else by raising the load. From a
    /// finer mesh, which needs no other way to its solution, or not at all.
    fn on_mesh(
        &mut self,
        mesh: Mesh,
        coarse: Option<&MeshSolution>,
    ) -> Result<MeshSolution, KernelError> {
        let memory = self.memory(&mesh);
        let pressed = self.model.pressed(&mesh, &memory, self.watch);
        let load = self.load();
        let (mut solved, mut time_left) = (None, true);
        if let Some(mut state) = self.guess(&pressed, coarse) {
            let report = newton::solve(&pressed, &mut state, load, self.settings);
            self.counts.add(&report);
            self.counts.load_steps += 1;
            time_left = report.status != Status::TimeLimit;
            if report.status == Status::Converged {
                solved = Some((state, report, 1.0));
            }
        }
        let from_finer = coarse.is_some_and(|from| from.mesh.columns > mesh.columns);
        let given_up = from_finer || coarse.is_some() && self.beyond(&mesh);
        if time_left && solved.is_none() && given_up {
            return self.unsolved(mesh, &memory, Status::IterationLimit);
        }
        if time_left && solved.is_none() {
            match self.roughened(&mesh) {
                Some(Ok((state, report))) => solved = Some((state, report, 1.0)),
                Some(Err(ended)) => return self.too_rough(mesh, &memory, coarse, ended),
                None => {}
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
        let mut found = self.solution(mesh, &memory, state, report, load_reached)?;
        let ended = [Status::Converged, Status::TimeLimit].contains(&report.status);
        if !ended && self.mean_shear(&found) > self.settings.large_mean_shear {
            found.report.status = Status::MeanShear;
        }
        Ok(found)
    }

    /// The solution on `mesh` from smoother profiles on coarser ones, where the profile is rough.
    fn roughened(&mut self, mesh: &Mesh) -> Option<Result<(State, newton::Report), Ended>> {
        let (model, passages) = (self.model, self.passages());
        let memory = |mesh: &Mesh| memory(model, passages, mesh);
        let roughening = Roughening {
            model,
            size: &self.problem.mesh,
            load: self.load(),
            settings: self.settings,
            watch: self.watch,
            memory: &memory,
        };
        roughening.solve(mesh.columns, &mut self.counts)
    }

    /// What is left of a mesh on which the rough profile was not solved.
    fn too_rough(
        &mut self,
        mesh: Mesh,
        memory: &Memory,
        coarse: Option<&MeshSolution>,
        ended: Ended,
    ) -> Result<MeshSolution, KernelError> {
        self.watch.unless_stopped()?;
        self.waves_carried = self.waves_carried.max(ended.waves);
        if let (Status::TimeLimit, Some(coarse)) = (ended.status, coarse) {
            return Ok(coarse.out_of_time());
        }
        self.unsolved(mesh, memory, ended.status)
    }

    /// Whether a mesh is finer than what was asked for, wanted for trust alone, and too fine to be
    /// worth a load path of its own.
    fn beyond(&self, mesh: &Mesh) -> bool {
        let asked = self.problem.mesh.columns.max(self.settings.path_columns);
        self.tolerance.is_none() && mesh.columns > asked
    }

    fn solution(
        &self,
        mesh: Mesh,
        memory: &Memory,
        state: State,
        report: newton::Report,
        load_reached: f64,
    ) -> Result<MeshSolution, KernelError> {
        let to_the_end = self.watch.unlimited();
        let pressed = self.model.pressed(&mesh, memory, &to_the_end);
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

    /// Friction over the modulus of the mean deformation, at the load that was reached.
    fn mean_shear(&self, found: &MeshSolution) -> f64 {
        let traction = found.outcome.friction * found.load_reached * self.load();
        (traction / self.model.maxwell.relaxation_modulus(self.passages())).abs()
    }

    /// Load time in passages of the wave.
    fn passages(&self) -> f64 {
        let load = &self.problem.load;
        load.load_time * load.speed / self.problem.profile.wavelength
    }

    /// The coarser mesh's solution, or what the start has on this very mesh where that is nearer;
    /// on the first mesh the start.
    fn guess(&self, pressed: &PressedBlock<'_>, coarse: Option<&MeshSolution>) -> Option<State> {
        let mesh = pressed.mesh();
        let finer = coarse.map(|coarse| transfer(&coarse.mesh, &coarse.state, mesh, 1.0));
        let Some(start) = self.start else {
            return finer;
        };
        let stress = start.stress_unit / self.model.stress_unit;
        let own = start.finest.found_on(mesh);
        let own = own.map(|state| state.restressed(stress));
        let missed = |state: &State| newton::missed(pressed, state, self.load());
        match (finer, own) {
            (Some(finer), Some(own)) if missed(&own) < missed(&finer) => Some(own),
            (Some(finer), _) => Some(finer),
            (None, Some(own)) => Some(own),
            (None, None) => {
                let (from, state) = (&start.finest.mesh, &start.finest.state);
                Some(transfer(from, state, mesh, stress))
            }
        }
    }

    fn memory(&self, mesh: &Mesh) -> Memory {
        memory(self.model, self.passages(), mesh)
    }
}

/// What the networks remember on `mesh`, after a load time of so many `passages` of the wave.
fn memory(model: &Model, passages: f64, mesh: &Mesh) -> Memory {
    if model.maxwell.moduli.is_empty() {
        return Memory::Relaxed;
    }
    Memory::Sliding(SlidingHistory::new(mesh.columns, &model.maxwell, passages))
}
