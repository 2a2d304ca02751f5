//! The march of the pressure on one cell: raised from a small-strain start, step by step.
//!
//! The step grows after an easy success and is cut after a failure. All in dimensionless units.

use crate::newton::{Ending, Limits, Problem, Report, State};

/// First pressure over the full-contact pressure: contact a tenth of the wave, small strain.
const FIRST_FRACTION: f64 = 0.02;
const LARGEST_GROWTH: f64 = 3.0;
/// A march whose steps must be smaller than this stands at a fold.
const SMALLEST_GROWTH: f64 = 1.001;
/// Load steps of one march: a bound where no iteration is ever begun.
const MOST_STEPS: usize = 300;
/// Newton iterations of an easy step.
const EASY: usize = 7;

#[derive(Debug, Default, Clone, Copy)]
pub struct Count {
    pub steps: usize,
    pub iterations: usize,
}

/// Raise the load on `state`, at rest before, to `load`; returns the share of it that was reached.
pub fn climb(
    problem: &Problem<'_>,
    state: &mut State,
    load: f64,
    limits: &Limits,
    count: &mut Count,
) -> (Report, f64) {
    // Full-contact pressure of the half-plane for nu = 1/2 and unit modulus, 4 pi A.
    let full = 4.0 * std::f64::consts::PI * problem.wave.amplitude;
    let mut next = load.min(FIRST_FRACTION * full);
    let mut growth = LARGEST_GROWTH;
    let mut reached = 0.0;
    let (mut spent, mut steps) = (0, 0);
    loop {
        let mut trial = state.clone();
        let mut report = problem.solve(&mut trial, next, limits);
        count.iterations += report.iterations;
        count.steps += 1;
        spent += report.iterations;
        steps += 1;
        if report.ending == Ending::Converged {
            *state = trial;
            reached = next;
            if reached >= load {
                return (report, 1.0);
            }
            if report.iterations <= EASY {
                growth = growth.powf(1.5).min(LARGEST_GROWTH);
            }
            next = (reached * growth).min(load);
        } else if reached == 0.0 {
            next *= 0.3;
        } else {
            growth = (next / reached).min(growth).powf(0.4);
            next = (reached * growth).min(load);
        }
        let stuck = reached > 0.0 && growth < SMALLEST_GROWTH;
        let hopeless = reached == 0.0 && next < 1e-7 * load.min(full);
        if stuck || hopeless || spent >= limits.budget || steps >= MOST_STEPS {
            if report.ending == Ending::Converged {
                report.ending = Ending::IterationLimit;
            } else if stuck {
                report.ending = Ending::Fold;
            }
            return (report, reached / load);
        }
    }
}
