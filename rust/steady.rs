//! One wave from its problem to its solution: static contact or steady sliding.
//!
//! In the frame of the wave the steady state is one non-linear problem. Times are in passages
//! lambda / v, stresses in |G*(2 pi v / lambda)|, the modulus at the fundamental excitation.
//!
//! The meshes of a sequence are solved one after the other. On each mesh, attempts are made in the order
//! of `Wave::ATTEMPTS`, until one decides: from the nearest solution, through smoother profiles, by load stepping.

use std::f64::consts::TAU;

use crate::contact::sampling::Sampling;
use crate::contact::{PressedBlock, State};
use crate::error::{positive, KernelError};
use crate::executor::Executor;
use crate::fem::block::Memory;
use crate::fem::mesh::Mesh;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::problem::{Load, Problem};
use crate::settings::Settings;
use crate::solution::{Counts, MeshSolution, Report, Solution};
use crate::solve::error_estimator::ErrorEstimator;
use crate::solve::load_stepping::raise;
use crate::solve::mesh_sequence::MeshSequence;
use crate::solve::newton;
use crate::solve::profile_continuation::ProfileContinuation;
use crate::solve::transfer::transfer;
use crate::status::Status;

/// Mean shear of the block beyond which it is the reason why a load path ends.
const LARGE_MEAN_SHEAR: f64 = 2.0;

/// Solve `problem`.
///
/// With a `tolerance`, the largest estimated error (relative in friction, absolute in contact fraction),
/// the mesh is refined until the tolerance is met. `start`, of any rubber, profile and load, is only a first
/// guess. `executor` may end the work early: at its time limit with what was solved by then, or with
/// `KernelError::Stopped` if the caller stopped.
pub fn solve(
    problem: &Problem,
    settings: &Settings,
    tolerance: Option<f64>,
    start: Option<&Solution>,
    executor: &Executor<'_>,
) -> Result<Solution, KernelError> {
    positive("tolerance", tolerance.unwrap_or(1.0))?;
    problem.profile.check_resolved(&problem.mesh)?;
    let Load { pressure, speed, load_time } = problem.load;
    let wavelength = problem.profile.wavelength;
    let mut model = Model::new(&problem.rubber, &problem.profile, wavelength / speed, TAU);
    if model.heights.waves() > 1 && settings.profile_patches > 0 {
        model.sampling = Sampling::Patches;
    }
    let mut wave = Wave {
        problem,
        model: &model,
        settings,
        start,
        executor,
        tolerance,
        load: pressure / model.stress_unit,
        passages: load_time * speed / wavelength,
        counts: Counts::default(),
        waves_carried: 0,
    };
    let first = start.map(|solution| &solution.finest);
    let slides = speed > 0.0;
    let estimator = ErrorEstimator::new(&model.heights, slides, tolerance, settings);
    let sequence = MeshSequence::new(&problem.mesh, first, &model.heights, &estimator);
    let too_narrow = wave.too_narrow();
    let finest = if too_narrow.is_some() {
        wave.unsolvable(Status::ContactTooNarrow)?
    } else {
        let finest = sequence.solve(&estimator, |mesh, coarse| wave.on_mesh(mesh, coarse))?;
        wave.retried_on_finer_mesh(finest, &estimator)?
    };
    let too_rough = finest.report.status == Status::ProfileTooRough;
    Ok(Solution {
        problem: problem.clone(),
        stress_unit: model.stress_unit,
        finest,
        waves_carried: too_rough.then_some(wave.waves_carried),
        counts: wave.counts,
        too_narrow,
    })
}

/// A wave, and the work spent on it.
struct Wave<'a> {
    problem: &'a Problem,
    model: &'a Model,
    settings: &'a Settings,
    start: Option<&'a Solution>,
    executor: &'a Executor<'a>,
    tolerance: Option<f64>,
    /// Mean pressure in stress units, times one wavelength.
    load: f64,
    /// Load time in passages of the wave.
    passages: f64,
    counts: Counts,
    /// Number of waves of a rough profile that carried the load.
    waves_carried: usize,
}

/// A way to a solution on one mesh, given the solution on a coarser mesh; None if it does not apply or
/// fails, so that the next attempt is made.
type Attempt<'w> =
    fn(&mut Wave<'w>, &PressedBlock<'_>, Option<&MeshSolution>) -> Option<(State, Report)>;

