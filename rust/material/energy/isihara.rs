//! Isihara, Hashitsume and Tatibana: W = 1/2 ((1 - s) (I1 - 3) + s (I2 - 3) + c2 (I1 - 3)^2).
//!
//! A. Isihara, N. Hashitsume and M. Tatibana, J. Chem. Phys. 19 (1951) 1508.

use super::{parameter, Invariants, Parameters, StrainEnergy};
use crate::error::{not_negative, KernelError};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isihara {
    /// Share s of the second invariant in the small-strain modulus, 0 to 1.
    share: f64,
    /// Coefficient c2 over half the shear modulus.
    second: f64,
}

impl StrainEnergy for Isihara {
    const NAME: &'static str = "isihara";
    const PARAMETERS: &'static [&'static str] = &["share", "second"];

    fn new(parameters: &Parameters) -> Result<Self, KernelError> {
        let share = parameter::<Self>(parameters, "share")?;
        Ok(Self {
            share: not_negative("share", share, 1.0, " and at most 1")?,
            second: parameter::<Self>(parameters, "second")?,
        })
    }

    fn density(&self, [i1, i2]: Invariants) -> f64 {
        let (a, b) = (i1 - 3.0, i2 - 3.0);
        0.5 * ((1.0 - self.share) * a + self.share * b + self.second * a * a)
    }

    fn slopes(&self, [i1, _]: Invariants) -> [f64; 2] {
        let first = 0.5 * (1.0 - self.share) + self.second * (i1 - 3.0);
        [first, 0.5 * self.share]
    }

    fn curvatures(&self, _: Invariants) -> [f64; 3] {
        [self.second, 0.0, 0.0]
    }
}
