//! Memory of the temporary networks in steady sliding: a convolution along a line of points.
//!
//! The rubber flows through the fixed mesh in +x with speed v, so each temporary network obeys
//!     tau_i v dA_i/dx = Y - A_i,   periodic in x           (Lubliner 1985, steady in the wave's frame)
//! and H = G_inf b + (G(t) - G_inf) I + sum over points of weight * Y, where the mean state relaxes
//! only for the load time t: the mean of A_i is (1 - e_i) mean(Y) + e_i I with e_i = exp(-t / tau_i).
//!
//! The weights follow from the Fourier series, where harmonic k is multiplied by the complex modulus
//! G*(2 pi k v / lambda). The tests check them against the exact recurrence between neighbouring points.

use std::f64::consts::TAU;

use super::dissipation::Dissipation;
use super::maxwell::Maxwell;
use crate::spectral::{Complex64, Lines};

/// Weights between equally placed points of the columns of one line (they form a circulant matrix).
///
/// Each Gauss point of a column and its images in the other columns are an equidistant sampling of
/// the line, so the weights depend on the distance in columns alone.
#[derive(Debug, Clone)]
pub struct SlidingHistory {
    /// Modulus that the temporary networks add to the mean state, G(load time) - G_inf.
    pub frozen_modulus: f64,
    /// Factors of the harmonics of Y in H: the harmonics of the weights.
    pub spectrum: Vec<Complex64>,
    pub lines: Lines,
    pub dissipation: Dissipation,
}

impl SlidingHistory {
    /// Memory of steady sliding; `load_time` in passage times.
    ///
    /// Harmonic k of Y is multiplied by G(t) - G*(omega_k), the mean by zero. The weight of each point on
    /// itself is then removed, which DEV would remove with cancellation.
    pub fn new(columns: usize, maxwell: &Maxwell, load_time: f64) -> Self {
        let mean = maxwell.relaxation_modulus(load_time);
        let mut lines = Lines::new(columns);
        let mut spectrum = vec![Complex64::default(); lines.harmonics()];
        for (harmonic, factor) in spectrum.iter_mut().enumerate().skip(1) {
            let omega = TAU * harmonic as f64;
            let (storage, loss) = maxwell.complex_modulus(omega);
            *factor = Complex64::new(mean - storage, -loss);
        }
        let mut stress = vec![0.0; columns];
        lines.inverse(&spectrum, &mut stress);
        stress[0] = 0.0;
        lines.forward(&stress, &mut spectrum);
        Self {
            spectrum,
            lines,
            frozen_modulus: mean - maxwell.equilibrium,
            dissipation: Dissipation::new(columns, maxwell),
        }
    }
}
