//! Mooney and Rivlin: W = (1 - s)/2 (I1 - 3) + s/2 (I2 - 3).
//!
//! M. Mooney, J. Appl. Phys. 11 (1940) 582; R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379.

use super::{parameter, Invariants, Parameters, StrainEnergy};
use crate::error::{not_negative, KernelError};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MooneyRivlin {
    /// Share s of the second invariant in the small-strain modulus, 0 to 1.
    share: f64,
}

impl StrainEnergy for MooneyRivlin {
    const NAME: &'static str = "mooney_rivlin";
    const PARAMETERS: &'static [&'static str] = &["share"];

    fn new(parameters: &Parameters) -> Result<Self, KernelError> {
        let share = parameter::<Self>(parameters, "share")?;
        not_negative("share", share, 1.0, " and at most 1").map(|share| Self { share })
    }

    fn density(&self, [i1, i2]: Invariants) -> f64 {
        0.5 * (1.0 - self.share) * (i1 - 3.0) + 0.5 * self.share * (i2 - 3.0)
    }

    fn slopes(&self, _: Invariants) -> [f64; 2] {
        [0.5 * (1.0 - self.share), 0.5 * self.share]
    }

    fn curvatures(&self, _: Invariants) -> [f64; 3] {
        [0.0; 3]
    }
}
