//! How wide the contact of a crest will be: Hertz's line contact, the limit of small loads.
//!
//! Width 2 a = 4 sqrt(P R / (pi M)), R the crest's radius of curvature, M = 4 G in plane strain when
//! incompressible (K. L. Johnson, "Contact Mechanics" (1985), section 4.2(c)). The rubber answers
//! with its modulus at the frequency of the contact itself, which is found with the width.

use std::f64::consts::{PI, TAU};

const ROUNDS: usize = 60;

/// Contact width in periods under `load`, the mean pressure times one period, on a crest of
/// `curvature`; `magnitude` is |G*| by angular frequency per passage of the period.
///
/// More load makes other crests touch or the block close up: the contact is then narrower on each
/// crest, or full.
pub fn width(load: f64, curvature: f64, magnitude: impl Fn(f64) -> f64) -> f64 {
    let elastic = |modulus: f64| 2.0 * (load / (PI * modulus * curvature)).sqrt();
    // A narrower contact meets a stiffer rubber: the widths fall, towards the answer.
    (0..ROUNDS).fold(1.0, |width, _| elastic(magnitude(TAU / width)).min(1.0))
}
