//! Energy lost by the networks: closed form of a harmonic, recurrence, and never below zero.

use std::f64::consts::TAU;

use crate::fem::block::{Block, Memory};
use crate::material::dissipation::Dissipation;
use crate::material::kinematics::{contract, isochoric, remembered, Gradient, Symmetric};
use crate::material::maxwell::{decaying_moments, recurrence, Maxwell};

use crate::tests::fixture::{energy, mesh, noise, serial, Case};

/// From networks that forget within a column to ones that hardly relax in a passage.
fn rubber() -> Maxwell {
    Maxwell {
        equilibrium: 1.0,
        moduli: vec![300.0, 40.0, 5.0, 2.0, 1.0],
        times: vec![1e-6, 1e-3, 0.05, 1.0, 1e5],
    }
}

/// The loss for f, the strain since m columns ago in `f[m]`.
fn lost(dissipation: &Dissipation, f: &[f64]) -> f64 {
    dissipation.lost_on(&dissipation.curve(f), f)
}

/// Gauss-Legendre sums of three points on a thousand intervals are right to round-off for x < 100.
#[test]
fn moments_are_the_integrals() {
    for x in [1e-9, 0.3, 1.999, 2.001, 30.0, 90.0] {
        let mut sums = [0.0; 5];
        for i in 0..1000 {
            for (at, weight) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
                let u = (i as f64 + 0.5 + 0.5 * at) / 1000.0;
                for (n, sum) in sums.iter_mut().enumerate() {
                    *sum += weight / 18e3 * u.powi(n as i32) * (-x * u).exp();
                }
            }
        }
        for (moment, sum) in decaying_moments(x).into_iter().zip(sums) {
            assert!((moment / sum - 1.0).abs() < 1e-11, "{x}: {moment} {sum}");
        }
    }
}

/// f = a (1 - cos kx) loses a/2 k G''(k v), to the fourth power of the column (asked: the third)
/// where networks forget within the passage; in longer memories the cubics held flat at the crest
/// cost the third.
#[test]
fn a_harmonic_loses_by_the_loss_modulus() {
    let mut maxwell = rubber();
    let error = |maxwell: &Maxwell, columns: usize, harmonic: f64| {
        let angle = |m: usize| TAU * harmonic * m as f64 / columns as f64;
        let f: Vec<f64> = (0..columns).map(|m| 3.0 * (1.0 - angle(m).cos())).collect();
        let omega = TAU * harmonic;
        let expected = 1.5 * omega * maxwell.complex_modulus(omega).1;
        lost(&Dissipation::new(columns, maxwell), &f) / expected - 1.0
    };
    let all = error(&maxwell, 64, 1.0).abs();
    assert!(all < 2e-5, "{all}");
    let eight_columns = error(&maxwell, 64, 8.0).abs();
    assert!(eight_columns < 7e-3, "{eight_columns}");
    maxwell.moduli.truncate(3);
    maxwell.times.truncate(3);
    let (coarse, fine) = (error(&maxwell, 32, 1.0).abs(), error(&maxwell, 64, 1.0).abs());
    assert!(coarse < 1e-5 && fine < coarse / 8.0, "{coarse} {fine}");
}

/// The states A_i from column to column, for Y linear in between, lose G_i/2 (A_i : Cbar - 3) / tau_i.
#[test]
fn the_loss_is_that_of_the_networks_states() {
    let maxwell =
        Maxwell { equilibrium: 1.0, moduli: vec![2.0, 5.0, 3.0], times: vec![0.02, 0.15, 4.0] };
    let difference = |n: usize| {
        let gradients: Vec<Gradient> = (0..n).map(|e| gradient(e as f64 / n as f64)).collect();
        let y: Vec<Symmetric> = gradients.iter().map(remembered).collect();
        let c: Vec<Symmetric> = gradients.iter().map(isochoric).collect();
        let mut expected = 0.0;
        for (modulus, &time) in maxwell.moduli.iter().zip(&maxwell.times) {
            let weights = recurrence(n, time);
            for (e, c) in c.iter().enumerate() {
                let strands = (0..n).map(|m| weights[m] * (contract(&y[(e + n - m) % n], c) - 3.0));
                expected += 0.5 * modulus / time * strands.sum::<f64>() / n as f64;
            }
        }
        let since = |m: usize| {
            let along = (0..n).map(|e| contract(&y[(e + n - m) % n], &c[e]) - 3.0);
            along.sum::<f64>() / n as f64
        };
        let f: Vec<f64> = (0..n).map(since).collect();
        lost(&Dissipation::new(n, &maxwell), &f) / expected - 1.0
    };
    let (coarse, fine) = (difference(64), difference(128));
    assert!(coarse.abs() < 0.02 && fine.abs() < 0.3 * coarse.abs(), "{coarse} {fine}");
}

/// Large strain along a line, not quite incompressible.
fn gradient(x: f64) -> Gradient {
    let (sin, cos) = (TAU * x).sin_cos();
    let stretch = (0.6 * cos).exp();
    [stretch, 0.8 * sin, 0.0, 1.02 / stretch]
}

