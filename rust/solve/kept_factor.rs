//! Newton's method with a tangent that is kept: from iteration to iteration, and from one time step to
//! the next, as long as the same nodes touch and residuals fall fast enough.
//!
//! In the frame of the profile a contact nearly stands still, so that one factor serves a step or two
//! (chord method: Kelley, "Iterative Methods for Linear and Nonlinear Equations" (1995), section 5.4).

use super::bordered::{Bordered, Tangent};
use super::newton::{self, Report};
use crate::contact::{PressedBlock, State};
use crate::settings::Settings;
use crate::status::Status;

/// A tangent that leaves more of the residual than this share is made anew.
const WORTH_KEEPING: f64 = 0.3;

/// Share of the residual allowed that is asked for: residuals fall by a factor an iteration and would end
/// just below it, where Newton's own end far below.
const ITERATED_TO: f64 = 0.1;

pub struct KeptFactor {
    bordered: Bordered,
    tangent: Option<Tangent>,
    /// State from which the last step started.
    before: Option<State>,
}

impl KeptFactor {
    /// Nothing kept yet; none where there is no memory for it, or more nodes along the wave than pay.
    pub fn new(pressed: &PressedBlock<'_>, settings: &Settings) -> Option<Self> {
        let pays = pressed.mesh().layer_nodes() <= settings.kept_factor_nodes;
        let bordered = pays.then(|| Bordered::new(&pressed.block)).flatten()?;
        Some(Self {
            bordered,
            tangent: None,
            before: None,
        })
    }

    /// Forget the last step: the next one does not go on like it.
    pub fn turn(&mut self) {
        self.before = None;
    }

    /// Iterate on `state` under `load`, its memory given, from where it would come to if it went on as in
    /// the last step; gives up where a step would be cut.
    pub fn solve(
        &mut self,
        pressed: &PressedBlock<'_>,
        state: &mut State,
        load: f64,
        settings: &Settings,
    ) -> Report {
        let last = self.before.replace(state.clone());
        if let Some(last) = last.filter(|last| last.active == state.active) {
            go_on(state, &last);
        }
        let mut before = f64::INFINITY;
        let settings = &Settings {
            residual_tolerance: ITERATED_TO * settings.residual_tolerance,
            ..*settings
        };
        let bordered = &self.bordered;
        let tangent = &mut self.tangent;
        newton::iterate(pressed, state, load, settings, newton::Cut::GiveUp, |now| {
            let last = std::mem::replace(&mut before, now.residual);
            let serves = tangent.as_ref().is_some_and(|tangent| {
                tangent.active == now.state.active && now.residual < WORTH_KEEPING * last
            });
            if !serves {
                *tangent = None;
                *tangent = Some(bordered.factor(pressed, now.state, now.rows, now.balance)?);
            }
            let tangent = tangent.as_ref().ok_or(Status::NotFinite)?;
            let increment = bordered.increment(pressed, tangent, now.state, now.balance, load);
            if increment.contact.active != now.state.active {
                before = f64::INFINITY;
            }
            Ok(increment)
        })
    }
}

/// Change `state` once more as it changed from `last`, with the same nodes touching.
fn go_on(state: &mut State, last: &State) {
    let (field, from) = (&mut state.field, &last.field);
    let unknowns = field.u.iter_mut().chain(&mut field.pressure);
    for (now, last) in unknowns.zip(from.u.iter().chain(&from.pressure)) {
        *now += *now - last;
    }
    for (now, last) in state.force.iter_mut().zip(&last.force) {
        *now = (2.0 * *now - last).max(0.0);
    }
    state.approach += state.approach - last.approach;
}
