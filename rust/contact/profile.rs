//! One period of the rigid profile under the rubber: heights over x in periods.

use std::f64::consts::{PI, TAU};

use crate::error::{positive, KernelError};

/// Heights, in any unit of length; what a kind of profile is, only this file knows.
#[derive(Debug, Clone, PartialEq)]
pub enum Heights {
    /// A cos(2 pi x), crest at x = 0.
    Sine { amplitude: f64 },
}

impl Heights {
    pub fn sine(amplitude: f64) -> Result<Self, KernelError> {
        positive("amplitude", amplitude).map(|amplitude| Self::Sine { amplitude })
    }

    /// The same heights in units of `length`.
    pub fn over(&self, length: f64) -> Self {
        match *self {
            Self::Sine { amplitude } => Self::Sine {
                amplitude: amplitude / length,
            },
        }
    }

    pub fn height(&self, x: f64) -> f64 {
        match *self {
            Self::Sine { amplitude } => amplitude * (TAU * x).cos(),
        }
    }

    pub fn slope(&self, x: f64) -> f64 {
        match *self {
            Self::Sine { amplitude } => -amplitude * TAU * (TAU * x).sin(),
        }
    }

    pub fn curvature(&self, x: f64) -> f64 {
        match *self {
            Self::Sine { amplitude } => -amplitude * TAU * TAU * (TAU * x).cos(),
        }
    }

    /// Smallest and largest height.
    pub fn range(&self) -> (f64, f64) {
        match *self {
            Self::Sine { amplitude } => (-amplitude, amplitude),
        }
    }

    /// Half the difference of largest and smallest height.
    pub fn half_range(&self) -> f64 {
        let (lowest, highest) = self.range();
        0.5 * (highest - lowest)
    }

    /// Mean pressure that closes the gap of a half-plane with nu = 1/2 and unit shear modulus, for
    /// heights in periods: 4 pi A of a sine (K. L. Johnson, "Contact Mechanics" (1985), section
    /// 13.2), and of heights with the same range in one wave the order of magnitude.
    pub fn full_contact_pressure(&self) -> f64 {
        4.0 * PI * self.half_range()
    }
}
