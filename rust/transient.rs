//! Sliding in time: the frame of the wave, one column per step, the networks carried exactly.
//!
//! The speed is that of the rubber's surface over the wave: the crest follows the mean horizontal
//! displacement of the surface, as in the steady state, which is the limit of a long run.

use std::f64::consts::TAU;

use crate::assembly::{Block, Memory};
use crate::cell::Cell;
use crate::error::{positive, KernelError};
use crate::march::{climb, Count};
use crate::memory::Maxwell;
use crate::networks::Networks;
use crate::newton::{Ending, Kept, Problem, Report, State};
use crate::outcome::{EdgeLaw, Outcome};
use crate::scale::{Scale, Solution};
use crate::wave::Wave;

/// Steps of a dwell at rest, their lengths growing geometrically.
const DWELL_STEPS: usize = 40;
/// First step of a dwell over its duration.
const DWELL_FIRST: f64 = 1e-4;
/// Longest way of one stage in wavelengths.
const LONGEST: f64 = 10_000.0;
/// A step that fails is tried again with its load change cut into this many parts.
const PARTS: usize = 8;

/// A stretch of time with constant speed [m/s] and pressure [Pa].
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    pub duration: f64,
    /// Negative slides backwards; zero dwells.
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

#[derive(Debug, Clone)]
pub struct Run {
    pub moments: Vec<Moment>,
    pub report: Report,
    pub count: Count,
}

impl Scale {
    fn check_stage(&self, stage: &Stage) -> Result<(), KernelError> {
        positive("duration", stage.duration)?;
        positive("pressure", stage.pressure)?;
        if !stage.speed.is_finite() {
            return Err(KernelError::NotFinite {
                name: "speed",
                value: stage.speed,
            });
        }
        let wavelengths = stage.duration * (stage.speed / self.wavelength).abs();
        if wavelengths <= LONGEST {
            return Ok(());
        }
        Err(KernelError::TooLong {
            longest: LONGEST,
            wavelengths,
        })
    }

    /// Slide through `stages`, from rest or from a steady `start` found with the same inputs.
    pub fn run(&self, stages: &[Stage], start: Option<&Solution>) -> Result<Run, KernelError> {
        self.check()?;
        for stage in stages {
            self.check_stage(stage)?;
        }
        let cell = Cell::new(self.order, self.columns, self.rows, self.depth)?;
        let mut maxwell = Maxwell {
            equilibrium: self.equilibrium_modulus,
            moduli: self.moduli.clone(),
            times: self.relaxation_times.clone(),
        };
        let unit = maxwell.magnitude(TAU * self.speed / self.wavelength);
        maxwell.equilibrium /= unit;
        maxwell.moduli.iter_mut().for_each(|g| *g /= unit);
        let mut mover = Mover {
            scale: self,
            cell: &cell,
            maxwell: &maxwell,
            unit,
            count: Count::default(),
            moments: Vec::new(),
            time: 0.0,
            distance: 0.0,
            kept: None,
        };
        let report = mover.all(stages, start);
        Ok(Run {
            moments: mover.moments,
            report,
            count: mover.count,
        })
    }
}

struct Mover<'a> {
    scale: &'a Scale,
    cell: &'a Cell,
    maxwell: &'a Maxwell,
    unit: f64,
    count: Count,
    moments: Vec<Moment>,
    time: f64,
    distance: f64,
    /// The factored block of the last step, good enough for the next one as a rule.
    kept: Option<Kept>,
}

