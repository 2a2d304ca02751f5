//! The sequence of meshes: never empty from any input, and an empty one is an error of its own.

use crate::contact::profile::Heights;
use crate::error::KernelError;
use crate::fem::mesh::Mesh;
use crate::problem::MeshSize;
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solve::error_estimator::ErrorEstimator;
use crate::solve::mesh_sequence::MeshSequence;
use crate::status::Status;

use crate::tests::fixture::Case;

#[test]
fn an_empty_sequence_is_an_internal_error() {
    let sequence = MeshSequence { sizes: vec![], required: 0, below: None };
    let result = sequence.solve(&estimator(None), |_, _| unreachable!());
    let error = result.map(|_| ()).unwrap_err();
    assert!(matches!(error, KernelError::Internal(_)));
    let text = error.to_string();
    assert!(text.starts_with("internal error: ") && text.ends_with("please report it"));
}

/// A start on a mesh beyond the finest that the tolerance may refine to: two meshes remain, which
/// tell the error.
#[test]
fn a_start_on_a_much_finer_mesh_leaves_two() {
    let mut case = Case::elastic(0.05, 0.2).on_mesh(256, 14, 1);
    let start = case.solve(None).unwrap();
    case = case.on_mesh(64, 14, 1).with_settings([("finest_columns", 64.0)]);
    case.tolerance = Some(1e-3);
    let solution = case.solve(Some(&start)).unwrap();
    assert_eq!(solution.finest.mesh.columns, 64);
    assert!(solution.finest.contact_fraction_error > 1e-3);
}

fn sine() -> Heights {
    Heights::sine(0.05).unwrap()
}

fn estimator(tolerance: Option<f64>) -> ErrorEstimator {
    ErrorEstimator::new(&sine(), true, tolerance, &Settings::default())
}

fn sequence(finest: usize, tolerance: Option<f64>, start: Option<&Solution>) -> MeshSequence {
    let size = MeshSize::new(finest, 12, 1.5, 1).unwrap();
    let first = start.map(|solution| &solution.finest);
    MeshSequence::new(&size, first, &sine(), &estimator(tolerance))
}

/// Columns of the meshes of a sequence, coarsest first, without those solved only if needed.
fn visited(finest: usize, tolerance: Option<f64>, start: Option<&Solution>) -> Vec<usize> {
    let sequence = sequence(finest, tolerance, start);
    let columns = sequence.sizes.iter().map(|size| Mesh::new(size).columns);
    match tolerance {
        Some(_) => columns.collect(),
        None => columns.take(sequence.required).collect(),
    }
}

#[test]
fn any_number_of_columns_has_a_coarser_mesh_to_be_judged_by() {
    let refined = [32, 64, 128, 256, 512, 1024, 2048];
    assert_eq!(visited(128, Some(0.01), None), refined);
    assert_eq!(visited(128, None, None), [32, 64, 128]);
    assert_eq!(visited(100, None, None), [50, 100]);
    assert_eq!(visited(100, Some(0.01), None), [50, 100, 200, 400, 800, 1600]);
    assert_eq!(visited(258, Some(0.01), None), [33, 65, 129, 258, 516, 1032]);
    assert_eq!(visited(258, None, None), [33, 65, 129, 258]);
    assert_eq!(visited(63, None, None), [32, 63]);
    assert_eq!(visited(48, None, None), [24, 48]);
    assert_eq!(visited(15, None, None), [8, 15]);
    assert_eq!(visited(14, None, None), [14]);
    assert_eq!(visited(1023, Some(0.01), None), [32, 64, 128, 256, 512, 1023, 2046]);
}

/// A start leaves two of the meshes that must be solved, and all that may follow them.
#[test]
fn a_start_needs_two_meshes() {
    let start = Case::elastic(0.05, 0.2).on_mesh(32, 8, 1).solve(None).unwrap();
    for columns in [65, 127, 128] {
        let sizes = visited(columns, None, Some(&start));
        assert_eq!(sizes, [columns.div_ceil(2), columns]);
    }
    assert_eq!(sequence(128, None, Some(&start)).sizes.len(), 3);
}

