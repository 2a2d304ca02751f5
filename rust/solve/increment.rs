//! What a Newton step adds to the fields, and the contact that it leads to.

use crate::contact::touching::Contact;

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
