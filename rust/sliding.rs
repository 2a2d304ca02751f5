//! One scale, from inputs to outcome: static or steady sliding, with the march to the full load.
//!
//! The pressure is raised from a small-strain start; the step grows after success and is cut
//! after failure. A coarse cell walks the march, the fine one starts from its solution.

use crate::assembly::Block;
use crate::cell::Cell;
use crate::error::{positive, whole, KernelError};
use crate::memory::{History, Maxwell};
use crate::newton::{Ending, Limits, Problem, Report, State};
use crate::outcome::Outcome;
use crate::wave::Wave;

/// Inputs in SI units (shear moduli).
#[derive(Debug, Clone)]
pub struct Scale {
    pub equilibrium_modulus: f64,
    pub moduli: Vec<f64>,
    pub relaxation_times: Vec<f64>,
    pub bulk_modulus: f64,
    pub wavelength: f64,
    pub amplitude: f64,
    pub pressure: f64,
    /// Zero is static: the relaxed rubber.
    pub speed: f64,
    pub load_time: f64,
    /// Depth of the block in wavelengths.
    pub depth: f64,
    pub columns: usize,
    pub rows: usize,
    pub order: usize,
    pub limits: Limits,
}

#[derive(Debug, Clone)]
pub struct Solution {
    pub report: Report,
    pub outcome: Outcome,
    pub load_steps: usize,
    pub total_iterations: usize,
    /// Pressure that was reached over the pressure asked for.
    pub load_reached: f64,
    /// Approach of wave and block in wavelengths.
    pub approach: f64,
    /// Stress unit of the outcome [Pa].
    pub stress_unit: f64,
    /// Deformed node positions in wavelengths, layer by layer: (x, z).
    pub mesh: Vec<Vec<(f64, f64)>>,
}

impl Scale {
    fn check(&self) -> Result<(), KernelError> {
        positive("equilibrium_modulus", self.equilibrium_modulus)?;
        positive("bulk_modulus", self.bulk_modulus)?;
        positive("wavelength", self.wavelength)?;
        positive("amplitude", self.amplitude)?;
        positive("pressure", self.pressure)?;
        positive("depth", self.depth)?;
        positive("tolerance", self.limits.tolerance)?;
        positive("step", self.limits.step)?;
        whole("iterations", self.limits.iterations, 1, 1000)?;
        if !(self.speed.is_finite() && self.speed >= 0.0) {
            return Err(KernelError::Negative {
                name: "speed",
                allowed: " and finite",
                value: self.speed,
            });
        }
        if self.load_time.is_nan() || self.load_time < 0.0 {
            return Err(KernelError::Negative {
                name: "load_time",
                allowed: " (infinity is allowed)",
                value: self.load_time,
            });
        }
        if self.moduli.len() != self.relaxation_times.len() {
            return Err(KernelError::LengthMismatch {
                moduli: self.moduli.len(),
                times: self.relaxation_times.len(),
            });
        }
        for &modulus in &self.moduli {
            positive("moduli", modulus)?;
        }
        for &time in &self.relaxation_times {
            positive("relaxation_times", time)?;
        }
        Ok(())
    }

    /// The rubber with times in passages and moduli in Pa.
    fn maxwell(&self) -> Maxwell {
        let moving = self.speed > 0.0;
        Maxwell {
            equilibrium: self.equilibrium_modulus,
            moduli: if moving {
                self.moduli.clone()
            } else {
                Vec::new()
            },
            times: if moving {
                let passage = self.wavelength / self.speed;
                self.relaxation_times.iter().map(|t| t / passage).collect()
            } else {
                Vec::new()
            },
        }
    }

    pub fn solve(&self) -> Result<Solution, KernelError> {
        self.check()?;
        let mut maxwell = self.maxwell();
        // Stresses in units of the modulus that the wave meets.
        let unit = maxwell.magnitude(std::f64::consts::TAU);
        maxwell.equilibrium /= unit;
        for modulus in &mut maxwell.moduli {
            *modulus /= unit;
        }
        let fine = Cell::new(self.order, self.columns, self.rows, self.depth)?;
        let march = March {
            scale: self,
            maxwell: &maxwell,
            bulk_modulus: self.bulk_modulus / unit,
            wave: Wave {
                amplitude: self.amplitude / self.wavelength,
            },
            load: self.pressure / unit,
        };
        let mut count = Count::default();
        let mut state = State::at_rest(&fine);
        let mut report = None;
        if let Some(coarse) = coarse_cell(&fine)? {
            let mut start = State::at_rest(&coarse);
            let walked = march.walk(&coarse, &mut start, &mut count);
            if walked.ending == Ending::Converged {
                state = transfer(&coarse, &start, &fine);
                let direct = march.direct(&fine, &mut state, &mut count);
                report = (direct.ending == Ending::Converged).then_some(direct);
            }
        }
        let report = match report {
            Some(report) => report,
            None => {
                state = State::at_rest(&fine);
                count.load_reached = 0.0;
                march.walk(&fine, &mut state, &mut count)
            }
        };
        let history = march.history(&fine);
        let problem = march.problem(&fine, &history);
        Ok(Solution {
            report,
            outcome: Outcome::of(&problem, &state),
            load_steps: count.steps,
            total_iterations: count.iterations,
            load_reached: count.load_reached,
            approach: state.approach,
            stress_unit: unit,
            mesh: deformed(&fine, &state),
        })
    }
}

#[derive(Debug, Default)]
struct Count {
    steps: usize,
    iterations: usize,
    load_reached: f64,
}

/// The march of the pressure on one cell, in dimensionless units.
struct March<'a> {
    scale: &'a Scale,
    maxwell: &'a Maxwell,
    bulk_modulus: f64,
    wave: Wave,
    load: f64,
}