impl<'w> Wave<'w> {
    /// The attempts in their order, each more expensive than the one before.
    const ATTEMPTS: [Attempt<'w>; 3] = [
        Self::start_from_nearest_solution,
        Self::continue_through_smoother_profiles,
        Self::raise_load,
    ];

    /// Solve on `mesh`; `coarse` is the solution on another mesh, usually a coarser one.
    fn on_mesh(
        &mut self,
        mesh: Mesh,
        coarse: Option<&MeshSolution>,
    ) -> Result<MeshSolution, KernelError> {
        let memory = self.model.sliding_memory(&mesh, self.passages);
        let pressed = self.model.pressed(&mesh, &memory, self.executor);
        let (state, report) = Self::ATTEMPTS
            .into_iter()
            .take(self.attempts_worth_making(&mesh, coarse))
            .find_map(|attempt| attempt(self, &pressed, coarse))
            .unwrap_or_else(|| unsolved(&mesh, Status::IterationLimit));
        match (report.status, coarse) {
            (Status::Stopped, _) => Err(KernelError::Stopped),
            (status @ Status::TimeLimit, Some(coarse)) => {
                let report = Report { status, ..coarse.report };
                Ok(MeshSolution { report, ..coarse.clone() })
            }
            _ => self.evaluate(mesh, &memory, state, report),
        }
    }

    /// How many of the attempts are worth making on a mesh.
    ///
    /// Only the first is, if `coarse` is in fact finer and its error estimate is all that the mesh is for. If
    /// the mesh is finer than the problem's, only confirms a solution, and is too fine to be worth a load path
    /// of its own, smoother profiles still are: on a coarse mesh a rough profile may have other solutions.
    fn attempts_worth_making(&self, mesh: &Mesh, coarse: Option<&MeshSolution>) -> usize {
        let Some(coarse) = coarse else {
            return Self::ATTEMPTS.len();
        };
        let for_estimate = coarse.mesh.columns > mesh.columns;
        let worth_a_path = self.problem.mesh.columns.max(self.settings.path_columns);
        let to_confirm = self.tolerance.is_none() && mesh.columns > worth_a_path;
        match (for_estimate, to_confirm) {
            (true, _) => 1,
            (false, true) => 2,
            (false, false) => Self::ATTEMPTS.len(),
        }
    }

    /// Newton's method from the solution on a coarser mesh or from the start.
    fn start_from_nearest_solution(
        &mut self,
        pressed: &PressedBlock<'_>,
        coarse: Option<&MeshSolution>,
    ) -> Option<(State, Report)> {
        let mut state = self.nearest_solution(pressed, coarse)?;
        let report = newton::solve(pressed, &mut state, self.load, self.settings);
        self.counts.add(&report);
        match report.status {
            Status::Converged => Some((state, report)),
            status if status.interrupts() => Some(unsolved(pressed.mesh(), status)),
            _ => None,
        }
    }

    /// From smoother profiles on coarser meshes, if the profile is rough for this mesh.
    fn continue_through_smoother_profiles(
        &mut self,
        pressed: &PressedBlock<'_>,
        _coarse: Option<&MeshSolution>,
    ) -> Option<(State, Report)> {
        let continuation = ProfileContinuation {
            model: self.model,
            size: &self.problem.mesh,
            load: self.load,
            passages: self.passages,
            settings: self.settings,
            executor: self.executor,
        };
        let mesh = pressed.mesh();
        let solved = continuation.solve(mesh.columns, &mut self.counts)?;
        Some(match solved {
            Ok(converged) => converged,
            Err(reason) => {
                self.waves_carried = self.waves_carried.max(reason.waves);
                unsolved(mesh, reason.status)
            }
        })
    }

    /// From the block at rest, with the load raised step by step.
    fn raise_load(
        &mut self,
        pressed: &PressedBlock<'_>,
        _coarse: Option<&MeshSolution>,
    ) -> Option<(State, Report)> {
        let mut state = State::at_rest(pressed.mesh());
        let report = raise(pressed, &mut state, self.load, self.settings, &mut self.counts);
        Some((state, report))
    }

