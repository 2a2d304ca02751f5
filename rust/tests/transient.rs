//! Sliding in time ends in the steady state, and a kept factor gives the same run as GMRES.

use std::f64::consts::TAU;

use crate::status::Status;
use crate::transient::{Run, Stage};

use crate::tests::fixture::{energies, Case};

/// Friction and contact fraction of a long run against the steady solution of the same mesh.
#[test]
fn a_long_run_ends_in_the_steady_state() {
    let case = Case::elastic(0.1, 0.3).sliding(1.0, &[(2.0, 0.1)]);
    let steady = case.finest().outcome;
    let stage = Stage { duration: 4.0, speed: 1.0, pressure: case.pressure };
    let run = case.run(&[stage], None).unwrap();
    assert_eq!(run.status, Status::Converged);
    let last = run.moments.last().unwrap();
    assert_eq!(run.moments.len(), 4 * case.columns + 1);
    // Memory linear between 64 columns against its Fourier series: (k h)^2 / 6 = 0.2 %.
    assert!((last.friction / steady.friction - 1.0).abs() < 0.005);
    assert!((last.contact_fraction - steady.contact_fraction).abs() < 0.002);
}

/// Pressed at once, the rubber answers with its glassy modulus; at rest it relaxes to the soft one.
#[test]
fn a_dwell_relaxes_from_the_glassy_to_the_equilibrium_contact() {
    let case = Case::elastic(1e-3, 0.3 * 2.0 * TAU * 1e-3).sliding(1.0, &[(3.0, 1.0)]);
    let stage = Stage { duration: 60.0, speed: 0.0, pressure: case.pressure };
    let run = case.run(&[stage], None).unwrap();
    let mut elastic = case.sliding(0.0, &[(3.0, 1.0)]);
    let soft = elastic.finest().outcome.contact_fraction;
    elastic.equilibrium_modulus = 4.0;
    let stiff = elastic.finest().outcome.contact_fraction;
    let (first, last) = (run.moments[0], run.moments[run.moments.len() - 1]);
    assert!((first.contact_fraction - stiff).abs() < 1e-3);
    assert!((last.contact_fraction - soft).abs() < 1e-3);
    assert!((last.time - 60.0).abs() < 1e-9 && last.friction.abs() < 1e-9);
}

fn lossy() -> Case {
    Case::elastic(0.1, 0.3).sliding(0.0, &[(2.0, 0.1)]).on_mesh(32, 8, 1)
}

/// In static contact the networks are relaxed: a dwell stays there, and sliding on from there ends
/// where sliding from rest does.
#[test]
fn a_run_starts_from_static_contact() {
    let mut case = lossy();
    let start = case.solve(None).unwrap();
    case.speed = 1.0;
    let dwell = Stage { duration: 1.0, speed: 0.0, pressure: case.pressure };
    let slide = Stage { duration: 2.0, speed: 1.0, ..dwell };
    let run = case.run(&[dwell, slide], Some(&start)).unwrap();
    assert_eq!(run.status, Status::Converged);
    let still = start.finest.outcome.contact_fraction;
    for moment in &run.moments[..40] {
        // The state is one of equilibrium: nothing moves but by the residual, 1e-8.
        assert!((moment.contact_fraction - still).abs() < 1e-7 && moment.friction.abs() < 1e-7);
    }
    let from_rest = case.run(&[dwell, slide], None).unwrap();
    let (last, other) = (run.moments.last().unwrap(), from_rest.moments.last().unwrap());
    // After 20 relaxation times nothing is left of the beginning.
    assert!((last.friction - other.friction).abs() < 1e-6 && last.friction > 0.01);
}

