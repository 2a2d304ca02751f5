//! Sampled periodic heights as their trigonometric interpolant, measured from their mean.
//!
//! With N samples h_j at x = j/N,
//!     h(x) = Re sum_n c_n exp(2 pi i n x),   c_n = 2/N sum_j h_j exp(-2 pi i n j / N),   n = 1 ... N/2
//!
//! Slope and curvature are derivatives of the same function, a sampled sine is the sine to round-off,
//! and a shift of the origin changes phases only. A periodic cubic spline would be cheaper to evaluate,
//! but its curvature has kinks, and all harmonics at all nodes cost a thousandth of one factorisation.

use std::f64::consts::{PI, TAU};
use std::fmt;

use crate::error::{finite, whole, KernelError};

const FEWEST_SAMPLES: usize = 8;
const MOST_SAMPLES: usize = 8192;
/// Harmonics after the last one with this share of the largest amplitude are round-off.
const SMALLEST_SHARE: f64 = 1e-9;
/// Minus the logarithm of what a smoothed profile keeps of its last wave.
const GAUSSIAN: f64 = 3.0;
/// Points per smallest wave in the search for extremes, before Newton's method.
const POINTS_PER_WAVE: usize = 32;

#[derive(Clone, PartialEq)]
pub struct Harmonics {
    /// Real and imaginary part of c_1, c_2 ...
    coefficients: Vec<(f64, f64)>,
    /// Smallest and largest height.
    pub range: (f64, f64),
    /// Mean pressure that balances the largest pull closing the gap of a half-plane of nu = 1/2 and
    /// unit shear modulus: wave n of height h_n(x) takes the pressure 4 pi n h_n(x).
    pub full_contact_pressure: f64,
}

impl Harmonics {
    /// Interpolate heights at x = 0, 1/N, 2/N ... of the period.
    pub fn new(samples: &[f64]) -> Result<Self, KernelError> {
        let name = "the number of heights";
        whole(name, samples.len() as f64, FEWEST_SAMPLES, MOST_SAMPLES)?;
        for &height in samples {
            finite("heights", height)?;
        }
        let mut coefficients = transform(samples);
        let size = |&(re, im): &(f64, f64)| re.hypot(im);
        let largest = coefficients.iter().map(size).fold(0.0, f64::max);
        let level = samples.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
        if largest <= f64::EPSILON * level || !largest.is_finite() {
            return Err(KernelError::Refused {
                name: "heights".to_owned(),
                expected: "different from each other, by a finite amount".to_owned(),
                value: format!("{} times {:?}", samples.len(), samples[0]),
            });
        }
        while coefficients.last().map(size) <= Some(SMALLEST_SHARE * largest) {
            coefficients.pop();
        }
        Ok(Self::of(coefficients))
    }

    fn of(coefficients: Vec<(f64, f64)>) -> Self {
        let mut harmonics = Self { coefficients, range: (0.0, 0.0), full_contact_pressure: 0.0 };
        harmonics.range = harmonics.extremes();
        harmonics.full_contact_pressure = harmonics
            .fine_points()
            .fold(0.0, |most, x| most.max(-4.0 * PI * harmonics.sum(x, |n| n).0));
        harmonics
    }

    /// The first `kept` of the waves, filtered by a Gaussian if they are not all.
    ///
    /// Its kernel is positive, so that no crest rises that the heights do not have: without it the waves
    /// ring beside a step of the heights, by 9 % of the step, at every number of waves elsewhere (Gibbs).
    pub fn smoothed(&self, kept: usize) -> Self {
        let kept = kept.clamp(1, self.waves());
        if kept == self.waves() {
            return self.clone();
        }
        let filtered = |(i, &(re, im)): (usize, &(f64, f64))| {
            let share = (-GAUSSIAN * ((i + 1) as f64 / kept as f64).powi(2)).exp();
            (share * re, share * im)
        };
        Self::of(self.coefficients[..kept].iter().enumerate().map(filtered).collect())
    }

