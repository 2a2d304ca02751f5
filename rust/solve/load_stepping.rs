//! Load stepping: the pressure is raised on one mesh from small strain, step by step.
//!
//! The step grows after an easy success and is cut after a failure. All in dimensionless units.

use super::newton;
use crate::contact::{PressedBlock, State};
use crate::settings::Settings;
use crate::solution::{Counts, Report};
use crate::status::Status;

/// Raise the load on `state`, which is at rest, to `load`; also returns the share of it that was reached.
pub fn raise(
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
    settings: &Settings,
    counts: &mut Counts,
) -> (Report, f64) {
    let full = pressed.heights.full_contact_pressure();
    let mut next = load.min(settings.first_load * full);
    let mut growth = settings.largest_growth;
    let mut reached = 0.0;
    let (mut spent, mut steps) = (0, 0);
    loop {
        let mut trial = state.clone();
        let mut report = newton::solve(pressed, &mut trial, next, settings);
        counts.add(&report);
        counts.load_steps += 1;
        spent += report.iterations;
        steps += 1;
        if report.status == Status::Converged {
            *state = trial;
            reached = next;
            if reached >= load {
                return (report, 1.0);
            }
            if report.iterations <= settings.easy_iterations {
                growth = growth.powf(settings.growth_gain).min(settings.largest_growth);
            }
            next = (reached * growth).min(load);
        } else if report.status.interrupts() {
            return (report, reached / load);
        } else if reached == 0.0 {
            next *= settings.first_load_cut;
        } else {
            growth = (next / reached).min(growth).powf(settings.growth_cut);
            next = (reached * growth).min(load);
        }
        let stuck = reached > 0.0 && growth < settings.smallest_growth;
        let hopeless = reached == 0.0 && next < settings.smallest_first_load * load.min(full);
        let spent_all = spent >= settings.iteration_budget || steps >= settings.most_load_steps;
        if stuck || hopeless || spent_all {
            if report.status == Status::Converged {
                report.status = Status::IterationLimit;
            } else if stuck {
                report.status = Status::Fold;
            }
            return (report, reached / load);
        }
    }
}
