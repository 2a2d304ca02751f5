//! Strain energies: derivatives against finite differences of W, written-out forms, refusals.

use crate::material::energy::{
    Energy, Invariants, Kraus, MooneyRivlin, NeoHookean, Parameters, StrainEnergy, Yeoh,
};
use crate::material::kinematics::{contract, isochoric, jacobian};
use crate::material::stress::{memory_slope, stress, tangent};

use super::material_point::{moved, CLOSE, F, STEP};
use crate::tests::fixture::{energy, new_energy};

/// Every energy of the list, its parameters 0.3, 0.15, 0.1 ...
fn all() -> Vec<Energy> {
    let kind = |&(kind, names): &(&str, &[&'static str])| {
        let values = (1..).map(|i| 0.3 / f64::from(i));
        let parameters: Vec<_> = names.iter().copied().zip(values).collect();
        energy(kind, &parameters)
    };
    Energy::KINDS.iter().map(kind).collect()
}

/// P = dW/dF and dP/dF, both by central differences of W + p (J - 1) and of P.
#[test]
fn stress_and_tangent_are_the_slopes_of_the_energy() {
    for energy in all() {
        let p = |f: &[f64; 4]| stress(f, &energy.network(f), 0.7);
        let density = |f: &[f64; 4]| energy.density(f) + 0.7 * (jacobian(f) - 1.0);
        let slope = energy.network_slope(&F).unwrap_or_default();
        let (fixed, by_h) = (tangent(&F, &energy.network(&F), 0.7), memory_slope(&F));
        for k in 0..4 {
            let (high, low) = (moved(&F, k, STEP), moved(&F, k, -STEP));
            let difference = (density(&high) - density(&low)) / (2.0 * STEP);
            assert!((p(&F)[k] - difference).abs() < CLOSE, "{energy:?}");
            for a in 0..4 {
                let whole: f64 = (0..4).map(|c| by_h[a][c] * slope[c][k]).sum();
                let difference = (p(&high)[a] - p(&low)[a]) / (2.0 * STEP);
                assert!((fixed[a][k] + whole - difference).abs() < CLOSE, "{energy:?}");
            }
        }
    }
}

fn check_invariant_slopes<E: StrainEnergy>(energy: &E) {
    let at: Invariants = [4.1, 3.7];
    let by = |i: usize, step: f64| {
        let mut moved = at;
        moved[i] += step;
        moved
    };
    let [w11, w12, w22] = energy.curvatures(at);
    for (i, seconds) in [[w11, w12], [w12, w22]].into_iter().enumerate() {
        let (high, low) = (by(i, STEP), by(i, -STEP));
        let first = (energy.density(high) - energy.density(low)) / (2.0 * STEP);
        assert!((energy.slopes(at)[i] - first).abs() < CLOSE);
        for j in 0..2 {
            let second = (energy.slopes(high)[j] - energy.slopes(low)[j]) / (2.0 * STEP);
            assert!((seconds[j] - second).abs() < CLOSE);
        }
    }
}

/// W_1, W_2 and W_11, W_12, W_22, where the plane-strain F alone could not tell I1 from I2.
#[test]
fn derivatives_by_the_invariants_are_those_of_the_density() {
    let values = |names: &[(&str, f64)]| -> Parameters {
        names.iter().map(|&(n, v)| (n.to_owned(), v)).collect()
    };
    check_invariant_slopes(&NeoHookean);
    check_invariant_slopes(&MooneyRivlin::new(&values(&[("share", 0.4)])).unwrap());
    let yeoh = values(&[("second", -0.2), ("third", 0.05)]);
    check_invariant_slopes(&Yeoh::new(&yeoh).unwrap());
    let kraus = values(&[("ratio", 0.2), ("critical", 0.1), ("measured_at", 0.01)]);
    check_invariant_slopes(&Kraus::new(&kraus).unwrap());
}

/// All have the same shear modulus at small strain: 2 (W_1 + W_2) = 1, and W = 0 at rest.
#[test]
fn the_shear_modulus_at_rest_is_one() {
    for energy in all() {
        let rest = [1.0, 0.0, 0.0, 1.0];
        assert!(energy.density(&rest).abs() < 1e-15, "{energy:?}");
        // tau = G gamma for a small shear.
        let sheared = [1.0, 1e-6, 0.0, 1.0];
        let p = stress(&sheared, &energy.network(&sheared), 0.0);
        assert!((p[1] / 1e-6 - 1.0).abs() < CLOSE, "{energy:?}");
    }
}

/// The densities written out here, parameter by parameter.
#[test]
fn densities_are_the_published_ones() {
    let c = isochoric(&F);
    let i1 = c[0] + c[1] + c[3];
    let (first, second) = (i1 - 3.0, 0.5 * (i1 * i1 - contract(&c, &c)) - 3.0);
    for (energy, expected) in [
        (energy("neo_hookean", &[]), 0.5 * first),
        (energy("mooney_rivlin", &[("share", 0.4)]), 0.3 * first + 0.2 * second),
        (
            energy("yeoh", &[("second", -0.2), ("third", 0.05)]),
            0.5 * (first - 0.2 * first.powi(2) + 0.05 * first.powi(3)),
        ),
    ] {
        assert!((energy.density(&F) - expected).abs() < 1e-14, "{energy:?}");
    }
}

/// Half of what breaks is broken at the critical shear: nominal stress G s (r + (1 - r)/2), for `measured_at`
/// far below.
#[test]
fn kraus_keeps_half_at_the_critical_strain() {
    let s = 0.3;
    let f = [1.0, s, 0.0, 1.0];
    let kraus = energy("kraus", &[("ratio", 0.2), ("critical", s), ("measured_at", 1e-9)]);
    let shear = stress(&f, &kraus.network(&f), 0.0)[1];
    assert!((shear / s - 0.6).abs() < 1e-8);
}

#[test]
fn names_and_values_are_refused_in_words() {
    let refusal = |kind: &str, parameters: &[(&str, f64)]| {
        new_energy(kind, parameters).unwrap_err().to_string()
    };
    for (kind, parameters, text) in [
        (
            "ogden",
            &[][..],
            "strain_energy must be one of neo_hookean, mooney_rivlin, yeoh, isihara, kraus; got \"ogden\"",
        ),
        (
            "yeoh",
            &[("second", 0.1)],
            "yeoh must have the parameter \"third\"",
        ),
        (
            "neo_hookean",
            &[("share", 0.1)],
            "a parameter of neo_hookean must be left out: there is none; got \"share\"",
        ),
        (
            "mooney_rivlin",
            &[("share", 1.1)],
            "share must be zero or more and at most 1; got 1.1",
        ),
        (
            "yeoh",
            &[("second", f64::NAN), ("third", 0.0)],
            "second must be a finite number; got NaN",
        ),
    ] {
        assert_eq!(refusal(kind, parameters), text);
    }
}
