//! Newton's method with a factor for every iteration, without limits of its steps: the least that
//! elimination can take.

use gripscale_kernel::contact::{PressedBlock, State};
use gripscale_kernel::solve::bordered::Bordered;
use gripscale_kernel::solve::residual::Residual;

/// What the residuals of both ways end below.
const TOLERANCE: f64 = 1e-8;
const MOST_ITERATIONS: usize = 40;

/// Iterations that it took from `state` to the solution; none if it does not end.
pub fn eliminate(
    bordered: &Bordered,
    pressed: &PressedBlock<'_>,
    state: &mut State,
    load: f64,
) -> Option<usize> {
    for iteration in 0..MOST_ITERATIONS {
        let rows = pressed.row_states(&state.field).ok()?;
        let residual = Residual::new(pressed, state, &rows).ok()?;
        if residual.norm(pressed, state, load) < TOLERANCE {
            return Some(iteration);
        }
        let tangent = bordered.factor(pressed, state, &rows, &residual).ok()?;
        let step = bordered.increment(pressed, &tangent, state, &residual, load);
        let unknowns = state.field.u.iter_mut().chain(&mut state.field.pressure);
        let changes = step.u.iter().chain(&step.pressure);
        unknowns
            .zip(changes)
            .for_each(|(value, change)| *value += change);
        state.force = step.contact.force;
        state.approach = step.contact.approach;
        state.active_set = step.contact.active_set;
    }
    None
}
