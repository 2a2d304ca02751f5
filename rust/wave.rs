//! The rigid sine wave under the rubber: height A cos(2 pi x), crest at x = 0, lengths in wavelengths.

use std::f64::consts::TAU;

#[derive(Debug, Clone, Copy)]
pub struct Wave {
    pub amplitude: f64,
}

impl Wave {
    pub fn height(&self, x: f64) -> f64 {
        self.amplitude * (TAU * x).cos()
    }

    pub fn slope(&self, x: f64) -> f64 {
        -self.amplitude * TAU * (TAU * x).sin()
    }

    pub fn curvature(&self, x: f64) -> f64 {
        -self.amplitude * TAU * TAU * (TAU * x).cos()
    }
}
