//! Memory along a line: complex modulus, recurrence against Fourier, load time.

use std::f64::consts::TAU;

use crate::material::maxwell::{recurrence, relaxing_moduli, Maxwell};
use crate::material::sliding_history::SlidingHistory;

fn rubber() -> Maxwell {
    Maxwell { equilibrium: 1.0, moduli: vec![2.0, 5.0, 3.0], times: vec![0.02, 0.15, 4.0] }
}

/// Weight of Y in column e - m in H in column e, for every m.
fn weights(history: &SlidingHistory) -> Vec<f64> {
    let mut weights = vec![0.0; history.lines.length()];
    history.lines.clone().inverse(&history.spectrum, &mut weights);
    weights
}

/// The weights by the exact recurrence of each Maxwell element from column to column,
///     A_(j+1) = e^-h A_j + leaving(h) Y_j + arriving(h) Y_(j+1),   h = column / (v tau),
/// closed periodically, for Y linear in between: an independent evaluation of second order.
fn weights_by_recurrence(columns: usize, maxwell: &Maxwell, load_time: f64) -> Vec<f64> {
    let mut weights = vec![0.0; columns];
    for (&modulus, &time) in maxwell.moduli.iter().zip(&maxwell.times) {
        let kept = (-load_time / time).exp() / columns as f64;
        for (m, weight) in recurrence(columns, time).into_iter().enumerate() {
            weights[m] += modulus * (weight - kept);
        }
    }
    weights
}

fn apply(weights: &[f64], y: &[f64]) -> Vec<f64> {
    let n = weights.len();
    (0..n).map(|e| (0..n).map(|m| weights[m] * y[(e + n - m) % n]).sum()).collect()
}

/// H of Y = cos(k x) is -(G* - G(t)) of it, up to the local part, which is the same at all harmonics.
#[test]
fn a_harmonic_is_multiplied_by_the_complex_modulus() {
    let (n, maxwell) = (64, rubber());
    let history = SlidingHistory::new(n, &maxwell, f64::INFINITY);
    let multiplier = |harmonic: usize| {
        let y: Vec<f64> = (0..n).map(|e| (TAU * (harmonic * e) as f64 / n as f64).cos()).collect();
        let h = apply(&weights(&history), &y);
        // cos -> (real part) cos - (imaginary part) sin
        (h[0], -h[n / (4 * harmonic)])
    };
    let first = multiplier(1);
    for harmonic in [2, 4, 8] {
        let (real, imaginary) = multiplier(harmonic);
        let (storage, loss) = maxwell.complex_modulus(TAU * harmonic as f64);
        let (storage_1, loss_1) = maxwell.complex_modulus(TAU);
        assert!((real - first.0 + (storage - storage_1)).abs() < 1e-12);
        assert!((imaginary + loss).abs() < 1e-12 && (first.1 + loss_1).abs() < 1e-12);
    }
}

/// In more frequencies than a block, with both signs.
#[test]
fn many_frequencies_have_the_complex_modulus_of_each() {
    let maxwell = rubber();
    let omega: Vec<f64> = (-600..600).map(|k| 0.01 * k as f64).collect();
    let values = relaxing_moduli(&omega, &maxwell.moduli, &maxwell.times);
    for (&w, value) in omega.iter().zip(&values) {
        let (storage, loss) = maxwell.complex_modulus(w);
        assert!((value.re + maxwell.equilibrium - storage).abs() < 1e-14 * storage);
        assert!((value.im - loss).abs() <= 1e-14 * loss.abs());
    }
    let fast = relaxing_moduli(&[1e300], &maxwell.moduli, &maxwell.times)[0];
    assert!((fast.re / maxwell.moduli.iter().sum::<f64>() - 1.0).abs() < 1e-15);
}

/// The two evaluations differ by the square of the column width over the shortest scale.
#[test]
fn recurrence_and_fourier_agree_in_second_order() {
    let maxwell = rubber();
    let difference = |n: usize| {
        let y: Vec<f64> = (0..n).map(|e| (0.5 * (TAU * e as f64 / n as f64).cos()).exp()).collect();
        let a = weights(&SlidingHistory::new(n, &maxwell, 0.4));
        let b = weights_by_recurrence(n, &maxwell, 0.4);
        // The local part is free: compare after removing each field's own multiple of Y.
        let strip = |h: Vec<f64>| {
            let factor = h[0] / y[0];
            h.iter().zip(&y).map(|(h, y)| h - factor * y).collect::<Vec<_>>()
        };
        let (stress_a, stress_b) = (strip(apply(&a, &y)), strip(apply(&b, &y)));
        let apart = stress_a.iter().zip(&stress_b).map(|(a, b)| (a - b).abs());
        apart.fold(0.0, f64::max)
    };
    let (coarse, fine) = (difference(64), difference(128));
    assert!(coarse < 0.02 && fine < 0.3 * coarse, "{coarse} {fine}");
}
