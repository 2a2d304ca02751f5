//! The material at a point: derivatives against finite differences, closed forms.

use crate::material::kinematics::{remembered, UNIT};
use crate::material::maxwell::Maxwell;
use crate::material::stress::{memory_slope, stress, tangent};
use crate::tests::fixture::noise;

pub const F: [f64; 4] = [1.3, 0.4, -0.25, 0.7];
const H: [f64; 4] = [1.2, 0.8, -0.3, 1.1];
pub const STEP: f64 = 1e-6;

/// Central differences of smooth functions at step 1e-6 are right to about 1e-9.
pub const CLOSE: f64 = 1e-8;

pub fn moved(f: &[f64; 4], k: usize, by: f64) -> [f64; 4] {
    let mut out = *f;
    out[k] += by;
    out
}

/// By the strain, and by the memory.
#[test]
fn slopes_of_the_stress_equal_finite_differences() {
    let (by_f, by_h) = (tangent(&F, &H, 0.7), memory_slope(&F));
    for k in 0..4 {
        let [high, low] = [STEP, -STEP].map(|by| stress(&moved(&F, k, by), &H, 0.7));
        let [up, down] = [STEP, -STEP].map(|by| stress(&F, &moved(&H, k, by), 0.7));
        for a in 0..4 {
            assert!((by_f[a][k] - (high[a] - low[a]) / (2.0 * STEP)).abs() < CLOSE);
            assert!((by_h[a][k] - (up[a] - down[a]) / (2.0 * STEP)).abs() < CLOSE);
        }
    }
}

#[test]
fn a_remembered_local_state_makes_no_stress() {
    for index in 0..20 {
        let f = [0, 1, 2, 3].map(|k| [1.0, 0.0, 0.0, 1.0][k] + 0.3 * noise(4 * index + k));
        let p = stress(&f, &remembered(&f), 0.0);
        assert!(p.iter().all(|value| value.abs() < 1e-14));
    }
}

#[test]
fn stress_turns_with_the_material() {
    let (sine, cosine) = 0.6_f64.sin_cos();
    let turn = |t: &[f64; 4]| {
        [
            cosine * t[0] - sine * t[2],
            cosine * t[1] - sine * t[3],
            sine * t[0] + cosine * t[2],
            sine * t[1] + cosine * t[3],
        ]
    };
    let turned = stress(&turn(&F), &H, 0.4);
    let expected = turn(&stress(&F, &H, 0.4));
    for k in 0..4 {
        assert!((turned[k] - expected[k]).abs() < 1e-14);
    }
}

/// Plane-strain step to stretch s with free sides: nominal stress G(t) (s - s^-3), incompressible.
/// After a step at time zero A_i = (1 - e_i) Y + e_i I, so that H = G(t) I up to multiples of Y.
#[test]
fn step_relaxation_follows_the_closed_form() {
    let maxwell = Maxwell { equilibrium: 1.0, moduli: vec![3.0, 5.0], times: vec![0.1, 2.0] };
    let s: f64 = 1.7;
    let f = [s, 0.0, 0.0, 1.0 / s];
    let y = remembered(&f);
    for time in [0.0, 0.05, 1.0, 10.0] {
        let mut h = UNIT;
        for (modulus, tau) in maxwell.moduli.iter().zip(&maxwell.times) {
            let e = (-time / tau).exp();
            for k in 0..4 {
                h[k] += modulus * ((1.0 - e) * y[k] + e * UNIT[k]);
            }
        }
        // The side is free: choose the pressure so that P22 vanishes.
        let pressure = -stress(&f, &h, 0.0)[3] / s;
        let nominal = stress(&f, &h, pressure)[0];
        let expected = maxwell.relaxation_modulus(time) * (s - s.powi(-3));
        assert!((nominal - expected).abs() < 1e-13 * expected);
    }
}
