//! Sliding in time, in the frame of the wave: every step moves the rubber by one column, which carries the
//! states of the networks exactly.
//!
//! The speed is that of the rubber's surface over the wave: the profile follows the mean horizontal
//! displacement of the surface, as in the steady state, which is the limit of a long run. Times are
//! in seconds.

use std::f64::consts::TAU;

use crate::contact::{PressedBlock, State};
use crate::error::{finite, positive, KernelError};
use crate::executor::Executor;
use crate::fem::block::Memory;
use crate::fem::mesh::Mesh;
use crate::material::carried_history::{CarriedHistory, Points};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::problem::{MeshSize, Profile, Rubber};
use crate::settings::Settings;
use crate::solution::{Counts, Report, Solution};
use crate::solve::kept_factor::KeptFactor;
use crate::solve::load_stepping::raise;
use crate::solve::newton;
use crate::solve::transfer::transfer;
use crate::status::Status;

/// Longest sliding distance of one stage [wavelengths].
const LONGEST_STAGE: f64 = 10_000.0;
/// Parts into which a change of load is cut if a time step fails.
const LOAD_PARTS: usize = 8;

/// A stretch of time with constant speed [m/s] and pressure [Pa].
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    pub duration: f64,
    /// Negative for sliding backwards, zero for a dwell.
    pub speed: f64,
    pub pressure: f64,
}

/// One moment of a run.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    pub time: f64,
    pub distance: f64,
    pub speed: f64,
    pub pressure: f64,
    /// Horizontal over vertical force; positive opposes sliding in +x.
    pub friction: f64,
    pub contact_fraction: f64,
    /// Approach of wave and block in wavelengths.
    pub approach: f64,
}

/// The result of a programme of stages; if it ended early, the moments before are valid.
#[derive(Debug, Clone)]
pub struct Run {
    pub moments: Vec<Moment>,
    pub status: Status,
    pub counts: Counts,
}

/// Slide through `stages`, from rest or from a steady or static `start` of the same rubber and profile,
/// whose load and mesh may differ. `executor` may end the work early: at its time limit with the moments
/// before, or with `KernelError::Stopped` if the caller stopped.
pub fn solve(
    rubber: &Rubber,
    profile: &Profile,
    mesh: &MeshSize,
    settings: &Settings,
    stages: &[Stage],
    start: Option<&Solution>,
    executor: &Executor<'_>,
) -> Result<Run, KernelError> {
    profile.check_resolved(mesh)?;
    for stage in stages {
        check_stage(stage, profile)?;
    }
    if let Some(start) = start {
        check_start(start, rubber, profile)?;
    }
    // Stresses are in units of the modulus at the speed of the start, or of the fastest stage.
    let fastest = stages.iter().fold(0.0_f64, |v, stage| v.max(stage.speed.abs()));
    let start_speed = start.map_or(0.0, |start| start.problem.load.speed);
    let speed = if start_speed > 0.0 { start_speed } else { fastest };
    let model = Model::new(rubber, profile, 1.0, TAU * speed / profile.wavelength);
    let mesh = Mesh::new(mesh);
    let mut integration =
        Integration::new(&model, &mesh, settings, profile.wavelength, start, executor);
    let status = match integration.run(stages, start.is_some()) {
        Ok(()) => Status::Converged,
        Err(Status::Stopped) => return Err(KernelError::Stopped),
        Err(status) => status,
    };
    Ok(Run { moments: integration.moments, status, counts: integration.counts })
}

fn check_stage(stage: &Stage, profile: &Profile) -> Result<(), KernelError> {
    positive("duration", stage.duration)?;
    positive("pressure", stage.pressure)?;
    finite("speed", stage.speed)?;
    let wavelengths = stage.duration * (stage.speed / profile.wavelength).abs();
    if wavelengths <= LONGEST_STAGE {
        return Ok(());
    }
    Err(KernelError::TooLong { longest: LONGEST_STAGE, wavelengths })
}

fn check_start(start: &Solution, rubber: &Rubber, profile: &Profile) -> Result<(), KernelError> {
    match start.finest.report.status {
        Status::Converged
        | Status::ToleranceNotMet
        | Status::FrictionsDisagree
        | Status::ContactTooNarrow
            if start.finest.report.load_reached == 1.0 =>
        {
            start.problem.check_same(rubber, profile)
        }
        other => Err(KernelError::UnsolvedStart(other.word())),
    }
}

struct Integration<'a> {
    model: &'a Model,
    mesh: &'a Mesh,
    settings: &'a Settings,
    wavelength: f64,
    executor: &'a Executor<'a>,
    state: State,
    kept_factor: Option<KeptFactor>,
    networks: CarriedHistory,
    counts: Counts,
    moments: Vec<Moment>,
    time: f64,
    distance: f64,
}

impl<'a> Integration<'a> {
    fn new(
        model: &'a Model,
        mesh: &'a Mesh,
        settings: &'a Settings,
        wavelength: f64,
        start: Option<&Solution>,
        executor: &'a Executor<'a>,
    ) -> Self {
        let state = start.map_or_else(
            || State::at_rest(mesh),
            |start| {
                let (from, ratio) = (&start.finest, start.stress_unit / model.stress_unit);
                transfer(&from.mesh, &from.state, mesh, ratio)
            },
        );
        let pressed = model.pressed(mesh, &Memory::Relaxed, executor);
        let y = remembered(&pressed, &state);
        Self {
            kept_factor: KeptFactor::new(&pressed, settings),
            networks: networks(model, mesh, wavelength, y, start),
            model,
            mesh,
            settings,
            wavelength,
            executor,
            state,
            counts: Counts::default(),
            moments: Vec::new(),
            time: 0.0,
            distance: 0.0,
        }
    }

