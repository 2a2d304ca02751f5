//! The energy that the temporary networks lose in steady sliding, as a sum that cannot be negative.
//!
//! A strand of network i that was made s ago holds the energy G_i/2 f(s), f = I1 - 3 of the
//! isochoric deformation since, and loses it when it breaks, at the rate 1/tau_i (Green & Tobolsky,
//! J. Chem. Phys. 14 (1946) 80). With as many made as break, the loss per sliding distance is
//!     1/2 sum_i G_i/tau_i^2 int_0^inf exp(-s/tau_i) f(s) ds,   f(s) = Y(x - s) : Cbar(x) - 3 >= 0,
//! s and tau_i in passages; the mean state, loaded for a time only, does no work over a period.
//! f has the period one, so that the images of one passage add up to 1 / (1 - exp(-1/tau_i)).
//!
//! The loss is also the work of the stress on a derivative along x. Where columns do not resolve the wave,
//! that is a small difference of large numbers with an arbitrary result.

use super::maxwell::{decaying_moments, Maxwell};

/// Coefficients of 1, u ... u^4 in one column, u = 0 ... 1.
type Polynomial = [f64; 5];

/// The loss of one passage of f, which is a polynomial in every column.
#[derive(Debug, Clone)]
pub struct Dissipation {
    /// `weights[m]`: loss by the coefficients of column m, counted back from the point.
    weights: Vec<Polynomial>,
}

impl Dissipation {
    /// Exact integrals of the decaying exponentials; times of `maxwell` in passages.
    pub fn new(columns: usize, maxwell: &Maxwell) -> Self {
        let mut weights = vec![[0.0; 5]; columns];
        for (&modulus, &time) in maxwell.moduli.iter().zip(&maxwell.times) {
            let step = 1.0 / (columns as f64 * time);
            if step.is_infinite() {
                continue; // A network that relaxes at once dissipates no energy.
            }
            let images = -(-1.0 / time).exp_m1();
            let moments = decaying_moments(step);
            for (m, weight) in weights.iter_mut().enumerate() {
                let strands = 0.5 * modulus * columns as f64 * (-step * m as f64).exp() / images;
                for (weight, moment) in weight.iter_mut().zip(moments) {
                    *weight += strands * step * (step * moment);
                }
            }
        }
        Self { weights }
    }

    /// How f, integrated over the block, runs between columns, with its value m columns ago in
    /// `strain_since[m]`. On one curve the loss is linear: the losses of parts that add up to f add up to
    /// the loss of f.
    pub fn curve(&self, strain_since: &[f64]) -> Curve {
        Curve::through(strain_since)
    }

    /// The loss of a `part` of the f that the curve was made for.
    pub fn lost_on(&self, curve: &Curve, part: &[f64]) -> f64 {
        let polynomials = (0..part.len()).map(|m| curve.polynomial(part, m));
        let lost = |(polynomial, weight): (Polynomial, &Polynomial)| -> f64 {
            polynomial.iter().zip(weight).map(|(c, w)| c * w).sum()
        };
        polynomials.zip(&self.weights).map(lost).sum()
    }
}

/// The kind of slope that a curve has at a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slope {
    Flat,
    Central,
    ThriceTheRise,
    ThriceTheFall,
}

/// The curve through f, which is nowhere negative if f is not. Next to s = 0, where f and its slope vanish,
/// it is an even function of the distance; elsewhere it is the cubic of values and slopes.
#[derive(Debug, Clone)]
pub struct Curve {
    slopes: Vec<Slope>,
    /// Whether f / m^2 at m = 0 is positive; otherwise it is set to zero.
    bends: bool,
}

impl Curve {
    /// Slopes of fourth order, limited so that the cubics stay between their ends (Hyman, SIAM J.
    /// Sci. Stat. Comput. 4 (1983) 645).
    fn through(f: &[f64]) -> Self {
        let slopes = (0..f.len()).map(|m| limited(f, m)).collect();
        let bends = bend_at_zero(f) > 0.0;
        Self { slopes, bends }
    }

    fn polynomial(&self, f: &[f64], m: usize) -> Polynomial {
        let last = f.len() - 1;
        let bend = if self.bends { bend_at_zero(f) } else { 0.0 };
        if m == 0 {
            return [0.0, 0.0, bend, 0.0, f[1] - bend];
        }
        if m == last {
            // bend (1 - u)^2 + rest (1 - u)^4
            let rest = f[last] - bend;
            let (linear, square) = (-2.0 * bend - 4.0 * rest, bend + 6.0 * rest);
            return [f[last], linear, square, -4.0 * rest, rest];
        }
        let rise = f[m + 1] - f[m];
        let (from, to) = (self.slope(f, m), self.slope(f, m + 1));
        let (square, cube) = (3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise);
        [f[m], from, square, cube, 0.0]
    }

    fn slope(&self, f: &[f64], m: usize) -> f64 {
        let (rise, fall) = steps(f, m);
        match self.slopes[m] {
            Slope::Flat => 0.0,
            Slope::Central => central(f, m),
            Slope::ThriceTheRise => 3.0 * rise,
            Slope::ThriceTheFall => 3.0 * fall,
        }
    }
}

/// f / m^2 at m = 0, where f and its slope vanish: an even function to fourth order, from both sides.
fn bend_at_zero(f: &[f64]) -> f64 {
    let n = f.len();
    let (near, far) = (0.5 * (f[1] + f[n - 1]), 0.125 * (f[2] + f[n - 2]));
    (4.0 * near - far) / 3.0
}

fn limited(f: &[f64], m: usize) -> Slope {
    let ((rise, fall), up) = (steps(f, m), central(f, m));
    if rise * fall <= 0.0 || rise * up <= 0.0 {
        return Slope::Flat;
    }
    if up.abs() <= 3.0 * rise.abs().min(fall.abs()) {
        Slope::Central
    } else if rise.abs() < fall.abs() {
        Slope::ThriceTheRise
    } else {
        Slope::ThriceTheFall
    }
}

/// Change of f from column m to the next, and from the previous one to m.
fn steps(f: &[f64], m: usize) -> (f64, f64) {
    let n = f.len();
    (f[(m + 1) % n] - f[m], f[m] - f[(m + n - 1) % n])
}

fn central(f: &[f64], m: usize) -> f64 {
    let n = f.len();
    let at = |ahead: usize| f[(m + ahead) % n];
    (8.0 * (at(1) - at(n - 1)) - (at(2) - at(n - 2))) / 12.0
}
