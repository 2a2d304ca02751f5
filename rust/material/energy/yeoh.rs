//! Yeoh: W = 1/2 (I + c2 I^2 + c3 I^3) with I = I1 - 3.
//!
//! O. H. Yeoh, Rubber Chem. Technol. 66 (1993) 754.

use super::{parameter, Invariants, Parameters, StrainEnergy};
use crate::error::KernelError;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yeoh {
    /// Coefficients c2 and c3 over half the shear modulus.
    second: f64,
    third: f64,
}

impl StrainEnergy for Yeoh {
    const NAME: &'static str = "yeoh";
    const PARAMETERS: &'static [&'static str] = &["second", "third"];

    fn new(parameters: &Parameters) -> Result<Self, KernelError> {
        Ok(Self {
            second: parameter::<Self>(parameters, "second")?,
            third: parameter::<Self>(parameters, "third")?,
        })
    }

    fn density(&self, [i1, _]: Invariants) -> f64 {
        let i = i1 - 3.0;
        0.5 * (i + self.second * i.powi(2) + self.third * i.powi(3))
    }

    fn slopes(&self, [i1, _]: Invariants) -> [f64; 2] {
        let i = i1 - 3.0;
        [0.5 * (1.0 + 2.0 * self.second * i + 3.0 * self.third * i * i), 0.0]
    }

    fn curvatures(&self, [i1, _]: Invariants) -> [f64; 3] {
        let i = i1 - 3.0;
        [0.5 * (2.0 * self.second + 6.0 * self.third * i), 0.0, 0.0]
    }
}
