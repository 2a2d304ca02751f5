//! Load stepping: the pressure is raised on one mesh from small strain, step by step.
//!
//! The step grows after an easy success and is cut after a failure. All in dimensionless units.

use super::newton;
use crate::contact::{PressedBlock, State};
use crate::settings::Settings;
use crate::solution::{Counts, Report};
use crate::status::Status;

/// First load over that of full contact: contact a tenth of the wave, small strain. One that fails is tried
/// again at the share `FIRST_LOAD_CUT`, but none below `SMALLEST_FIRST_LOAD` of the load or of full contact.
const FIRST_LOAD: f64 = 0.02;
const FIRST_LOAD_CUT: f64 = 0.3;
const SMALLEST_FIRST_LOAD: f64 = 1e-7;
/// Largest ratio of a load to the one before; a path that needs less than the smallest has reached a fold.
const LARGEST_GROWTH: f64 = 3.0;
const SMALLEST_GROWTH: f64 = 1.001;
/// Powers that raise the ratio after an easy load step, and reduce it after one that failed.
const GROWTH_GAIN: f64 = 1.5;
const GROWTH_CUT: f64 = 0.4;
/// Newton iterations of an easy load step.
pub const EASY_ITERATIONS: usize = 7;
/// Load steps while the load is raised once.
const MOST_STEPS: usize = 300;

/// Raise the load on `state`, which is at rest, to `load`, or as far as possible.
pub fn raise(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
    counts: &mut Counts,
) -> Report {
    let full = pressed.heights.full_contact_pressure();
    let mut next = load.min(FIRST_LOAD * full);
    let mut growth = LARGEST_GROWTH;
    let mut reached = 0.0;
    let (mut spent, mut steps) = (0, 0);
    loop {
        // Solve for the next load.
        let mut trial = state.clone();
        let mut report = newton::solve(pressed, &mut trial, next, settings);
        counts.add(&report);
        spent += report.iterations;
        steps += 1;
        // Choose the load after it.
        if report.status == Status::Converged {
            *state = trial;
            reached = next;
            if reached >= load {
                return report;
            }
            if report.iterations <= EASY_ITERATIONS {
                growth = growth.powf(GROWTH_GAIN).min(LARGEST_GROWTH);
            }
            next = (reached * growth).min(load);
        } else if report.status.interrupts() {
            return Report { load_reached: reached / load, ..report };
        } else if reached == 0.0 {
            next *= FIRST_LOAD_CUT;
        } else {
            growth = (next / reached).min(growth).powf(GROWTH_CUT);
            next = (reached * growth).min(load);
        }
        // Give up at a fold, without a first load, or with the budget spent.
        let stuck = reached > 0.0 && growth < SMALLEST_GROWTH;
        let hopeless = reached == 0.0 && next < SMALLEST_FIRST_LOAD * load.min(full);
        let spent_all = spent >= settings.iteration_budget || steps >= MOST_STEPS;
        if stuck || hopeless || spent_all {
            if report.status == Status::Converged {
                report.status = Status::IterationLimit;
            } else if stuck {
                report.status = Status::Fold;
            }
            return Report { load_reached: reached / load, ..report };
        }
    }
}
