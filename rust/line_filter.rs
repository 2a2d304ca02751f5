//! Filters of periodic lines in single precision: each wave times its factor,
//!     g = F^-1 (c F f).
//!
//! A line of 2 M values is transformed as M complex ones, z_j = f_2j + i f_2j+1. With w = exp(-i pi k / M) their
//! waves z_k and y_k = conj z_M-k hold those of the line, F_k = (z_k + y_k) / 2 - i w (z_k - y_k) / 2, so the
//! filter is
//!     z_k  <-  (s + d Im w) z_k + i d Re w y_k,    s, d = (c_k +- conj c_M-k) / 2.
//! Lines of an odd number of values are transformed as they are.

use std::fmt;
use std::sync::Arc;

use rustfft::{Fft, FftPlanner};

use crate::spectral::Complex32;

/// Filter of lines of one length.
pub struct LineFilter {
    points: usize,
    forward: Arc<dyn Fft<f32>>,
    inverse: Arc<dyn Fft<f32>>,
    /// w of each wave.
    turn: Vec<Complex32>,
}

impl fmt::Debug for LineFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "filter of lines of {} values", self.points)
    }
}

/// Factors of z_k and of y_k, over the number of complex values.
pub struct Factors(Vec<[Complex32; 2]>);

/// A line as the filter transforms it, and its workspace.
pub struct PackedLine {
    packed: bool,
    values: Vec<Complex32>,
    scratch: Vec<Complex32>,
}

impl LineFilter {
    pub fn new(points: usize) -> Self {
        let count = if points % 2 == 0 { points / 2 } else { points };
        let mut planner = FftPlanner::new();
        let angle = -std::f64::consts::PI / count as f64;
        let turn = |k: usize| {
            let (sine, cosine) = (angle * k as f64).sin_cos();
            Complex32::new(cosine as f32, sine as f32)
        };
        Self {
            points,
            forward: planner.plan_fft_forward(count),
            inverse: planner.plan_fft_inverse(count),
            turn: (0..count).map(turn).collect(),
        }
    }

    /// Values on a line.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Waves of a line, 0 to half of its values.
    pub fn waves(&self) -> usize {
        self.points / 2 + 1
    }

    fn is_packed(&self) -> bool {
        self.points % 2 == 0
    }

    /// The filter with a factor c for each wave; imaginary parts of the first and, of an even number of
    /// values, of the last are ignored, because a real line has none.
    pub fn factors(&self, waves: &[Complex32]) -> Factors {
        let count = self.turn.len();
        let share = 1.0 / count as f32;
        let factor = |k: usize| {
            let own_opposite = k == 0 || 2 * k == self.points;
            let value = if 2 * k > self.points { waves[self.points - k].conj() } else { waves[k] };
            (if own_opposite { Complex32::from(value.re) } else { value }) * share
        };
        let of_wave = |(k, turn): (usize, &Complex32)| {
            if !self.is_packed() {
                return [factor(k), Complex32::default()];
            }
            let (here, opposite) = (factor(k), factor(count - k).conj());
            let (sum, difference) = ((here + opposite) * 0.5, (here - opposite) * 0.5);
            [sum + difference * turn.im, Complex32::i() * difference * turn.re]
        };
        Factors(self.turn.iter().enumerate().map(of_wave).collect())
    }

    /// A line of zeros.
    pub fn line(&self) -> PackedLine {
        let scratch = [&self.forward, &self.inverse].map(|fft| fft.get_inplace_scratch_len());
        PackedLine {
            packed: self.is_packed(),
            values: vec![Complex32::default(); self.turn.len()],
            scratch: vec![Complex32::default(); scratch[0].max(scratch[1])],
        }
    }

    /// Filter `line`.
    pub fn apply(&self, factors: &Factors, line: &mut PackedLine) {
        let PackedLine { values, scratch, .. } = line;
        self.forward.process_with_scratch(values, scratch);
        let (first, rest) = (values[0], factors.0.len() / 2 + 1);
        let filtered = |[same, mirrored]: [Complex32; 2], here: Complex32, opposite: Complex32| {
            same * here + mirrored * opposite.conj()
        };
        values[0] = filtered(factors.0[0], first, first);
        for k in 1..rest {
            let opposite = values.len() - k;
            let (here, there) = (values[k], values[opposite]);
            values[k] = filtered(factors.0[k], here, there);
            values[opposite] = filtered(factors.0[opposite], there, here);
        }
        self.inverse.process_with_scratch(values, scratch);
    }
}

impl PackedLine {
    pub fn get(&self, at: usize) -> f32 {
        if !self.packed {
            return self.values[at].re;
        }
        let pair = self.values[at / 2];
        if at % 2 == 0 {
            pair.re
        } else {
            pair.im
        }
    }

    /// Set every value.
    pub fn fill(&mut self, line: &[f32]) {
        if self.packed {
            for (pair, values) in self.values.iter_mut().zip(line.chunks_exact(2)) {
                *pair = Complex32::new(values[0], values[1]);
            }
        } else {
            for (to, value) in self.values.iter_mut().zip(line) {
                *to = Complex32::from(*value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectral::Lines;

    #[test]
    fn filters_as_the_transforms_of_real_lines() {
        for points in [2, 6, 15, 64, 135, 270] {
            let filter = LineFilter::new(points);
            let value = |k: usize| ((7 * k + 3) as f32).sin();
            let mut wanted: Vec<f32> = (0..points).map(value).collect();
            let waves: Vec<_> =
                (0..filter.waves()).map(|k| Complex32::new(value(k + 5), value(k + 9))).collect();
            let mut line = filter.line();
            line.fill(&wanted);
            filter.apply(&filter.factors(&waves), &mut line);
            Lines::<f32>::new(points).convolve(&waves, &mut wanted);
            for (at, wanted) in wanted.iter().enumerate() {
                assert!((line.get(at) - wanted).abs() < 3e-6, "{points} values, at {at}");
            }
        }
    }
}
