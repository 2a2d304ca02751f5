//! Fourier transforms of real lines that go round the period, the one file with realfft:
//!     f_k = sum_j f_j exp(-2 pi i j k / N),   k = 0 ... N/2,   f_j = 1/N sum_k f_k exp(2 pi i j k / N)

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

pub use realfft::num_complex::Complex64;

impl fmt::Debug for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "transforms of lines of {} values", self.len())
    }
}

/// Both transforms of lines of one length, with the room they work in.
#[derive(Clone)]
pub struct Lines {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    line: Vec<f64>,
    spectrum: Vec<Complex64>,
    work: Vec<Complex64>,
}

impl Lines {
    pub fn new(length: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        let work = forward.get_scratch_len().max(inverse.get_scratch_len());
        Self {
            line: forward.make_input_vec(),
            spectrum: forward.make_output_vec(),
            work: vec![Complex64::default(); work],
            forward,
            inverse,
        }
    }

    /// Values on a line.
    pub fn len(&self) -> usize {
        self.line.len()
    }

    pub fn is_empty(&self) -> bool {
        self.line.is_empty()
    }

    /// Harmonics of a line, 0 to N/2.
    pub fn harmonics(&self) -> usize {
        self.spectrum.len()
    }

    /// exp(2 pi i k / N): what harmonic k turns by from one value to the next.
    pub fn turn(&self, harmonic: usize) -> Complex64 {
        Complex64::cis(TAU * harmonic as f64 / self.len() as f64)
    }

    /// The harmonics of `line`.
    pub fn forward(&mut self, line: &[f64], spectrum: &mut [Complex64]) {
        self.line.copy_from_slice(line);
        let done = self
            .forward
            .process_with_scratch(&mut self.line, spectrum, &mut self.work);
        debug_assert!(done.is_ok());
    }

    /// The line of the harmonics in `spectrum`; what the mean and the last may not have is left out.
    pub fn inverse(&mut self, spectrum: &[Complex64], line: &mut [f64]) {
        self.spectrum.copy_from_slice(spectrum);
        self.inverse_own(line);
    }

    /// The same of harmonics that stand in pieces.
    pub fn inverse_of<'s>(
        &mut self,
        pieces: impl Iterator<Item = &'s [Complex64]>,
        line: &mut [f64],
    ) {
        let mut at = 0;
        for piece in pieces {
            self.spectrum[at..at + piece.len()].copy_from_slice(piece);
            at += piece.len();
        }
        self.inverse_own(line);
    }

    /// `line` convolved round the period with a line of these harmonics.
    pub fn convolve(&mut self, with: &[Complex64], line: &mut [f64]) {
        self.line.copy_from_slice(line);
        let done =
            self.forward
                .process_with_scratch(&mut self.line, &mut self.spectrum, &mut self.work);
        debug_assert!(done.is_ok());
        for (value, factor) in self.spectrum.iter_mut().zip(with) {
            *value *= factor;
        }
        self.inverse_own(line);
    }

    fn inverse_own(&mut self, line: &mut [f64]) {
        self.spectrum[0].im = 0.0;
        if self.line.len() % 2 == 0 {
            if let Some(last) = self.spectrum.last_mut() {
                last.im = 0.0;
            }
        }
        let done = self
            .inverse
            .process_with_scratch(&mut self.spectrum, line, &mut self.work);
        debug_assert!(done.is_ok());
        let share = 1.0 / line.len() as f64;
        line.iter_mut().for_each(|value| *value *= share);
    }
}