/// Where no mesh follows the field: noise from point to point, and a glassy modulus of hundreds.
#[test]
fn a_field_without_structure_loses_energy() {
    for order in [1, 2] {
        let mesh = mesh(12, 3, 1.0, order);
        let block = Block {
            mesh: &mesh,
            energy: energy("neo_hookean", &[]),
            equilibrium: 1.0,
            memory: &Memory::Relaxed,
            bulk_modulus: 100.0,
        };
        for seed in 0..40 {
            let size = mesh.layers() * mesh.layer_size();
            let u: Vec<f64> = (0..size).map(|i| 0.004 * noise(seed * size + i)).collect();
            let rows: Vec<_> = (0..mesh.rows).map(|row| block.row_state(row, &u)).collect();
            let since = block.strain_since(&rows, &serial()).unwrap().whole;
            assert_eq!(since[0], 0.0);
            assert!(since[1..].iter().all(|&f| f > 0.0), "{since:?}");
            for time in [1e-9, 1e-3, 0.1, 10.0, 1e9] {
                let maxwell = Maxwell { equilibrium: 1.0, moduli: vec![1.0], times: vec![time] };
                assert!(lost(&Dissipation::new(12, &maxwell), &since) > 0.0);
            }
        }
    }
}

/// strain_since is the integral of Y : Cbar - 3, here for strains of 1e-9, whose squares a
/// difference from 3 could not hold: a uniform harmonic shear has 4 strain^2 (1 - cos) sums.
#[test]
fn small_strains_keep_their_digits() {
    let (columns, strain) = (16, 1e-9);
    let mesh = mesh(columns, 2, 1.0, 1);
    let memory = Memory::Relaxed;
    let block = Block {
        mesh: &mesh,
        energy: energy("neo_hookean", &[]),
        equilibrium: 1.0,
        memory: &memory,
        bulk_modulus: 100.0,
    };
    let angle = |m: usize| TAU * m as f64 / columns as f64;
    // Vertical displacement along x alone: c12 = dw/dx, constant in a bilinear element.
    let mut u = vec![0.0; mesh.layers() * mesh.layer_size()];
    for layer in 0..mesh.layers() {
        for node in 0..columns {
            let at = layer * mesh.layer_size() + mesh.position(node, 1);
            u[at] = strain * angle(node).sin() / TAU;
        }
    }
    let rows: Vec<_> = (0..mesh.rows).map(|row| block.row_state(row, &u)).collect();
    let half = 0.5 * angle(1);
    let slope = strain * half.sin() / half;
    let since = block.strain_since(&rows, &serial()).unwrap().whole;
    for (m, since) in since.into_iter().enumerate().skip(1) {
        // y12 = -c12: the mean of (c12(x) - c12(x - m))^2 = slope^2 (1 - cos).
        let expected = slope * slope * (1.0 - angle(m).cos());
        assert!((since / expected - 1.0).abs() < 1e-6, "{m}: {since} {expected}");
    }
}

/// Tenfold stiffening over the harmonics and stretches of 0.15 to 2.6, which 32 columns cannot
/// follow: the frictions are a third apart, and not of different sign or size.
#[test]
fn friction_from_dissipation_stays_of_the_size_of_friction() {
    let networks = (0..8).map(|i| (0.6 * 2.0_f64.powi(i), 10.0_f64.powi(-i)));
    let case = Case::elastic(0.6, 2.0).sliding(1.0, &networks.collect::<Vec<_>>());
    let case = case.on_mesh(32, 8, 1).with_settings([("finest_columns", 32.0)]);
    let outcome = Case { load_time: 5.0, ..case }.finest().outcome;
    let ratio = outcome.friction_from_dissipation / outcome.friction;
    assert!(outcome.max_stretch > 2.0 && ratio > 1.0 && ratio < 1.5, "{ratio}");
}

/// On one curve the loss is linear: whatever f is cut into, smooth or noise with limited slopes, the
/// parts lose what f loses.
#[test]
fn parts_of_the_strain_lose_the_whole() {
    let n = 24;
    let part = |seed: usize| -> Vec<f64> {
        let bumps = |m: usize| (TAU * m as f64 / n as f64).sin().powi(2) + noise(seed * n + m);
        (0..n).map(|m| if m == 0 { 0.0 } else { bumps(m) }).collect()
    };
    let parts: Vec<Vec<f64>> = (1..6).map(part).collect();
    let whole: Vec<f64> = (0..n).map(|m| parts.iter().map(|part| part[m]).sum()).collect();
    let dissipation = Dissipation::new(n, &rubber());
    let curve = dissipation.curve(&whole);
    let sum: f64 = parts.iter().map(|part| dissipation.lost_on(&curve, part)).sum();
    let alone: f64 = parts.iter().map(|part| lost(&dissipation, part)).sum();
    let expected = lost(&dissipation, &whole);
    assert!((sum / expected - 1.0).abs() < 1e-12, "{sum} {expected}");
    assert!((alone / expected - 1.0).abs() > 1e-3, "{alone} {expected}");
}

/// Full contact at small slope: the half-plane loses (k z)^2 exp(-2 k z) of depth, 3/(2 k) on the mean
/// (K. L. Johnson, "Contact Mechanics" (1985), section 13.2); rows of a finite height put it deeper.
#[test]
fn energy_is_lost_as_deep_as_under_a_half_plane() {
    let mean_depth = |columns: usize, rows: usize| {
        let finest = Case::full_contact().on_mesh(columns, rows, 1).finest();
        let (outcome, middles) = (finest.outcome, finest.mesh.row_middles());
        let rows = outcome.lost_by_row;
        assert!(rows.iter().all(|&lost| lost >= 0.0), "{rows:?}");
        let sum: f64 = rows.iter().sum();
        assert!((sum / outcome.friction_from_dissipation - 1.0).abs() < 1e-12);
        rows.iter().zip(middles).map(|(lost, z)| lost * z).sum::<f64>() / sum
    };
    let errors = [(32, 9), (64, 14), (128, 21)].map(|(c, r)| mean_depth(c, r) * TAU / 1.5 - 1.0);
    let halved = errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1];
    assert!(halved && errors[2].abs() < 0.01, "{errors:?}");
}
