//! One scale, from inputs in SI units to the solution: static contact or steady sliding.
//!
//! A ladder of cells, each twice as fine as the one before: the coarsest walks the pressure march,
//! every finer one starts from its predecessor's solution. The last two tell the discretisation
//! error; with a tolerance given the ladder goes on until they agree well enough.

use std::f64::consts::TAU;

use crate::cell::{Cell, MAX_COLUMNS, MAX_ROWS};
use crate::error::{positive, whole, KernelError};
use crate::hyperelastic::Energy;
use crate::ladder::{Ladder, Level};
use crate::march::Count;
use crate::memory::Maxwell;
use crate::newton::{Ending, Limits, Report, State};
use crate::outcome::Outcome;

/// Fewest nodes along the wave on the coarsest cell of a ladder.
const COARSEST: usize = 32;
/// Rows grow by 1.5 for every doubling of the columns.
const ROW_EXPONENT: f64 = 0.585;
/// Inputs in SI units (shear moduli).
#[derive(Debug, Clone)]
pub struct Scale {
    pub energy: Energy,
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
    /// Elements along and across the finest cell, or with a tolerance the ratio of the two.
    pub columns: usize,
    pub rows: usize,
    pub order: usize,
    /// Largest estimated error, relative in friction and absolute in contact fraction.
    pub tolerance: Option<f64>,
    pub limits: Limits,
}

/// A solved wave; also the start of another.
#[derive(Debug, Clone)]
pub struct Solution {
    pub report: Report,
    pub outcome: Outcome,
    pub count: Count,
    /// Pressure that was reached over the pressure asked for.
    pub load_reached: f64,
    /// Estimated discretisation errors, NaN where there is only one mesh to judge from.
    pub contact_fraction_error: f64,
    pub friction_error: f64,
    /// Stress unit of the outcome and the state [Pa].
    pub stress_unit: f64,
    pub cell: Cell,
    pub state: State,
}

impl Scale {
    pub(crate) fn check(&self) -> Result<(), KernelError> {
        positive("equilibrium_modulus", self.equilibrium_modulus)?;
        positive("bulk_modulus", self.bulk_modulus)?;
        positive("wavelength", self.wavelength)?;
        positive("amplitude", self.amplitude)?;
        positive("pressure", self.pressure)?;
        positive("depth", self.depth)?;
        positive("residual_tolerance", self.limits.tolerance)?;
        positive("step", self.limits.step)?;
        positive("tolerance", self.tolerance.unwrap_or(1.0))?;
        whole("iterations", self.limits.iterations, 1, 1000)?;
        not_negative("speed", " and finite", self.speed, f64::MAX)?;
        not_negative(
            "load_time",
            " (infinity is allowed)",
            self.load_time,
            f64::INFINITY,
        )?;
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
        self.check_energy()
    }

    fn check_energy(&self) -> Result<(), KernelError> {
        match self.energy {
            Energy::NeoHookean => Ok(()),
            Energy::MooneyRivlin { share } => {
                not_negative("share", " and at most 1", share, 1.0).map(|_| ())
            }
            Energy::Yeoh { second, third } => [("second", second), ("third", third)]
                .into_iter()
                .try_for_each(|(name, value)| {
                    let finite = value.is_finite();
                    finite
                        .then_some(())
                        .ok_or(KernelError::NotFinite { name, value })
                }),
        }
    }

    /// The rubber in motion, with times in passages and moduli in Pa; at rest it is relaxed.
    fn maxwell(&self) -> Maxwell {
        let passage = self.wavelength / self.speed;
        let moving = self.speed > 0.0;
        let memory = self.moduli.iter().zip(&self.relaxation_times);
        let (moduli, times) = memory
            .filter(|_| moving)
            .map(|(modulus, time)| (modulus, time / passage))
            .unzip();
        Maxwell {
            equilibrium: self.equilibrium_modulus,
            moduli,
            times,
        }
    }

