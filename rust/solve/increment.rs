//! What a Newton step starts from and what it adds.

use super::balance::Balance;
use crate::contact::touching::Contact;
use crate::contact::State;
use crate::fem::block::RowState;

/// A state on the way, with what it leaves out of balance.
#[derive(Clone, Copy)]
pub struct Now<'a> {
    pub state: &'a State,
    /// States of its rows.
    pub rows: &'a [RowState],
    pub balance: &'a Balance,
    pub residual: f64,
}

/// What is added to the fields, and the contact that it leads to.
#[derive(Debug, Clone)]
pub struct Increment {
    /// Of the displacements, all layers, and of the pressure modes, both as in a field.
    pub u: Vec<f64>,
    pub pressure: Vec<f64>,
    /// At the end of the whole step.
    pub contact: Contact,
    /// Products with the Jacobian that it took.
    pub products: usize,
}
