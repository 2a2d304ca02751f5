//! Whole waves against closed forms (K. L. Johnson, "Contact Mechanics" (1985), section 13.2).

use std::f64::consts::{PI, TAU};

use crate::solution::Outcome;
use crate::status::Status;

use crate::tests::fixture::Case;

fn solved(case: &Case) -> Outcome {
    let finest = case.finest();
    assert_eq!(finest.report.status, Status::Converged);
    finest.outcome
}

/// Westergaard: fraction (2/pi) asin sqrt(p/p*), p* = pi E' A / lambda. Edges are found to about a
/// seventh of the node spacing each, 0.004 of 64 columns together.
#[test]
fn elastic_contact_fraction_is_westergaards() {
    let amplitude = 1e-3;
    let full = 4.0 * PI * amplitude;
    for (ratio, fraction) in [(0.1, 0.2048), (0.3, 0.3690), (0.5, 0.5), (0.8, 0.7048)] {
        for order in [1, 2] {
            let case = Case::elastic(amplitude, ratio * full);
            let outcome = solved(&case.on_mesh(64 / order, 14 / order, order));
            let error = (outcome.contact_fraction - fraction).abs();
            assert!(error < 0.005, "order {order}, p/p* {ratio}: {error}");
            assert!(outcome.friction.abs() < 1e-9);
        }
    }
}

/// mu = k^2 A^2 E'' / (4 (1 - nu^2) p) = k^2 A^2 G'' / p for nu = 1/2, and contact is full.
/// The bulk modulus is high enough that nu = 1/2 holds to 1e-4.
#[test]
fn full_contact_friction_is_that_of_the_loss_modulus() {
    let case = Case::full_contact();
    let outcome = solved(&case);
    let omega = TAU * case.speed;
    let networks = case.moduli.iter().zip(&case.relaxation_times);
    let loss: f64 = networks.map(|(g, t)| g * omega * t / (1.0 + (omega * t).powi(2))).sum();
    let expected = (TAU * case.amplitude).powi(2) * loss / case.pressure;
    assert_eq!(outcome.contact_fraction, 1.0);
    // 64 columns resolve the first harmonic to about (k h)^2 / 6 = 0.2 %.
    let errors =
        [outcome.friction, outcome.friction_from_dissipation].map(|mu| mu / expected - 1.0);
    assert!(errors.iter().all(|e| e.abs() < 0.005), "{errors:?}");
}

/// The last gaps of biquadratic elements under pressures like the modulus: there the averaged compliance
/// opens gaps by tension at short waves, the active sets it predicts cycle, and iteration on them would not end.
/// 29 to 33 steps are needed.
#[test]
fn gaps_close_in_few_steps() {
    for (part, most) in (0..=12).flat_map(|part| [(part, 512.0), (part, 0.0)]) {
        let case = Case::elastic(0.15, 1.93 + 0.01 * f64::from(part)).on_mesh(64, 12, 2);
        let case = case.with_settings([("factored_contacts", most)]);
        let solved = case.solve(None).unwrap();
        let (report, steps) = (&solved.finest.report, solved.counts.iterations);
        assert_eq!(report.status, Status::Converged, "{}", case.pressure);
        assert!(steps <= 50, "{}: {steps} steps", case.pressure);
        let pressures = &solved.finest.outcome.pressure;
        let tension = pressures.iter().fold(0.0_f64, |most, p| most.max(-p));
        assert!(tension <= 1e-8 * pressures.iter().sum::<f64>());
    }
}
