//! Fourier transforms of periodic real lines, the one file with realfft:
//!     f_k = sum_j f_j exp(-2 pi i j k / N),   k = 0 ... N/2,   f_j = 1/N sum_k f_k exp(2 pi i j k / N)

use std::fmt;
use std::ops::AddAssign;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, FftNum, RealFftPlanner, RealToComplex};

pub use realfft::num_complex::{Complex32, Complex64};

/// Numbers of single or double precision.
pub trait Real: FftNum + AddAssign + Default + Into<f64> {
    /// 1 / `count`.
    fn share_of(count: usize) -> Self;
}

impl Real for f32 {
    fn share_of(count: usize) -> Self {
        1.0 / count as f32
    }
}

impl Real for f64 {
    fn share_of(count: usize) -> Self {
        1.0 / count as f64
    }
}

impl<T: Real> fmt::Debug for Lines<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "transforms of lines of {} values", self.length())
    }
}

/// Both transforms of lines of one length, with their workspace.
#[derive(Clone)]
pub struct Lines<T: Real = f64> {
    forward: Arc<dyn RealToComplex<T>>,
    inverse: Arc<dyn ComplexToReal<T>>,
    line: Vec<T>,
    spectrum: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Real> Lines<T> {
    pub fn new(length: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        let scratch = forward.get_scratch_len().max(inverse.get_scratch_len());
        Self {
            line: forward.make_input_vec(),
            spectrum: forward.make_output_vec(),
            scratch: vec![Complex::default(); scratch],
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

    /// The harmonics of `line`.
    pub fn forward(&mut self, line: &[T], spectrum: &mut [Complex<T>]) {
        self.line.copy_from_slice(line);
        let done = self.forward.process_with_scratch(&mut self.line, spectrum, &mut self.scratch);
        debug_assert!(done.is_ok());
    }

    /// The line of the harmonics in `spectrum`; imaginary parts of the mean and of the last are ignored,
    /// because a real line has none.
    pub fn inverse(&mut self, spectrum: &[Complex<T>], line: &mut [T]) {
        self.spectrum.copy_from_slice(spectrum);
        self.invert_spectrum(line);
    }

    /// The same for harmonics that are stored in pieces.
    pub fn inverse_of_pieces<'s>(
        &mut self,
        pieces: impl Iterator<Item = &'s [Complex<T>]>,
        line: &mut [T],
    ) {
        let mut at = 0;
        for piece in pieces {
            self.spectrum[at..at + piece.len()].copy_from_slice(piece);
            at += piece.len();
        }
        self.invert_spectrum(line);
    }

    /// `line` convolved round the period with a line of these harmonics.
    pub fn convolve(&mut self, with: &[Complex<T>], line: &mut [T]) {
        self.line.copy_from_slice(line);
        let done = self.forward.process_with_scratch(
            &mut self.line,
            &mut self.spectrum,
            &mut self.scratch,
        );
        debug_assert!(done.is_ok());
        for (value, factor) in self.spectrum.iter_mut().zip(with) {
            *value = *value * factor;
        }
        self.invert_spectrum(line);
    }

    fn invert_spectrum(&mut self, line: &mut [T]) {
        self.spectrum[0].im = T::zero();
        if self.line.len() % 2 == 0 {
            if let Some(last) = self.spectrum.last_mut() {
                last.im = T::zero();
            }
        }
        let done = self.inverse.process_with_scratch(&mut self.spectrum, line, &mut self.scratch);
        debug_assert!(done.is_ok());
        let share = T::share_of(line.len());
        line.iter_mut().for_each(|value| *value = *value * share);
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