/// Errors fall to a quarter at most where columns are doubled, so a start that is good to 0.9 of the
/// tolerance says nothing about coarser meshes; one good to a fifth says that half of its columns suffice.
#[test]
fn a_start_much_better_than_the_tolerance_is_not_refined_to() {
    let mut start = Case::elastic(0.05, 0.2).on_mesh(256, 14, 1).solve(None).unwrap();
    start.finest.friction_error = 0.0;
    let mut good_to = |error: f64| {
        start.finest.contact_fraction_error = error;
        visited(128, Some(0.01), Some(&start))
    };
    assert_eq!(good_to(0.009), [128, 256, 512, 1024, 2048]);
    assert_eq!(good_to(0.002), [64, 128, 256, 512, 1024, 2048]);
    let all = [32, 64, 128, 256, 512, 1024, 2048];
    assert_eq!(good_to(0.0), all);
    start.finest.friction_error = f64::NAN;
    assert_eq!(visited(128, Some(0.01), Some(&start)), all);
}

fn zener(amplitude: f64, pressure: f64, time: f64) -> Case {
    Case::elastic(amplitude, pressure).sliding(1.0, &[(9.0, time)]).on_mesh(32, 8, 1)
}

/// Two nodes of 32 are in contact, with frictions a third apart: refined until both can be trusted.
#[test]
fn a_contact_of_few_nodes_is_refined() {
    let narrow = zener(1e-3, 4e-4, 0.02);
    let coarse = narrow.clone().with_settings([("finest_columns", 32.0)]).finest();
    assert_eq!(coarse.report.status, Status::ContactTooNarrow);
    let coarser = coarse.coarser_columns();
    assert_eq!((coarse.mesh.columns, coarser), (32, Some(16)));
    let fine = narrow.finest();
    assert_eq!(fine.report.status, Status::Converged);
    assert!(fine.mesh.columns > 32);
    assert!(fine.state.active_set.iter().filter(|&&a| a).count() >= 4);
    let (traction, lost) = (fine.outcome.friction, fine.outcome.friction_from_dissipation);
    assert!((traction - lost).abs() <= fine.friction_bound.unwrap());
}

/// The bound is a share of friction; at rest there is none.
#[test]
fn frictions_further_apart_than_the_bound_are_a_status() {
    let mut case = zener(0.05, 0.2, 0.05);
    let plain = case.finest();
    assert_eq!(plain.report.status, Status::Converged);
    let outcome = &plain.outcome;
    let larger = outcome.friction.max(outcome.friction_from_dissipation);
    assert!((plain.friction_bound.unwrap() / larger - 0.05).abs() < 1e-12);
    case = case.with_settings([("most_mismatch", 1e-6), ("finest_columns", 64.0)]);
    let strict = case.finest();
    assert_eq!(strict.report.status, Status::FrictionsDisagree);
    assert_eq!(strict.mesh.columns, 64);
    case.speed = 0.0;
    let still = case.finest();
    assert_eq!(still.report.status, Status::Converged);
    assert_eq!((still.mesh.columns, still.friction_bound), (32, None));
}

/// Westergaard at p/p* = 0.995: the gap is 0.07 wide in place of 0.045, and was as wide on half of
/// the columns, so that the change says half of the error.
#[test]
fn a_gap_of_few_nodes_is_within_the_error() {
    let amplitude = 1e-3;
    let case = Case::elastic(amplitude, 0.995 * 4.0 * std::f64::consts::PI * amplitude);
    let solution = case.finest();
    let exact = 0.95495;
    let error = (solution.outcome.contact_fraction - exact).abs();
    assert!(
        error > 0.02 && error <= solution.contact_fraction_error,
        "{error} {}",
        solution.contact_fraction_error
    );
}