    pub fn solve(&self, start: Option<&Solution>) -> Result<Solution, KernelError> {
        self.check()?;
        let mut maxwell = self.maxwell();
        // Stresses in units of the modulus that the wave meets.
        let unit = maxwell.magnitude(TAU);
        maxwell.equilibrium /= unit;
        maxwell.moduli.iter_mut().for_each(|g| *g /= unit);
        let mut climber = Ladder::new(self, maxwell, unit);
        let cells = self.cells(start)?;
        let mut last: Option<Level> = None;
        let mut result = None;
        for (index, cell) in cells.iter().enumerate() {
            let level = climber.solve_on(cell, last.as_ref(), start);
            let solution = climber.finish(level.clone(), last.as_ref());
            let solved = level.report.ending == Ending::Converged;
            let met = self
                .tolerance
                .is_some_and(|tolerance| solution.meets(tolerance));
            let is_last = index + 1 == cells.len();
            result = Some(solution);
            if solved && met {
                break;
            }
            if is_last && solved && self.tolerance.is_some() {
                if let Some(solution) = &mut result {
                    solution.report.ending = Ending::ToleranceNotMet;
                }
            }
            last = solved.then_some(level);
        }
        // `cells` is never empty: the finest one always is among them.
        result.ok_or(KernelError::NotPositive {
            name: "columns",
            value: self.columns as f64,
        })
    }

    /// The ladder, coarsest first: up to the mesh asked for, or with a tolerance beyond it.
    fn cells(&self, start: Option<&Solution>) -> Result<Vec<Cell>, KernelError> {
        let finest = Cell::new(self.order, self.columns, self.rows, self.depth)?;
        let mut columns = vec![self.columns];
        while columns[0] % 4 == 0 && self.order * columns[0] / 2 >= COARSEST {
            columns.insert(0, columns[0] / 2);
        }
        if self.tolerance.is_some() {
            while columns[columns.len() - 1] * 2 <= MAX_COLUMNS / 2 {
                columns.push(columns[columns.len() - 1] * 2);
            }
            // A neighbour that met its tolerance tells which meshes are worth a look.
            let least = start.map_or(0, |solution| solution.cell.columns / 2);
            columns.retain(|&count| count >= least);
        } else if start.is_some() {
            columns.drain(..columns.len().saturating_sub(2));
        }
        columns
            .into_iter()
            .map(|count| {
                if count == self.columns {
                    return Ok(finest.clone());
                }
                let share = (count as f64 / self.columns as f64).powf(ROW_EXPONENT);
                let rows = (share * self.rows as f64).round() as usize;
                Cell::new(self.order, count, rows.clamp(2, MAX_ROWS), self.depth)
            })
            .collect()
    }
}

fn not_negative(
    name: &'static str,
    allowed: &'static str,
    value: f64,
    most: f64,
) -> Result<f64, KernelError> {
    if (0.0..=most).contains(&value) {
        Ok(value)
    } else {
        Err(KernelError::Negative {
            name,
            allowed,
            value,
        })
    }
}

impl Solution {
    fn meets(&self, tolerance: f64) -> bool {
        let friction = self.outcome.friction.abs();
        // At rest friction is nothing but round-off.
        let friction_met = self.friction_error <= tolerance * friction || friction < 1e-9;
        friction_met && self.contact_fraction_error <= tolerance
    }

    /// Deformed node positions in wavelengths, layer by layer: (x, z).
    pub fn mesh(&self) -> Vec<Vec<(f64, f64)>> {
        let (cell, state) = (&self.cell, &self.state);
        let shift = cell.mean_shift(&state.field.u);
        let place = |layer: usize, z: f64, node: usize| {
            let at = layer * cell.layer_size();
            (
                node as f64 * cell.node_spacing() + state.field.u[at + cell.place(node, 0)] - shift,
                z - state.approach + state.field.u[at + cell.place(node, 1)],
            )
        };
        let heights = cell.layer_heights().into_iter().enumerate();
        heights
            .map(|(layer, z)| {
                (0..=cell.layer_nodes())
                    .map(|node| place(layer, z, node))
                    .collect()
            })
            .collect()
    }
}
