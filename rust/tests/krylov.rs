//! The linearised problem solved by iteration leads to the discrete solution that elimination leads to.

use std::f64::consts::TAU;

use crate::status::Status;

use crate::tests::fixture::{energies, noise, Case};

/// Friction, contact fraction, approach and largest pressure of `wave(0)`, `wave(1)` ... by dense
/// elimination of the node layers with the exact compliance of the surface (revision b333c5b of this
/// repository, which still had it, and contact at the nodes), iterated to residuals of 1e-11.
const ELIMINATED: &str = include_str!("eliminated.txt");

/// Waves of every kind: both orders, static and sliding, sines and profiles of several crests, three
/// energies, slopes to 0.27 and moduli from nearly elastic to very lossy.
fn wave(number: usize) -> Case {
    let share = |which: usize| 0.5 * (1.0 + noise(900 + 16 * number + which));
    let order = 1 + number % 2;
    let mut case = Case::elastic(0.03 + 0.24 * share(0), 0.0);
    (case.columns, case.rows, case.order) = (52 / order, 12 / order, order);
    if number == 23 {
        // Elimination did not carry this load on half the columns, and went on to these.
        (case.columns, case.rows) = (52, 9);
    }
    case.energy = energies()[number / 2 % 3].clone();
    case.bulk_modulus = 10.0_f64.powf(2.0 + 1.5 * share(1));
    let mut stiffness = 1.0;
    if number % 5 != 4 {
        case.speed = 1.0;
        case.moduli = vec![4.0 * share(2), 3.0 * share(3)];
        case.relaxation_times = vec![0.02 + 0.2 * share(4), 0.3 + share(5)];
        case.load_time = [1.0, 5.0, f64::INFINITY][number % 3];
        stiffness += 0.5 * case.moduli.iter().sum::<f64>();
    }
    case.pressure = case.amplitude * stiffness * (1.0 + 7.0 * share(6));
    if number % 4 >= 2 {
        let height = |x: f64| {
            let crest = |n: f64, which: usize| (n * TAU * x + TAU * share(which)).cos() / n;
            0.6 * case.amplitude * (crest(1.0, 7) + crest(2.0, 8) + 0.7 * crest(4.0, 9))
        };
        case.heights = Some((0..32).map(|i| height(f64::from(i) / 32.0)).collect());
    }
    case
}

fn figures(number: usize, factored_contacts: f64) -> [f64; 4] {
    let changes = [
        ("residual_tolerance", 1e-11),
        ("factored_contacts", factored_contacts),
        ("profile_patches", 0.0),
    ];
    let finest = wave(number).with_settings(changes).finest();
    assert_eq!(finest.report.status, Status::Converged, "wave {number}");
    let approach = finest.state.approach;
    let outcome = finest.outcome;
    let highest = outcome.pressure.iter().fold(0.0_f64, |most, &p| most.max(p));
    [outcome.friction, outcome.contact_fraction, approach, highest]
}

/// Residuals of 1e-11 are far below the 1e-8 allowed to figures of order one hundredth to one. The nodes
/// in contact by a factor, as so few are, and by iteration, as many are.
#[test]
fn waves_are_those_of_dense_elimination() {
    for factored_contacts in [512.0, 0.0] {
        for (number, line) in ELIMINATED.lines().enumerate() {
            let values = figures(number, factored_contacts);
            for (figure, text) in values.into_iter().zip(line.split(' ')) {
                let expected: f64 = text.parse().unwrap();
                let error = (figure - expected).abs();
                assert!(
                    error < 1e-8 * expected.abs().max(0.01),
                    "wave {number}: {values:?}, {line}, contacts factored to {factored_contacts}"
                );
            }
        }
    }
}

/// A rubber of short relaxation times at stretches to 1.7, from half the columns: some 15 products a
/// Newton step. With the mean of dP/dH times that of dY/dF in the preconditioner they were 28, 122 and 400
/// on 256, 512 and 1024 columns.
#[test]
fn finer_meshes_take_no_more_products() {
    let mut case = Case::elastic(0.168, 3.0).sliding(1.0, &[(30.0, 1e-3)]).on_mesh(256, 27, 1);
    case.load_time = 10.0;
    let coarse = case.solve(None).unwrap();
    let fine = case.on_mesh(512, 41, 1).solve(Some(&coarse)).unwrap();
    assert_eq!(fine.finest.report.status, Status::Converged);
    let counts = fine.counts;
    assert!(
        counts.products <= 20 * counts.iterations,
        "{} products, {} steps",
        counts.products,
        counts.iterations
    );
}