    /// `finest` itself, or, if its mesh did not carry the load, the solution on a mesh twice as fine:
    /// stretches that occur on a coarse mesh only may end load paths that do not end in the rubber.
    fn retried_on_finer_mesh(
        &mut self,
        finest: MeshSolution,
        estimator: &ErrorEstimator,
    ) -> Result<MeshSolution, KernelError> {
        let mesh_may_be_the_cause = matches!(
            finest.report.status,
            Status::Fold
                | Status::IterationLimit
                | Status::ElementInverted
                | Status::NoActiveSet
                | Status::NotFinite
                | Status::MeanShear
                | Status::ProfileTooRough
        );
        let columns = 2 * finest.mesh.columns;
        if !mesh_may_be_the_cause || columns > self.settings.rescue_columns {
            return Ok(finest);
        }
        let size = &self.problem.mesh;
        let finer = size.with_columns(columns, self.settings.row_exponent);
        let finer = self.on_mesh(Mesh::new(&finer), None)?;
        Ok(if finer.converged() {
            estimator.conclude(estimator.with_errors(finer, None))
        } else {
            finest
        })
    }

    /// The contact's width by Hertz and half the node spacing of the finest mesh allowed, in wavelengths,
    /// if the contact is the narrower.
    fn too_narrow(&self) -> Option<(f64, f64)> {
        let (size, settings) = (&self.problem.mesh, self.settings);
        let columns = match self.tolerance {
            Some(_) => settings.finest_columns,
            None => settings.rescue_columns,
        };
        let nodes = size.order * size.columns.max(columns);
        let contact = self.model.expected_contact(self.load);
        let resolved = 0.5 / nodes as f64;
        (contact < resolved).then_some((contact, resolved))
    }

    /// The result for a problem that no mesh can solve: the block at rest.
    fn unsolvable(&self, status: Status) -> Result<MeshSolution, KernelError> {
        let mesh = Mesh::new(&self.problem.mesh);
        let memory = self.model.sliding_memory(&mesh, self.passages);
        let (state, report) = unsolved(&mesh, status);
        self.evaluate(mesh, &memory, state, report)
    }

    /// Contact and friction of a `state`, which may be unfinished. `MeanShear` replaces the status of a load path that ended under
    /// a large mean shear of the block.
    fn evaluate(
        &self,
        mesh: Mesh,
        memory: &Memory,
        state: State,
        mut report: Report,
    ) -> Result<MeshSolution, KernelError> {
        let executor = self.executor.without_deadline();
        let pressed = self.model.pressed(&mesh, memory, &executor);
        let outcome = Outcome::of(&pressed, &state, self.model.edge_law(&mesh, 1.0))
            .map_err(|_| KernelError::Stopped)?;
        let unfinished = ![Status::Converged, Status::TimeLimit].contains(&report.status);
        let traction = outcome.friction * report.load_reached * self.load;
        let modulus = self.model.maxwell.relaxation_modulus(self.passages);
        if unfinished && (traction / modulus).abs() > LARGE_MEAN_SHEAR {
            report.status = Status::MeanShear;
        }
        Ok(MeshSolution {
            mesh,
            state,
            report,
            outcome,
            coarser: None,
            contact_fraction_error: f64::NAN,
            friction_error: f64::NAN,
            friction_bound: None,
        })
    }

    /// The solution on the coarser mesh, or the start's on this very mesh if its residual is smaller; on
    /// the first mesh the start.
    fn nearest_solution(
        &self,
        pressed: &PressedBlock<'_>,
        coarse: Option<&MeshSolution>,
    ) -> Option<State> {
        let mesh = pressed.mesh();
        let from_coarse = coarse.map(|coarse| transfer(&coarse.mesh, &coarse.state, mesh, 1.0));
        let Some(start) = self.start else {
            return from_coarse;
        };
        let stress_ratio = start.stress_unit / self.model.stress_unit;
        let from_start = start.finest.state_on(mesh);
        let from_start = from_start.map(|state| state.in_stress_unit(stress_ratio));
        let residual = |state: &State| newton::residual_norm(pressed, state, self.load);
        match (from_coarse, from_start) {
            (Some(coarse), Some(start)) if residual(&start) < residual(&coarse) => Some(start),
            (Some(coarse), _) => Some(coarse),
            (None, Some(start)) => Some(start),
            (None, None) => {
                let (from, state) = (&start.finest.mesh, &start.finest.state);
                Some(transfer(from, state, mesh, stress_ratio))
            }
        }
    }
}

/// The block at rest, because nothing was solved.
fn unsolved(mesh: &Mesh, status: Status) -> (State, Report) {
    (State::at_rest(mesh), Report::unsolved(status))
}
