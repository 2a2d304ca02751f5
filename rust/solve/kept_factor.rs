//! Newton's method with a factor that is kept from iteration to iteration, and from one time step to the
//! next, as long as the active set stays the same and residuals fall fast enough.
//!
//! In the frame of the profile a contact nearly stands still, so that one factor serves a step or two
//! (chord method: Kelley, "Iterative Methods for Linear and Nonlinear Equations" (1995), section 5.4).

use super::bordered::{Bordered, Tangent};
use super::newton::{self, LongStep};
use crate::contact::{PressedBlock, State};
use crate::settings::Settings;
use crate::solution::Report;
use crate::status::Status;

/// A tangent that reduces the residual by less than this factor is factored again.
const WORTH_KEEPING: f64 = 0.3;

/// Share of the residual tolerance to which is iterated: residuals fall by a factor an iteration and would
/// end just below the tolerance, while those of Newton's method end far below it.
const SHARE_OF_TOLERANCE: f64 = 0.1;

pub struct KeptFactor {
    bordered: Bordered,
    tangent: Option<Tangent>,
    /// State from which the last time step started.
    last_start: Option<State>,
}

impl KeptFactor {
    /// Nothing kept yet; None if memory does not suffice, or if the mesh has too many nodes along the wave
    /// for factors to pay.
    pub fn new(pressed: &PressedBlock<'_>, settings: &Settings) -> Option<Self> {
        let pays = pressed.mesh().layer_nodes() <= settings.kept_factor_nodes;
        let bordered = pays.then(|| Bordered::new(&pressed.block)).flatten()?;
        Some(Self { bordered, tangent: None, last_start: None })
    }

    /// Forget the last time step, because the next one does not continue its motion.
    pub fn forget_last_step(&mut self) {
        self.last_start = None;
    }

    /// Iterate on `state` under `load` with a known memory, from the extrapolation of the last time step;
    /// gives up where a Newton step is too long.
    pub fn solve(
        &mut self,
        pressed: &PressedBlock<'_>,
        state: &mut State,
        load: f64,
        settings: &Settings,
    ) -> Report {
        let last = self.last_start.replace(state.clone());
        if let Some(last) = last.filter(|last| last.active_set == state.active_set) {
            extrapolate(state, &last);
        }
        let mut before = f64::INFINITY;
        let settings = &Settings {
            residual_tolerance: SHARE_OF_TOLERANCE * settings.residual_tolerance,
            ..*settings
        };
        let bordered = &self.bordered;
        let tangent = &mut self.tangent;
        newton::iterate(pressed, state, load, settings, LongStep::GiveUp, |iterate| {
            let last = std::mem::replace(&mut before, iterate.residual_norm);
            let serves = tangent.as_ref().is_some_and(|tangent| {
                tangent.active_set == iterate.state.active_set
                    && iterate.residual_norm < WORTH_KEEPING * last
            });
            if !serves {
                *tangent = None;
                *tangent = Some(bordered.factor(
                    pressed,
                    iterate.state,
                    iterate.rows,
                    iterate.residual,
                )?);
            }
            let tangent = tangent.as_ref().ok_or(Status::NotFinite)?;
            let increment =
                bordered.increment(pressed, tangent, iterate.state, iterate.residual, load);
            if increment.contact.active_set != iterate.state.active_set {
                before = f64::INFINITY;
            }
            Ok(increment)
        })
    }
}

/// Repeat the change from `last` to `state`, with the same active set.
fn extrapolate(state: &mut State, last: &State) {
    let (field, from) = (&mut state.field, &last.field);
    let unknowns = field.u.iter_mut().chain(&mut field.pressure);
    for (value, last) in unknowns.zip(from.u.iter().chain(&from.pressure)) {
        *value += *value - last;
    }
    for (value, last) in state.force.iter_mut().zip(&last.force) {
        *value = (2.0 * *value - last).max(0.0);
    }
    state.approach += state.approach - last.approach;
}