/// Pressure, mesh and speed may be others; rubber and profile must be the start's.
#[test]
fn a_start_of_another_rubber_or_profile_is_refused_by_name() {
    let mut case = lossy();
    case.speed = 1.0;
    let start = case.solve(None).unwrap();
    let stage = Stage { duration: 0.1, speed: 2.0, pressure: 1.1 * case.pressure };
    let run = case.clone().on_mesh(16, 6, 1).run(&[stage], Some(&start)).unwrap();
    assert_eq!(run.status, Status::Converged);
    let refusal = |change: fn(&mut Case)| {
        let mut changed = case.clone();
        change(&mut changed);
        changed.run(&[stage], Some(&start)).unwrap_err().to_string()
    };
    let same = "start must be of the same rubber and profile; its";
    assert_eq!(refusal(|c| c.wavelength = 2.0), format!("{same} wavelength is 1.0, not 2.0"));
    assert_eq!(refusal(|c| c.moduli = vec![2.5]), format!("{same} moduli is [2.0], not [2.5]"));
    for (change, name) in [
        ((|c| c.equilibrium_modulus = 1.5) as fn(&mut Case), "equilibrium_modulus"),
        (|c| c.relaxation_times = vec![0.2], "relaxation_times"),
        (|c| c.bulk_modulus = 999.0, "bulk_modulus"),
        (|c| c.amplitude = 0.11, "profile"),
        (|c| c.energy = ("mooney_rivlin", vec![("share", 0.1)]), "strain_energy"),
    ] {
        assert!(refusal(change).starts_with(&format!("{same} {name} is ")), "{name}");
    }
}

/// A state that was never found is nothing to start from.
#[test]
fn a_start_that_did_not_converge_is_refused() {
    let mut case = lossy().with_settings([("max_iterations", 1.0)]);
    case.speed = 1.0;
    let start = case.solve(None).unwrap();
    let stage = Stage { duration: 0.1, speed: 1.0, pressure: case.pressure };
    let refusal = case.run(&[stage], Some(&start)).unwrap_err().to_string();
    assert!(refusal.starts_with("start must be a solution that converged; its status is"));
}

/// Forward, at rest and, more heavily loaded, backward.
fn there_and_back(case: &Case) -> [Stage; 3] {
    let forward = Stage { duration: 0.5, speed: 1.0, pressure: case.pressure };
    let still = Stage { speed: 0.0, ..forward };
    let back = Stage { speed: -2.0, pressure: 1.5 * case.pressure, ..forward };
    [forward, still, back]
}

fn largest_difference(one: &Run, other: &Run) -> f64 {
    assert_eq!((one.status, other.status), (Status::Converged, Status::Converged));
    assert_eq!(one.moments.len(), other.moments.len());
    let pairs = one.moments.iter().zip(&other.moments);
    let apart = pairs.flat_map(|(one, other)| {
        [
            one.friction - other.friction,
            one.contact_fraction - other.contact_fraction,
            one.approach - other.approach,
        ]
    });
    apart.fold(0.0, |most, apart| most.max(apart.abs()))
}

/// Steps by a factor that is kept end where those by GMRES do: both leave 1e-11 of the forces, of
/// which friction, contact and approach of the whole way stay the same to far below the 1e-8 allowed.
/// That few products are left says that it is the factor that solved them.
#[test]
fn a_kept_factor_gives_the_run_of_gmres() {
    for (order, columns, rows) in [(1, 32, 8), (2, 16, 6)] {
        for energy in &energies() {
            let case = Case { energy: energy.clone(), ..lossy().on_mesh(columns, rows, order) };
            let run = |most: f64| {
                let changes = [("residual_tolerance", 1e-11), ("kept_factor_nodes", most)];
                let case = case.clone().with_settings(changes);
                case.run(&there_and_back(&case), None).unwrap()
            };
            let (kept, iterated) = (run(64.0), run(0.0));
            let apart = largest_difference(&kept, &iterated);
            assert!(apart < 1e-8, "{order} {energy:?}: {apart}");
            let (few, many) = (kept.counts.products, iterated.counts.products);
            assert!(5 * few < many, "{order} {energy:?}: {few} products of {many}");
        }
    }
}

/// Where a step would change the strain by more than is allowed, the factor leaves it to the iteration,
/// which cuts it.
#[test]
fn a_kept_factor_gives_up_where_a_step_would_be_cut() {
    let run = |most: f64| {
        let changes =
            [("residual_tolerance", 1e-11), ("largest_step", 0.02), ("kept_factor_nodes", most)];
        let case = lossy().with_settings(changes);
        case.run(&there_and_back(&case), None).unwrap()
    };
    let (kept, iterated) = (run(64.0), run(0.0));
    assert!(largest_difference(&kept, &iterated) < 1e-8);
    let (few, many) = (kept.counts.products, iterated.counts.products);
    assert!(few < many && 5 * few > many, "{few} products of {many}");
}