const FIRST_FRACTION: f64 = 0.02;
const FIRST_GROWTH: f64 = 3.0;
const MAX_STEPS: usize = 400;
const SMALLEST_GROWTH: f64 = 1.0005;

impl March<'_> {
    fn history(&self, cell: &Cell) -> History {
        if self.maxwell.moduli.is_empty() {
            return History::relaxed(self.maxwell.equilibrium);
        }
        let passages = self.scale.load_time * self.scale.speed / self.scale.wavelength;
        History::sliding(cell.columns, self.maxwell, passages)
    }

    fn problem<'c>(&self, cell: &'c Cell, history: &'c History) -> Problem<'c> {
        Problem {
            block: Block {
                cell,
                history,
                bulk_modulus: self.bulk_modulus,
            },
            wave: self.wave,
        }
    }

    fn direct(&self, cell: &Cell, state: &mut State, count: &mut Count) -> Report {
        let history = self.history(cell);
        let report = self
            .problem(cell, &history)
            .solve(state, self.load, &self.scale.limits);
        count.iterations += report.iterations;
        count.steps += 1;
        report
    }

    /// Raise the load from a small-strain start to the full one.
    fn walk(&self, cell: &Cell, state: &mut State, count: &mut Count) -> Report {
        let history = self.history(cell);
        let problem = self.problem(cell, &history);
        // Full-contact pressure of the half-plane for |G*|, 2 pi G A / (1 - nu) with nu = 1/2.
        let full = 4.0 * std::f64::consts::PI * self.wave.amplitude;
        let mut load = self.load.min(FIRST_FRACTION * full);
        let mut growth = FIRST_GROWTH;
        let mut reached = 0.0;
        let mut last = Report {
            ending: Ending::IterationLimit,
            iterations: 0,
            residual: f64::INFINITY,
        };
        for _ in 0..MAX_STEPS {
            let mut trial = state.clone();
            let report = problem.solve(&mut trial, load, &self.scale.limits);
            count.iterations += report.iterations;
            count.steps += 1;
            last = report;
            if report.ending == Ending::Converged {
                *state = trial;
                reached = load;
                count.load_reached = reached / self.load;
                if load >= self.load {
                    return report;
                }
                if report.iterations <= 6 {
                    growth = growth.powf(1.5).min(FIRST_GROWTH);
                }
                load = (load * growth).min(self.load);
            } else if reached == 0.0 {
                load *= 0.3;
                if load < 1e-6 * self.load.min(full) {
                    return report;
                }
            } else {
                growth = (load / reached).min(growth).powf(0.35);
                if growth < SMALLEST_GROWTH {
                    return report;
                }
                load = (reached * growth).min(self.load);
            }
        }
        last
    }
}

/// A cell of half the resolution, if the fine one is large enough to be worth it.
fn coarse_cell(fine: &Cell) -> Result<Option<Cell>, KernelError> {
    let nodes = fine.layer_nodes();
    if nodes < 64 || fine.rows < 6 {
        return Ok(None);
    }
    let columns = (fine.columns / 2).max(4);
    let rows = (2 * fine.rows / 3).max(4);
    Cell::new(fine.order, columns, rows, fine.depth).map(Some)
}

/// Carry a solution over to another cell.
fn transfer(from: &Cell, state: &State, to: &Cell) -> State {
    let mut out = State::at_rest(to);
    let heights = to.layer_heights();
    let nodes = to.layer_nodes();
    for (layer, &z) in heights.iter().enumerate().take(to.layers() - 1) {
        for node in 0..nodes {
            let u = from.interpolate(&state.field.u, node as f64 * to.node_spacing(), z);
            let at = layer * to.layer_size();
            out.field.u[at + to.place(node, 0)] = u[0];
            out.field.u[at + to.place(node, 1)] = u[1];
        }
    }
    out.approach = state.approach;
    transfer_pressure(from, state, to, &mut out);
    let ratio = from.layer_nodes() as f64 / nodes as f64;
    for node in 0..nodes {
        let source = (node as f64 * ratio).round() as usize % from.layer_nodes();
        out.active[node] = state.active[source];
        out.force[node] = state.force[source] * ratio;
    }
    out
}

fn transfer_pressure(from: &Cell, state: &State, to: &Cell, out: &mut State) {
    let middle = |cell: &Cell| -> Vec<f64> {
        let mut base = 0.0;
        cell.row_height
            .iter()
            .map(|h| {
                base += h;
                base - 0.5 * h
            })
            .collect()
    };
    let source_rows = middle(from);
    for (row, z) in middle(to).iter().enumerate() {
        let nearest = (0..from.rows)
            .min_by(|&a, &b| {
                (source_rows[a] - z)
                    .abs()
                    .total_cmp(&(source_rows[b] - z).abs())
            })
            .unwrap_or(0);
        for column in 0..to.columns {
            let source = (2 * column + 1) * from.columns / (2 * to.columns);
            let value = state.field.pressure[(nearest * from.columns + source) * from.modes()];
            out.field.pressure[(row * to.columns + column) * to.modes()] = value;
        }
    }
}

fn deformed(cell: &Cell, state: &State) -> Vec<Vec<(f64, f64)>> {
    cell.layer_heights()
        .iter()
        .enumerate()
        .map(|(layer, &z)| {
            (0..=cell.layer_nodes())
                .map(|node| {
                    let at = layer * cell.layer_size();
                    (
                        node as f64 * cell.node_spacing() + state.field.u[at + cell.place(node, 0)],
                        z - state.approach + state.field.u[at + cell.place(node, 1)],
                    )
                })
                .collect()
        })
        .collect()
}
