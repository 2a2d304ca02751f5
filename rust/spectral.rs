//! Fourier transforms of periodic real lines, the one file with realfft:
//!     f_k = sum_j f_j exp(-2 pi i j k / N),   k = 0 ... N/2,   f_j = 1/N sum_k f_k exp(2 pi i j k / N)

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

pub use realfft::num_complex::{Complex32, Complex64};

impl fmt::Debug for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "transforms of lines of {} values", self.length())
    }
}

/// Both transforms of lines of one length, with their workspace.
#[derive(Clone)]
pub struct Lines {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    line: Vec<f64>,
    spectrum: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Lines {
    pub fn new(length: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        let scratch = forward.get_scratch_len().max(inverse.get_scratch_len());
        Self {
            line: forward.make_input_vec(),
            spectrum: forward.make_output_vec(),
            scratch: vec![Complex64::default(); scratch],
            forward,
            inverse,
        }
    }

    /// Values on a line.
    pub fn length(&self) -> usize {
        self.line.len()
    }

    /// Harmonics of a line, 0 to N/2.
    pub fn harmonics(&self) -> usize {
        self.spectrum.len()
    }

    /// exp(2 pi i k / N): the factor of harmonic k from one value to the next.
    pub fn phase_step(&self, harmonic: usize) -> Complex64 {
        Complex64::cis(TAU * harmonic as f64 / self.length() as f64)
    }

    /// The harmonics of `line`.
    pub fn forward(&mut self, line: &[f64], spectrum: &mut [Complex64]) {
        self.line.copy_from_slice(line);
        let done = self.forward.process_with_scratch(&mut self.line, spectrum, &mut self.scratch);
        debug_assert!(done.is_ok());
    }

    /// The line of the harmonics in `spectrum`; imaginary parts of the mean and of the last are ignored,
    /// because a real line has none.
    pub fn inverse(&mut self, spectrum: &[Complex64], line: &mut [f64]) {
        self.spectrum.copy_from_slice(spectrum);
        self.invert_spectrum(line);
    }

    /// The same for harmonics that are stored in pieces.
    pub fn inverse_of_pieces<'s>(
        &mut self,
        pieces: impl Iterator<Item = &'s [Complex64]>,
        line: &mut [f64],
    ) {
        let mut at = 0;
        for piece in pieces {
            self.spectrum[at..at + piece.len()].copy_from_slice(piece);
            at += piece.len();
        }
        self.invert_spectrum(line);
    }

    /// `line` convolved round the period with a line of these harmonics.
    pub fn convolve(&mut self, with: &[Complex64], line: &mut [f64]) {
        self.line.copy_from_slice(line);
        let done = self.forward.process_with_scratch(
            &mut self.line,
            &mut self.spectrum,
            &mut self.scratch,
        );
        debug_assert!(done.is_ok());
        for (value, factor) in self.spectrum.iter_mut().zip(with) {
            *value *= factor;
        }
        self.invert_spectrum(line);
    }

    fn invert_spectrum(&mut self, line: &mut [f64]) {
        self.spectrum[0].im = 0.0;
        if self.line.len() % 2 == 0 {
            if let Some(last) = self.spectrum.last_mut() {
                last.im = 0.0;
            }
        }
        let done = self.inverse.process_with_scratch(&mut self.spectrum, line, &mut self.scratch);
        debug_assert!(done.is_ok());
        let share = 1.0 / line.len() as f64;
        line.iter_mut().for_each(|value| *value *= share);
    }
}

/// Filters of lines of one length in single precision, for callers on any thread; the bindings' alone.
#[cfg_attr(not(feature = "python"), allow(dead_code))]
pub struct SingleLines {
    forward: Arc<dyn RealToComplex<f32>>,
    inverse: Arc<dyn ComplexToReal<f32>>,
}

#[cfg_attr(not(feature = "python"), allow(dead_code))]
impl SingleLines {
    pub fn new(length: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        Self {
            forward: planner.plan_fft_forward(length),
            inverse: planner.plan_fft_inverse(length),
        }
    }

    /// Values on a line.
    pub fn length(&self) -> usize {
        self.forward.len()
    }

    /// Harmonics of a line, 0 to N/2.
    pub fn harmonics(&self) -> usize {
        self.length() / 2 + 1
    }

    /// A filter with its own workspace.
    pub fn filter(&self) -> SingleFilter<'_> {
        let scratch = self.forward.get_scratch_len();
        let scratch = scratch.max(self.inverse.get_scratch_len());
        SingleFilter {
            lines: self,
            spectrum: self.forward.make_output_vec(),
            scratch: vec![Complex32::default(); scratch],
        }
    }
}