impl Mover<'_> {
    fn problem<'m>(&'m self, memory: &'m Memory) -> Problem<'m> {
        Problem {
            block: Block {
                cell: self.cell,
                energy: self.scale.energy,
                equilibrium: self.maxwell.equilibrium,
                memory,
                bulk_modulus: self.scale.bulk_modulus / self.unit,
            },
            wave: Wave {
                amplitude: self.scale.amplitude / self.scale.wavelength,
            },
        }
    }

    fn all(&mut self, stages: &[Stage], start: Option<&Solution>) -> Report {
        let mut report = Report {
            ending: Ending::Converged,
            iterations: 0,
            residual: 0.0,
        };
        let (mut state, mut networks) = match start {
            Some(solution) => self.steady(solution),
            None => self.rest(),
        };
        let mut pressed = start.is_some();
        for stage in stages {
            if !pressed {
                report = self.press(&mut state, &mut networks, stage.pressure);
                pressed = true;
                if report.ending != Ending::Converged {
                    return report;
                }
                self.record(&state, stage);
            }
            for dt in self.steps(stage) {
                report = self.step(&mut state, &mut networks, stage, dt);
                if report.ending != Ending::Converged {
                    return report;
                }
                self.record(&state, stage);
            }
        }
        report
    }

    fn rest(&self) -> (State, Networks) {
        let state = State::at_rest(self.cell);
        let rows = self.problem(&Memory::Relaxed).row_states(&state.field);
        let networks = Networks::at_rest(&rows, self.cell.columns, self.maxwell);
        (state, networks)
    }

    fn steady(&self, solution: &Solution) -> (State, Networks) {
        let stress = solution.stress_unit / self.unit;
        let state = crate::transfer::transfer(&solution.cell, &solution.state, self.cell, stress);
        let rows = self.problem(&Memory::Relaxed).row_states(&state.field);
        let passage = self.scale.wavelength / self.scale.speed;
        let mut maxwell = self.maxwell.clone();
        maxwell.times.iter_mut().for_each(|time| *time /= passage);
        let load_time = self.scale.load_time / passage;
        let networks = Networks::steady(&rows, self.cell.columns, &maxwell, load_time);
        (state, networks)
    }

    /// Put the load on at once: the networks answer as springs.
    fn press(&mut self, state: &mut State, networks: &mut Networks, pressure: f64) -> Report {
        let memory = Memory::Given(networks.known_part(self.maxwell, 0.0));
        let mut count = self.count;
        let load = pressure / self.unit;
        let problem = self.problem(&memory);
        let (report, _) = climb(&problem, state, load, &self.scale.limits, &mut count);
        let rows = problem.row_states(&state.field);
        networks.advance(&rows, self.maxwell, 0.0);
        self.count = count;
        report
    }

    /// Lengths of the time steps of a stage: one column each, or growing in a dwell.
    fn steps(&self, stage: &Stage) -> Vec<f64> {
        if stage.speed == 0.0 {
            let ratio = DWELL_FIRST.powf(-1.0 / (DWELL_STEPS - 1) as f64);
            let ends = (0..DWELL_STEPS).map(|i| DWELL_FIRST * ratio.powi(i as i32));
            let mut before = 0.0;
            return ends
                .map(|end| {
                    let step = stage.duration * (end - before);
                    before = end;
                    step
                })
                .collect();
        }
        let dt = self.scale.wavelength / (self.cell.columns as f64 * stage.speed.abs());
        vec![dt; (stage.duration / dt).round().max(1.0) as usize]
    }

    fn step(
        &mut self,
        state: &mut State,
        networks: &mut Networks,
        stage: &Stage,
        dt: f64,
    ) -> Report {
        if stage.speed != 0.0 {
            networks.carry(stage.speed > 0.0);
        }
        self.time += dt;
        self.distance += stage.speed * dt;
        let memory = Memory::Given(networks.known_part(self.maxwell, dt));
        let load = stage.pressure / self.unit;
        let mut count = self.count;
        let mut kept = self.kept.take();
        let problem = self.problem(&memory);
        let report = settle(&problem, &mut kept, state, load, self.scale, &mut count);
        let rows = problem.row_states(&state.field);
        networks.advance(&rows, self.maxwell, dt);
        self.count = count;
        self.kept = kept;
        report
    }

    fn edge_law(&self, stage: &Stage) -> EdgeLaw {
        if stage.speed == 0.0 {
            return EdgeLaw::ELASTIC;
        }
        let wave = 4.0 * self.scale.wavelength / self.cell.layer_nodes() as f64;
        let (storage, loss) = self.maxwell.complex_modulus(TAU * stage.speed.abs() / wave);
        EdgeLaw::new(storage, loss, stage.speed > 0.0)
    }

    fn record(&mut self, state: &State, stage: &Stage) {
        let memory = Memory::Relaxed;
        let problem = self.problem(&memory);
        let outcome = Outcome::of(&problem, state, self.edge_law(stage));
        let moment = Moment {
            time: self.time,
            distance: self.distance,
            speed: stage.speed,
            pressure: stage.pressure,
            friction: outcome.friction,
            contact_fraction: outcome.contact_fraction,
            approach: state.approach,
        };
        self.moments.push(moment);
    }
}

/// Newton from the last step's state; if that fails, the load is led to its new value in parts.
fn settle(
    problem: &Problem<'_>,
    kept: &mut Option<Kept>,
    state: &mut State,
    load: f64,
    scale: &Scale,
    count: &mut Count,
) -> Report {
    let from: f64 = state.force.iter().sum();
    let mut trial = state.clone();
    let mut report = problem.solve_with(kept, &mut trial, load, &scale.limits);
    count.iterations += report.iterations;
    count.steps += 1;
    if report.ending != Ending::Converged {
        trial = state.clone();
        for part in 1..=PARTS {
            let between = from + (load - from) * part as f64 / PARTS as f64;
            report = problem.solve(&mut trial, between, &scale.limits);
            count.iterations += report.iterations;
            if report.ending != Ending::Converged {
                break;
            }
        }
    }
    if report.ending != Ending::Converged {
        trial = State::at_rest(problem.block.cell);
        report = climb(problem, &mut trial, load, &scale.limits, count).0;
    }
    *state = trial;
    report
}
