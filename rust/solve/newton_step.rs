//! What a Newton step starts from and what it adds.

use super::residual::Residual;
use crate::contact::complementarity_problem::Contact;
use crate::contact::State;
use crate::fem::block::RowState;

/// The state from which a Newton step starts, with its residual.
#[derive(Clone, Copy)]
pub struct Iterate<'a> {
    pub state: &'a State,
    /// States of the element rows.
    pub rows: &'a [RowState],
    pub residual: &'a Residual,
    pub residual_norm: f64,
}

/// What a Newton step adds to the field, and the contact at its end.
#[derive(Debug, Clone)]
pub struct Increment {
    /// Displacements of all layers, as in a field.
    pub u: Vec<f64>,
    /// Pressure modes, as in a field.
    pub pressure: Vec<f64>,
    /// At the end of the whole step.
    pub contact: Contact,
    /// Products with the Jacobian.
    pub products: usize,
}
