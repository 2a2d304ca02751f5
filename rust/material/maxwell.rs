//! The generalized Maxwell model: a spring in parallel with springs in series with dashpots.
//!
//! Relaxation modulus and complex modulus are
//!     G(t) = G_inf + sum G_i exp(-t / tau_i),   G*(w) = G_inf + sum G_i i w tau_i / (1 + i w tau_i)
//! and tau dA/dt = Y - A of one element is integrated exactly over a step x = dt / tau in which Y is
//! linear (Taylor, Pister & Goudreau, Int. J. Numer. Methods Eng. 2 (1970) 45):
//!     A_new = exp(-x) A_old + leaving(x) Y_old + arriving(x) Y_new.

use crate::spectral::Complex64;

/// Frequencies at once in `relaxing_moduli`: their sums stay in the fastest cache.
#[cfg_attr(not(feature = "python"), allow(dead_code))]
const BLOCK: usize = 512;

/// Shear moduli and relaxation times, in units of the caller.
#[derive(Debug, Clone)]
pub struct Maxwell {
    pub equilibrium: f64,
    pub moduli: Vec<f64>,
    pub times: Vec<f64>,
}

impl Maxwell {
    /// Relaxation modulus G(t); t may be infinite.
    pub fn relaxation_modulus(&self, time: f64) -> f64 {
        let decayed = |(g, tau): (&f64, &f64)| g * (-time / tau).exp();
        self.equilibrium + self.moduli.iter().zip(&self.times).map(decayed).sum::<f64>()
    }

    /// Complex modulus G*(omega) = G_inf + sum G_i (i w tau) / (1 + i w tau), as (real, imaginary).
    pub fn complex_modulus(&self, omega: f64) -> (f64, f64) {
        let mut value = (self.equilibrium, 0.0);
        for (&g, &tau) in self.moduli.iter().zip(&self.times) {
            let x = omega * tau;
            value.0 += g * x * x / (1.0 + x * x);
            value.1 += g * x / (1.0 + x * x);
        }
        value
    }

    pub fn magnitude(&self, omega: f64) -> f64 {
        let (storage, loss) = self.complex_modulus(omega);
        storage.hypot(loss)
    }
}

/// sum G_i i w tau_i / (1 + i w tau_i) at many frequencies. Term after term of a block of them, so that the
/// compiler computes several at once; below and above w tau = 1 without overflow.
#[cfg_attr(not(feature = "python"), allow(dead_code))]
pub fn relaxing_moduli(omega: &[f64], moduli: &[f64], times: &[f64]) -> Vec<Complex64> {
    let mut values = Vec::with_capacity(omega.len());
    for block in omega.chunks(BLOCK) {
        let (mut storage, mut loss) = ([0.0; BLOCK], [0.0; BLOCK]);
        for (&g, &tau) in moduli.iter().zip(times) {
            let sums = storage.iter_mut().zip(&mut loss);
            for (&w, (storage, loss)) in block.iter().zip(sums) {
                let phase = w.abs() * tau;
                let smaller = phase.min(1.0 / phase.max(1.0));
                let square = smaller * smaller;
                let part = g / (1.0 + square);
                *storage += if phase > 1.0 { part } else { part * square };
                *loss += part * smaller;
            }
        }
        let sums = storage.iter().zip(&loss).zip(block);
        values.extend(sums.map(|((&s, &l), w)| Complex64::new(s, l.copysign(*w))));
    }
    values
}

/// A along the periodic line for Y = 1 in column 0, which falls linearly to zero in its neighbours.
pub fn recurrence(columns: usize, time: f64) -> Vec<f64> {
    let step = 1.0 / (columns as f64 * time);
    let decay = (-step).exp();
    let mut a = vec![0.0; columns];
    a[0] = arriving(step);
    for column in 1..columns {
        a[column] = decay * a[column - 1] + if column == 1 { leaving(step) } else { 0.0 };
    }
    // The remainder on return to column 0 decays in all further rounds.
    let mut remainder = decay * a[columns - 1] / -(-1.0 / time).exp_m1();
    for value in &mut a {
        *value += remainder;
        remainder *= decay;
    }
    a
}

/// Weight of Y at the end of a step: 1 - (1 - exp(-x)) / x.
pub fn arriving(x: f64) -> f64 {
    if x < 1e-3 {
        x * (0.5 - x * (1.0 / 6.0 - x / 24.0))
    } else {
        1.0 + (-x).exp_m1() / x
    }
}

/// Weight of Y at the beginning of a step: (1 - exp(-x)) / x - exp(-x).
pub fn leaving(x: f64) -> f64 {
    if x < 1e-3 {
        x * (0.5 - x * (1.0 / 3.0 - x / 8.0))
    } else {
        -(-x).exp_m1() / x - (-x).exp()
    }
}

/// int_0^1 u^n exp(-x u) du for n = 0 ... 4.
pub fn decaying_moments(x: f64) -> [f64; 5] {
    if x < 2.0 {
        return [1.0, 2.0, 3.0, 4.0, 5.0].map(|first| series(x, first));
    }
    // By parts; errors shrink by n/x.
    let end = (-x).exp();
    let mut moments = [(1.0 - end) / x; 5];
    for n in 1..5 {
        moments[n] = (n as f64 * moments[n - 1] - end) / x;
    }
    moments
}

/// sum_j (-x)^j / (j! (j + first)); terms fall below round-off within thirty for x < 2.
fn series(x: f64, first: f64) -> f64 {
    let (mut power, mut sum) = (1.0, 0.0);
    for j in 0..30 {
        sum += power / (f64::from(j) + first);
        power *= -x / f64::from(j + 1);
    }
    sum
}