    /// Heights between these and `other`, at `share` of the way.
    pub fn toward(&self, other: &Self, share: f64) -> Self {
        let wave = |of: &Self, n: usize| of.coefficients.get(n).copied().unwrap_or_default();
        let between = |n: usize| {
            let (from, to) = (wave(self, n), wave(other, n));
            (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1))
        };
        Self::of((0..self.waves().max(other.waves())).map(between).collect())
    }

    /// The same heights in units of `length`.
    pub fn over(&self, length: f64) -> Self {
        let scaled = |&(re, im): &(f64, f64)| (re / length, im / length);
        Self {
            coefficients: self.coefficients.iter().map(scaled).collect(),
            range: (self.range.0 / length, self.range.1 / length),
            full_contact_pressure: self.full_contact_pressure / length,
        }
    }

    /// Number of the last harmonic: the smallest wave is the period over it.
    pub fn waves(&self) -> usize {
        self.coefficients.len()
    }

    pub fn height(&self, x: f64) -> f64 {
        self.sum(x, |_| 1.0).0
    }

    pub fn slope(&self, x: f64) -> f64 {
        -TAU * self.sum(x, |n| n).1
    }

    pub fn curvature(&self, x: f64) -> f64 {
        -TAU * TAU * self.sum(x, |n| n * n).0
    }

    /// Root of two times the rms slope: of N waves the root of the sum of their squares.
    pub fn steepness(&self) -> f64 {
        let slope = |(i, &(re, im)): (usize, &(f64, f64))| TAU * (i + 1) as f64 * re.hypot(im);
        let squares = self.coefficients.iter().enumerate().map(|wave| slope(wave).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Size of the curvature where the heights are highest.
    pub fn crest_curvature(&self) -> f64 {
        let higher = |a: &f64, b: &f64| self.height(*a).total_cmp(&self.height(*b));
        let crest = self.fine_points().max_by(higher);
        crest.map_or(0.0, |x| self.curvature(x).abs())
    }

    /// sum_n weight(n) c_n exp(2 pi i n x) by Horner's rule.
    fn sum(&self, x: f64, weight: impl Fn(f64) -> f64) -> (f64, f64) {
        let (sin, cos) = (TAU * x).sin_cos();
        let coefficients = self.coefficients.iter().enumerate().rev();
        coefficients.fold((0.0, 0.0), |(re, im), (i, &(a, b))| {
            let w = weight((i + 1) as f64);
            let (re, im) = (re + w * a, im + w * b);
            (re * cos - im * sin, re * sin + im * cos)
        })
    }

    fn fine_points(&self) -> impl Iterator<Item = f64> {
        let points = POINTS_PER_WAVE * self.waves();
        (0..points).map(move |i| i as f64 / points as f64)
    }

    /// Smallest and largest height: the extreme fine points, moved to where the slope vanishes.
    fn extremes(&self) -> (f64, f64) {
        let (mut low, mut high) = (0.0, 0.0);
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in self.fine_points() {
            let height = self.height(x);
            if height < lowest {
                (low, lowest) = (x, height);
            }
            if height > highest {
                (high, highest) = (x, height);
            }
        }
        let at_extreme = |x: f64| {
            let step = 1.0 / (POINTS_PER_WAVE * self.waves()) as f64;
            let toward = |y: f64, _| {
                let next = y - self.slope(y) / self.curvature(y);
                next.clamp(x - step, x + step)
            };
            self.height((0..4).fold(x, toward))
        };
        // A curvature of zero gives NaN, which min and max leave out.
        (lowest.min(at_extreme(low)), highest.max(at_extreme(high)))
    }
}

/// A summary, because thousands of heights would not help in an error message.
impl fmt::Debug for Harmonics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (lowest, highest) = self.range;
        let (count, height, slope) = (self.waves(), self.height(0.0), self.slope(0.0));
        write!(
            f,
            "sampled heights of {count} harmonics from {lowest:?} to {highest:?}, at x = 0 {height:?} with slope {slope:?}"
        )
    }
}

/// 2/N sum_j h_j exp(-2 pi i n j / N), half of that at n = N/2, where samples do not see the sine.
fn transform(samples: &[f64]) -> Vec<(f64, f64)> {
    let count = samples.len();
    let mean = samples.iter().sum::<f64>() / count as f64;
    let turn = |j: usize| (TAU * j as f64 / count as f64).sin_cos();
    let turns: Vec<(f64, f64)> = (0..count).map(turn).collect();
    let coefficient = |n: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        for (j, height) in samples.iter().enumerate() {
            let (sin, cos) = turns[n * j % count];
            re += (height - mean) * cos;
            im -= (height - mean) * sin;
        }
        let share = if 2 * n == count { 1.0 } else { 2.0 } / count as f64;
        (share * re, if 2 * n == count { 0.0 } else { share * im })
    };
    (1..=count / 2).map(coefficient).collect()
}
