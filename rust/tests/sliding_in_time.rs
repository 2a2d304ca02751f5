//! Stepping in time with the recurrence's own memory lands on the steady state of the same memory.

use std::f64::consts::TAU;

use gripscale_kernel::newton::Ending;
use gripscale_kernel::transient::Stage;

use crate::whole_wave::scale;

/// Friction and contact fraction of a long run against the steady solution of the same mesh.
#[test]
fn a_long_run_ends_in_the_steady_state() {
    let mut case = scale(0.1, 0.3);
    case.speed = 1.0;
    case.moduli = vec![2.0];
    case.relaxation_times = vec![0.1];
    let steady = case.solve(None).unwrap();
    let stage = Stage {
        duration: 4.0,
        speed: 1.0,
        pressure: case.pressure,
    };
    let run = case.run(&[stage], None).unwrap();
    assert_eq!(run.report.ending, Ending::Converged);
    let last = run.moments.last().unwrap();
    assert_eq!(run.moments.len(), 4 * case.columns + 1);
    // Memory linear between 64 columns against its Fourier series: (k h)^2 / 6 = 0.2 %.
    assert!((last.friction / steady.outcome.friction - 1.0).abs() < 0.005);
    assert!((last.contact_fraction - steady.outcome.contact_fraction).abs() < 0.002);
}

/// Pressed at once, the rubber answers with its glassy modulus; at rest it relaxes to the soft one.
#[test]
fn a_dwell_relaxes_from_the_glassy_to_the_equilibrium_contact() {
    let mut case = scale(1e-3, 0.3 * 2.0 * TAU * 1e-3);
    case.moduli = vec![3.0];
    case.relaxation_times = vec![1.0];
    case.speed = 1.0;
    let stage = Stage {
        duration: 60.0,
        speed: 0.0,
        pressure: case.pressure,
    };
    let run = case.run(&[stage], None).unwrap();
    let mut elastic = case.clone();
    elastic.speed = 0.0;
    let soft = elastic.solve(None).unwrap().outcome.contact_fraction;
    elastic.equilibrium_modulus = 4.0;
    let stiff = elastic.solve(None).unwrap().outcome.contact_fraction;
    let (first, last) = (run.moments[0], run.moments[run.moments.len() - 1]);
    assert!((first.contact_fraction - stiff).abs() < 1e-3);
    assert!((last.contact_fraction - soft).abs() < 1e-3);
    assert!((last.time - 60.0).abs() < 1e-9 && last.friction.abs() < 1e-9);
}
