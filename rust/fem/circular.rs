//! Sums round the periodic line of columns, taken in harmonics.

use crate::material::kinematics::Symmetric;
use crate::material::sliding_history::SlidingHistory;
use crate::spectral::{Complex64, Lines};

/// H of what is remembered: the sum over columns e' of weights[e - e'] y(e'), for every point of a
/// column by itself.
pub fn convolve(history: &SlidingHistory, y: &[Symmetric]) -> Vec<Symmetric> {
    let mut lines = history.lines.clone();
    let (columns, mut out) = (lines.len(), vec![[0.0; 4]; y.len()]);
    let points = y.len() / columns;
    let mut line = vec![0.0; columns];
    for point in 0..points {
        for k in 0..4 {
            let from = y.iter().skip(point).step_by(points);
            line.iter_mut()
                .zip(from)
                .for_each(|(value, y)| *value = y[k]);
            lines.convolve(&history.spectrum, &mut line);
            let to = out.iter_mut().skip(point).step_by(points);
            to.zip(&line).for_each(|(h, value)| h[k] = *value);
        }
    }
    out
}

/// Sums over columns e of y(e - m) c(e), for every m, of many pairs of lines together.
#[derive(Clone)]
pub struct Correlations {
    lines: Lines,
    harmonics: [Vec<Complex64>; 2],
    sum: Vec<Complex64>,
}

impl Correlations {
    pub fn new(columns: usize) -> Self {
        let lines = Lines::new(columns);
        let nothing = vec![Complex64::default(); lines.harmonics()];
        Self {
            lines,
            harmonics: [nothing.clone(), nothing.clone()],
            sum: nothing,
        }
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

    /// The sums of all pairs, to begin anew.
    pub fn take(&mut self) -> Vec<f64> {
        let mut sums = vec![0.0; self.lines.len()];
        self.lines.inverse(&self.sum, &mut sums);
        self.sum.fill(Complex64::default());
        sums
    }
}