    fn run(&mut self, stages: &[Stage], mut pressed: bool) -> Result<(), Status> {
        for stage in stages {
            if !pressed {
                self.press(stage.pressure)?;
                self.record(stage)?;
                pressed = true;
            }
            self.kept_factor.iter_mut().for_each(KeptFactor::forget_last_step);
            for dt in self.steps(stage) {
                self.step(stage, dt)?;
                self.record(stage)?;
            }
        }
        Ok(())
    }

    /// Apply the load at once: the networks respond as springs.
    fn press(&mut self, pressure: f64) -> Result<(), Status> {
        let memory = Memory::Given(self.networks.known_part(&self.model.maxwell, 0.0));
        let pressed = self.model.pressed(self.mesh, &memory, self.executor);
        let load = pressure / self.model.stress_unit;
        let counts = &mut self.counts;
        let report = raise(&pressed, &mut self.state, load, self.settings, counts);
        report.converged()?;
        let y = remembered(&pressed, &self.state);
        self.networks.advance(y, &self.model.maxwell, 0.0);
        Ok(())
    }

    /// Lengths of the time steps of a stage: one column each in sliding, growing in a dwell.
    fn steps(&self, stage: &Stage) -> Vec<f64> {
        if stage.speed == 0.0 {
            let (count, first) = (self.settings.dwell_steps, self.settings.dwell_first);
            let ratio = first.powf(-1.0 / (count - 1) as f64);
            let mut before = 0.0;
            let step = |i: usize| {
                let end = first * ratio.powi(i as i32);
                let step = stage.duration * (end - before);
                before = end;
                step
            };
            return (0..count).map(step).collect();
        }
        let dt = self.wavelength / (self.mesh.columns as f64 * stage.speed.abs());
        vec![dt; (stage.duration / dt).round().max(1.0) as usize]
    }

    fn step(&mut self, stage: &Stage, dt: f64) -> Result<(), Status> {
        if stage.speed != 0.0 {
            self.networks.carry(stage.speed > 0.0);
        }
        self.time += dt;
        self.distance += stage.speed * dt;
        let memory = Memory::Given(self.networks.known_part(&self.model.maxwell, dt));
        let pressed = self.model.pressed(self.mesh, &memory, self.executor);
        let load = stage.pressure / self.model.stress_unit;
        self.solve_step(&pressed, load).converged()?;
        let y = remembered(&pressed, &self.state);
        self.networks.advance(y, &self.model.maxwell, dt);
        Ok(())
    }

    /// Newton's method from the state of the last step, first with the kept factor. If that fails, the load
    /// changes to its new value in parts; if that fails too, it is raised from rest.
    fn solve_step(&mut self, pressed: &PressedBlock<'_>, load: f64) -> Report {
        let (settings, counts) = (self.settings, &mut self.counts);
        let from: f64 = self.state.force.iter().sum();
        let mut trial = self.state.clone();
        if let Some(kept_factor) = &mut self.kept_factor {
            let report = kept_factor.solve(pressed, &mut trial, load, settings);
            counts.add(&report);
            if report.status == Status::Converged {
                self.state = trial;
                return report;
            }
            trial = self.state.clone();
        }
        let mut report = newton::solve(pressed, &mut trial, load, settings);
        counts.add(&report);
        if report.status != Status::Converged {
            trial = self.state.clone();
            for part in 1..=LOAD_PARTS {
                let between = from + (load - from) * part as f64 / LOAD_PARTS as f64;
                report = newton::solve(pressed, &mut trial, between, settings);
                counts.add(&report);
                if report.status != Status::Converged {
                    break;
                }
            }
        }
        if report.status != Status::Converged {
            trial = State::at_rest(self.mesh);
            report = raise(pressed, &mut trial, load, settings, counts);
        }
        self.state = trial;
        report
    }

    fn record(&mut self, stage: &Stage) -> Result<(), Status> {
        let pressed = self.model.pressed(self.mesh, &Memory::Relaxed, self.executor);
        let law = self.model.edge_law(self.mesh, stage.speed / self.wavelength);
        let outcome = Outcome::of(&pressed, &self.state, law)?;
        self.moments.push(Moment {
            time: self.time,
            distance: self.distance,
            speed: stage.speed,
            pressure: stage.pressure,
            friction: outcome.friction,
            contact_fraction: outcome.contact_fraction,
            approach: self.state.approach,
        });
        Ok(())
    }
}

/// States of the networks at the beginning: relaxed at rest and in static contact, otherwise those of the
/// steady state.
fn networks(
    model: &Model,
    mesh: &Mesh,
    wavelength: f64,
    y: Points,
    start: Option<&Solution>,
) -> CarriedHistory {
    let load = start.map(|start| start.problem.load);
    let Some(load) = load.filter(|load| load.speed > 0.0) else {
        return CarriedHistory::relaxed(y, mesh.columns, &model.maxwell);
    };
    let passage = wavelength / load.speed;
    let mut maxwell = model.maxwell.clone();
    maxwell.times.iter_mut().for_each(|time| *time /= passage);
    CarriedHistory::steady(y, mesh.columns, &maxwell, load.load_time / passage)
}

/// Y at all Gauss points in `state`, which the temporary networks remember.
fn remembered(pressed: &PressedBlock<'_>, state: &State) -> Points {
    let block = &pressed.block;
    (0..block.mesh.rows).map(|row| block.row_state(row, &state.field.u).remembered()).collect()
}