#[cfg_attr(not(feature = "python"), allow(dead_code))]
pub struct SingleFilter<'l> {
    lines: &'l SingleLines,
    spectrum: Vec<Complex32>,
    scratch: Vec<Complex32>,
}

#[cfg_attr(not(feature = "python"), allow(dead_code))]
impl SingleFilter<'_> {
    /// Multiply each harmonic of `line`, 0 to N/2, by its factor.
    pub fn apply(&mut self, line: &mut [f32], factors: &[Complex32]) {
        let (forward, inverse) = (&self.lines.forward, &self.lines.inverse);
        let done = forward.process_with_scratch(line, &mut self.spectrum, &mut self.scratch);
        debug_assert!(done.is_ok());
        for (value, factor) in self.spectrum.iter_mut().zip(factors) {
            *value *= factor;
        }
        // a real line has no imaginary parts of its mean and of the wave that is its own opposite
        self.spectrum[0].im = 0.0;
        if line.len() % 2 == 0 {
            self.spectrum[line.len() / 2].im = 0.0;
        }
        let done = inverse.process_with_scratch(&mut self.spectrum, line, &mut self.scratch);
        debug_assert!(done.is_ok());
        let share = 1.0 / line.len() as f32;
        line.iter_mut().for_each(|value| *value *= share);
    }
}

/// Convolution round the period of every component of tensors at the points of a line, for every point
/// of a column separately; `spectrum` are the harmonics of the weights by columns, and `values` stand
/// `[column * points + point]`.
pub fn convolve_points(
    lines: &Lines,
    spectrum: &[Complex64],
    values: &[[f64; 4]],
) -> Vec<[f64; 4]> {
    let mut lines = lines.clone();
    let (columns, mut out) = (lines.length(), vec![[0.0; 4]; values.len()]);
    let points = values.len() / columns;
    let mut line = vec![0.0; columns];
    for point in 0..points {
        for k in 0..4 {
            let from = values.iter().skip(point).step_by(points);
            line.iter_mut().zip(from).for_each(|(to, value)| *to = value[k]);
            lines.convolve(spectrum, &mut line);
            let to = out.iter_mut().skip(point).step_by(points);
            to.zip(&line).for_each(|(to, value)| to[k] = *value);
        }
    }
    out
}

/// Sums over columns e of y(e - m) c(e), for every m, over many pairs of lines.
#[derive(Clone)]
pub struct Correlations {
    lines: Lines,
    harmonics: [Vec<Complex64>; 2],
    sum: Vec<Complex64>,
}

impl Correlations {
    pub fn new(columns: usize) -> Self {
        let lines = Lines::new(columns);
        let zeros = vec![Complex64::default(); lines.harmonics()];
        Self { lines, harmonics: [zeros.clone(), zeros.clone()], sum: zeros }
    }

    /// Add `weight` times the sums of one pair.
    pub fn add(&mut self, weight: f64, y: &[f64], c: &[f64]) {
        let [of_y, of_c] = &mut self.harmonics;
        self.lines.forward(y, of_y);
        self.lines.forward(c, of_c);
        for (sum, (y, c)) in self.sum.iter_mut().zip(of_y.iter().zip(of_c)) {
            *sum += weight * y.conj() * *c;
        }
    }

    /// The sums of all pairs since the last call.
    pub fn take(&mut self) -> Vec<f64> {
        let mut sums = vec![0.0; self.lines.length()];
        self.lines.inverse(&self.sum, &mut sums);
        self.sum.fill(Complex64::default());
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_precision_filters_as_double_does() {
        for length in [9, 64, 135] {
            let line: Vec<f64> = (0..length).map(|at| (0.7 * at as f64).sin() + 0.3).collect();
            let mut expected = line.clone();
            let factor = |k: usize| Complex64::new(1.0 / (1 + k) as f64, 0.1 * k as f64);
            let factors: Vec<Complex64> = (0..=length / 2).map(factor).collect();
            Lines::new(length).convolve(&factors, &mut expected);
            let single =
                |values: &[f64]| -> Vec<f32> { values.iter().map(|value| *value as f32).collect() };
            let lines = SingleLines::new(length);
            let factors: Vec<Complex32> = factors
                .iter()
                .map(|value| Complex32::new(value.re as f32, value.im as f32))
                .collect();
            let mut found = single(&line);
            lines.filter().apply(&mut found, &factors);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((f64::from(*found) - expected).abs() < 1e-5);
            }
        }
    }
}
