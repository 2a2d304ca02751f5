//! One period of the rigid profile under the rubber: heights over x in periods.

use std::f64::consts::{PI, TAU};

use super::harmonics::Harmonics;
use crate::error::{positive, KernelError};

/// Fewest nodes along the smallest wave of sampled heights.
const NODES_PER_WAVE: usize = 6;

/// Fixed-point iterations for the width of a small contact.
const HERTZ_ITERATIONS: usize = 60;

/// Heights, in any unit of length. Only this file distinguishes the kinds of profile.
#[derive(Debug, Clone, PartialEq)]
pub enum Heights {
    /// A cos(2 pi x), crest at x = 0.
    Sine { amplitude: f64 },
    /// A periodic function through equidistant heights, the first at x = 0.
    Sampled(Harmonics),
}

impl Heights {
    pub fn sine(amplitude: f64) -> Result<Self, KernelError> {
        positive("amplitude", amplitude).map(|amplitude| Self::Sine { amplitude })
    }

    pub fn sampled(heights: &[f64]) -> Result<Self, KernelError> {
        Harmonics::new(heights).map(Self::Sampled)
    }

    /// The same heights in units of `length`.
    pub fn over(&self, length: f64) -> Self {
        match self {
            Self::Sine { amplitude } => Self::Sine { amplitude: amplitude / length },
            Self::Sampled(harmonics) => Self::Sampled(harmonics.over(length)),
        }
    }

    pub fn height(&self, x: f64) -> f64 {
        match self {
            Self::Sine { amplitude } => amplitude * (TAU * x).cos(),
            Self::Sampled(harmonics) => harmonics.height(x),
        }
    }

    pub fn slope(&self, x: f64) -> f64 {
        match self {
            Self::Sine { amplitude } => -amplitude * TAU * (TAU * x).sin(),
            Self::Sampled(harmonics) => harmonics.slope(x),
        }
    }

    pub fn curvature(&self, x: f64) -> f64 {
        match self {
            Self::Sine { amplitude } => -amplitude * TAU * TAU * (TAU * x).cos(),
            Self::Sampled(harmonics) => harmonics.curvature(x),
        }
    }

    /// Smallest and largest height.
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Sine { amplitude } => (-amplitude, *amplitude),
            Self::Sampled(harmonics) => harmonics.range,
        }
    }

    /// Half the difference of largest and smallest height.
    pub fn half_range(&self) -> f64 {
        let (lowest, highest) = self.range();
        0.5 * (highest - lowest)
    }

    /// Size of the curvature of the highest crest.
    pub fn crest_curvature(&self) -> f64 {
        match self {
            Self::Sine { amplitude } => amplitude * TAU * TAU,
            Self::Sampled(harmonics) => harmonics.crest_curvature(),
        }
    }

    /// Root of two times the rms slope of heights in periods: k A of a sine.
    pub fn steepness(&self) -> f64 {
        match self {
            Self::Sine { amplitude } => TAU * amplitude,
            Self::Sampled(harmonics) => harmonics.steepness(),
        }
    }

    /// Mean pressure that closes the gap of a half-plane with nu = 1/2 and unit shear modulus, for
    /// heights in periods: 4 pi A of a sine (K. L. Johnson, "Contact Mechanics" (1985), section
    /// 13.2).
    pub fn full_contact_pressure(&self) -> f64 {
        match self {
            Self::Sine { amplitude } => 4.0 * PI * amplitude,
            Self::Sampled(harmonics) => harmonics.full_contact_pressure,
        }
    }

    /// The profile with its longest `waves` alone.
    pub fn smoothed(&self, waves: usize) -> Self {
        match self {
            Self::Sine { .. } => self.clone(),
            Self::Sampled(harmonics) => Self::Sampled(harmonics.smoothed(waves)),
        }
    }

    /// Heights between these and `other` of the same kind, at `share` of the way; `other` itself if the
    /// kinds have nothing in between.
    pub fn toward(&self, other: &Self, share: f64) -> Self {
        match (self, other) {
            (Self::Sampled(from), Self::Sampled(to)) if share < 1.0 => {
                Self::Sampled(from.toward(to, share))
            }
            _ => other.clone(),
        }
    }

    /// Number of the last wave of the period.
    pub fn waves(&self) -> usize {
        match self {
            Self::Sine { .. } => 1,
            Self::Sampled(harmonics) => harmonics.waves(),
        }
    }

    /// Fewest nodes along the period that resolve the smallest wave.
    pub fn fewest_nodes(&self) -> usize {
        match self {
            Self::Sine { .. } => 0,
            Self::Sampled(harmonics) => NODES_PER_WAVE * harmonics.waves(),
        }
    }
}

/// Width in periods of a small contact on a crest of `curvature`, by Hertz's line contact:
/// 2 a = 4 sqrt(P R / (pi M)), R the crest's radius of curvature, M = 4 G for an incompressible solid in
/// plane strain (K. L. Johnson, "Contact Mechanics" (1985), section 4.2(c)).
///
/// `load` is the mean pressure times one period; `magnitude` is |G*| as a function of the angular frequency
/// per passage of the period. The rubber responds with its modulus at the frequency of the contact itself,
/// which depends on the width. Under more load other crests touch or contact is full: the contact on each
/// crest is then narrower, or there is no edge.
pub fn hertz_contact_width(load: f64, curvature: f64, magnitude: impl Fn(f64) -> f64) -> f64 {
    let elastic = |modulus: f64| 2.0 * (load / (PI * modulus * curvature)).sqrt();
    // A narrower contact meets a stiffer rubber, so the widths fall monotonically to the solution.
    (0..HERTZ_ITERATIONS).fold(1.0, |width, _| elastic(magnitude(TAU / width)).min(1.0))
}
