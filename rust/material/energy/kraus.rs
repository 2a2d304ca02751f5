//! Kraus: 2 W_1 = w(s) / w(0), w = r + (1 - r) / (1 + t), t = sqrt(s^2 + a^2) / c, s^2 = I1 - 3.
//!
//! The secant modulus of simple shear s is that of a strain sweep of filled rubber, with the exponent 1/2 of
//! G. Kraus, J. Appl. Polym. Sci.: Appl. Polym. Symp. 39 (1984) 75. It is smooth below a, where the small-strain
//! modulus was measured.

use super::{parameter, Invariants, Parameters, StrainEnergy};
use crate::error::{not_negative, positive, KernelError};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kraus {
    /// Modulus r at large strain over that at none.
    ratio: f64,
    /// Shear strain c at which half of what breaks is broken.
    critical: f64,
    /// Shear strain a of the measurement.
    measured_at: f64,
}

impl Kraus {
    /// t.
    fn strain(&self, i1: f64) -> f64 {
        ((i1 - 3.0).max(0.0) + self.measured_at.powi(2)).sqrt() / self.critical
    }

    /// w.
    fn kept(&self, t: f64) -> f64 {
        self.ratio + (1.0 - self.ratio) / (1.0 + t)
    }

    /// int w dI1 = c^2 int w d(t^2).
    fn integral(&self, t: f64) -> f64 {
        let broken = 2.0 * (t - t.ln_1p());
        self.critical.powi(2) * (self.ratio * t * t + (1.0 - self.ratio) * broken)
    }
}

impl StrainEnergy for Kraus {
    const NAME: &'static str = "kraus";
    const PARAMETERS: &'static [&'static str] = &["ratio", "critical", "measured_at"];

    fn new(parameters: &Parameters) -> Result<Self, KernelError> {
        let ratio = parameter::<Self>(parameters, "ratio")?;
        Ok(Self {
            ratio: not_negative("ratio", ratio, 1.0, " and at most 1")?,
            critical: positive("critical", parameter::<Self>(parameters, "critical")?)?,
            measured_at: positive("measured_at", parameter::<Self>(parameters, "measured_at")?)?,
        })
    }

    fn density(&self, [i1, _]: Invariants) -> f64 {
        let (rest, t) = (self.strain(3.0), self.strain(i1));
        0.5 * (self.integral(t) - self.integral(rest)) / self.kept(rest)
    }

    fn slopes(&self, [i1, _]: Invariants) -> [f64; 2] {
        let (rest, t) = (self.strain(3.0), self.strain(i1));
        [0.5 * self.kept(t) / self.kept(rest), 0.0]
    }

    fn curvatures(&self, [i1, _]: Invariants) -> [f64; 3] {
        let (rest, t) = (self.strain(3.0), self.strain(i1));
        // dt/dI1 = 1 / (2 c^2 t)
        let by_t = -(1.0 - self.ratio) / (1.0 + t).powi(2);
        let slope = by_t / (2.0 * self.critical.powi(2) * t);
        [0.5 * slope / self.kept(rest), 0.0, 0.0]
    }
}
