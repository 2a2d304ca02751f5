//! Filters of periodic lines in single precision: each wave times its factor,
//!     g = F^-1 (c F f).
//!
//! A line of 2 M values is transformed as M complex ones, z_j = f_2j + i f_2j+1, whose waves z_k hold those of the
//! even and of the odd values: e_k + i o_k = z_k and e_k - i o_k = conj z_M-k. With w = exp(-i pi k / M) the waves
//! of the line are F_k = e_k + w o_k and conj F_M-k = e_k - w o_k. The filter is one pass over k that takes these
//! apart and puts them together again: factors of z_k itself would lose the digits of waves with small factors
//! to those with large ones. Lines of an odd number of values are transformed as they are.

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

    /// A line of zeros.
    pub fn line(&self) -> PackedLine {
        let scratch = [&self.forward, &self.inverse].map(|fft| fft.get_inplace_scratch_len());
        PackedLine {
            packed: self.points % 2 == 0,
            values: vec![Complex32::default(); self.turn.len()],
            scratch: vec![Complex32::default(); scratch[0].max(scratch[1])],
        }
    }

    /// Filter `line` by a factor for each wave; imaginary parts of the first and, of an even number of values,
    /// of the last are ignored, because a real line has none.
    pub fn apply(&self, factors: &[Complex32], line: &mut PackedLine) {
        let PackedLine { packed, values, scratch } = line;
        self.forward.process_with_scratch(values, scratch);
        if *packed {
            self.multiply_packed(factors, values);
        } else {
            let share = 1.0 / values.len() as f32;
            values[0] *= factors[0].re * share;
            for k in 1..factors.len() {
                let opposite = values.len() - k;
                values[k] *= factors[k] * share;
                values[opposite] *= factors[k].conj() * share;
            }
        }
        self.inverse.process_with_scratch(values, scratch);
    }

    fn multiply_packed(&self, factors: &[Complex32], values: &mut [Complex32]) {
        let count = values.len();
        let share = 0.5 / count as f32;
        let half_i = Complex32::new(0.0, 0.5);
        let pass = |values: &mut [Complex32], k: usize, here: Complex32, there: Complex32| {
            let opposite = if k == 0 { 0 } else { count - k };
            let (z, y) = (values[k], values[opposite].conj());
            let (even, odd) = ((z + y) * 0.5, self.turn[k] * (y - z) * half_i);
            let (here, there) = (here * (even + odd), there.conj() * (even - odd));
            let even = (here + there) * share;
            let odd = (here - there) * self.turn[k].conj() * share;
            let odd = Complex32::new(-odd.im, odd.re);
            values[k] = even + odd;
            values[opposite] = (even - odd).conj();
        };
        pass(values, 0, factors[0].re.into(), factors[count].re.into());
        for k in 1..=count / 2 {
            pass(values, k, factors[k], factors[count - k]);
        }
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

    /// A long wave times a small factor beside a short one times a large factor.
    #[test]
    fn a_small_wave_keeps_its_digits() {
        let points = 4096;
        let filter = LineFilter::new(points);
        let angle = |wave: usize, at: usize| {
            (wave * at % points) as f32 / points as f32 * std::f32::consts::TAU
        };
        let values: Vec<f32> = (0..points).map(|at| angle(2, at).cos()).collect();
        let mut factors = vec![Complex32::from(1e5); filter.waves()];
        factors[2] = Complex32::from(1e-2);
        let mut line = filter.line();
        line.fill(&values);
        filter.apply(&factors, &mut line);
        let part = |at: usize| line.get(at) * angle(2, at).cos() * 2.0 / points as f32;
        let amplitude: f32 = (0..points).map(part).sum();
        assert!((amplitude / 1e-2 - 1.0).abs() < 1e-3, "{amplitude}");
    }

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
            filter.apply(&waves, &mut line);
            Lines::<f32>::new(points).convolve(&waves, &mut wanted);
            for (at, wanted) in wanted.iter().enumerate() {
                assert!((line.get(at) - wanted).abs() < 3e-6, "{points} values, at {at}");
            }
        }
    }
}
