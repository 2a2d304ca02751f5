//! The work on one cell of a ladder, and what two cells tell of the error.

use std::f64::consts::TAU;

use crate::assembly::{Block, Memory};
use crate::cell::Cell;
use crate::march::{climb, Count};
use crate::memory::{History, Maxwell};
use crate::newton::{Ending, Problem, Report, State};
use crate::outcome::{EdgeLaw, Outcome};
use crate::scale::{Scale, Solution};
use crate::transfer::transfer;
use crate::wave::Wave;

/// Both contact edges together are known to about this many node spacings.
const EDGE_ERROR: f64 = 0.15;

/// The contact fraction converges unevenly, by the edges' places between the nodes.
const SAFETY: f64 = 1.5;

/// A cell with what was found on it.
#[derive(Clone)]
pub struct Level {
    cell: Cell,
    state: State,
    pub report: Report,
    outcome: Outcome,
}

/// The work on one scale, in dimensionless units.
pub struct Ladder<'a> {
    scale: &'a Scale,
    maxwell: Maxwell,
    unit: f64,
    count: Count,
    load_reached: f64,
}

impl<'a> Ladder<'a> {
    pub fn new(scale: &'a Scale, maxwell: Maxwell, unit: f64) -> Self {
        Self {
            scale,
            maxwell,
            unit,
            count: Count::default(),
            load_reached: 0.0,
        }
    }

    fn memory(&self, cell: &Cell) -> Memory {
        if self.maxwell.moduli.is_empty() {
            return Memory::Relaxed;
        }
        let passages = self.scale.load_time * self.scale.speed / self.scale.wavelength;
        Memory::Sliding(History::sliding(cell.columns, &self.maxwell, passages))
    }

    /// The modulus that a wave of four node spacings meets.
    fn edge_law(&self, cell: &Cell) -> EdgeLaw {
        let omega = TAU * cell.layer_nodes() as f64 / 4.0;
        let (storage, loss) = self.maxwell.complex_modulus(omega);
        EdgeLaw::new(storage, loss, true)
    }

    /// Solve on `cell`: from the coarser cell, else from `start`, else by the march.
    pub fn solve_on(
        &mut self,
        cell: &Cell,
        coarse: Option<&Level>,
        start: Option<&Solution>,
    ) -> Level {
        let memory = self.memory(cell);
        let problem = Problem {
            block: Block {
                cell,
                energy: self.scale.energy,
                equilibrium: self.maxwell.equilibrium,
                memory: &memory,
                bulk_modulus: self.scale.bulk_modulus / self.unit,
            },
            wave: Wave {
                amplitude: self.scale.amplitude / self.scale.wavelength,
            },
        };
        let load = self.scale.pressure / self.unit;
        let limits = &self.scale.limits;
        let guess = match (coarse, start) {
            (Some(level), _) => Some(transfer(&level.cell, &level.state, cell, 1.0)),
            (None, Some(other)) => {
                let stress = other.stress_unit / self.unit;
                Some(transfer(&other.cell, &other.state, cell, stress))
            }
            (None, None) => None,
        };
        if let Some(mut state) = guess {
            let report = problem.solve(&mut state, load, limits);
            self.count.iterations += report.iterations;
            self.count.steps += 1;
            if report.ending == Ending::Converged {
                self.load_reached = 1.0;
                let outcome = Outcome::of(&problem, &state, self.edge_law(cell));
                return Level {
                    cell: cell.clone(),
                    state,
                    report,
                    outcome,
                };
            }
        }
        let mut state = State::at_rest(cell);
        let (report, reached) = climb(&problem, &mut state, load, limits, &mut self.count);
        self.load_reached = reached;
        let outcome = Outcome::of(&problem, &state, self.edge_law(cell));
        Level {
            cell: cell.clone(),
            state,
            report,
            outcome,
        }
    }

    pub fn finish(&self, level: Level, coarse: Option<&Level>) -> Solution {
        let (contact_fraction_error, friction_error) = errors(&level, coarse);
        Solution {
            report: level.report,
            outcome: level.outcome,
            count: self.count,
            load_reached: self.load_reached,
            contact_fraction_error,
            friction_error,
            stress_unit: self.unit,
            cell: level.cell,
            state: level.state,
        }
    }
}

/// Errors from the change since the cell of half the resolution, never below what the contact
/// edges and the two friction measures leave open.
fn errors(level: &Level, coarse: Option<&Level>) -> (f64, f64) {
    let Some(coarse) = coarse else {
        return (f64::NAN, f64::NAN);
    };
    let (fine, rough) = (&level.outcome, &coarse.outcome);
    let full = fine.contact_fraction == 1.0 && rough.contact_fraction == 1.0;
    let edges = if full {
        0.0
    } else {
        EDGE_ERROR * level.cell.node_spacing()
    };
    let fraction = (fine.contact_fraction - rough.contact_fraction).abs();
    let change = (fine.friction - rough.friction).abs();
    let mismatch = (fine.friction - fine.friction_from_dissipation).abs();
    (SAFETY * fraction.max(edges), change.max(mismatch))
}
