//! The sequence of meshes: never empty from any input, and an empty one is an error of its own.

use gripscale_kernel::error::KernelError;
use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::problem::MeshSize;
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solution::Solution;
use gripscale_kernel::solve::mesh_sequence::MeshSequence;

use crate::Case;

#[test]
fn an_empty_sequence_is_an_internal_error() {
    let settings = Settings::default();
    let result = MeshSequence(vec![]).solve(None, &settings, |_, _| unreachable!());
    let error = result.map(|_| ()).unwrap_err();
    assert!(matches!(error, KernelError::Internal(_)));
    let text = error.to_string();
    assert!(text.starts_with("internal error: ") && text.ends_with("please report it"));
}

/// A start on a mesh beyond the finest that the tolerance may refine to: two meshes are left, which
/// tell the error.
#[test]
fn a_start_on_a_much_finer_mesh_leaves_two() {
    let mut case = Case::elastic(0.05, 0.2);
    case.columns = 256;
    let start = case.solve(None).unwrap();
    (case.columns, case.rows) = (64, 14);
    case.tolerance = Some(1e-3);
    case.settings = Settings::new([("finest_columns", 64.0)]).unwrap();
    let solution = case.solve(Some(&start)).unwrap();
    assert_eq!(solution.finest.mesh.columns, 64);
    assert!(solution.finest.contact_fraction_error > 1e-3);
}

/// Columns of the meshes of a sequence, coarsest first.
fn visited(finest: usize, tolerance: Option<f64>, start: Option<&Solution>) -> Vec<usize> {
    let size = MeshSize::new(finest, 12, 1.5, 1).unwrap();
    let first = start.map(|solution| &solution.finest);
    let sequence = MeshSequence::new(&size, tolerance, first, 0, &Settings::default());
    sequence
        .0
        .iter()
        .map(|size| Mesh::new(size).columns)
        .collect()
}

#[test]
fn any_number_of_columns_has_a_coarser_mesh_to_be_judged_by() {
    assert_eq!(visited(128, Some(0.01), None), [32, 64, 128, 256, 512]);
    assert_eq!(visited(128, None, None), [32, 64, 128]);
    assert_eq!(visited(100, None, None), [50, 100]);
    assert_eq!(visited(100, Some(0.01), None), [50, 100, 200, 400]);
    assert_eq!(visited(258, Some(0.01), None), [33, 65, 129, 258]);
    assert_eq!(
        visited(1023, Some(0.01), None),
        [32, 64, 128, 256, 512, 1023]
    );
}

/// Errors fall to a quarter at most where columns are doubled, so a start that is good to 0.9 of the
/// tolerance tells nothing of coarser meshes, one good to a fifth that half of its columns will do.
#[test]
fn a_start_much_better_than_the_tolerance_is_not_refined_to() {
    let mut case = Case::elastic(0.05, 0.2);
    case.columns = 256;
    let mut start = case.solve(None).unwrap();
    start.finest.friction_error = 0.0;
    let mut good_to = |error: f64| {
        start.finest.contact_fraction_error = error;
        visited(128, Some(0.01), Some(&start))
    };
    assert_eq!(good_to(0.009), [128, 256, 512]);
    assert_eq!(good_to(0.002), [64, 128, 256, 512]);
    assert_eq!(good_to(0.0), [32, 64, 128, 256, 512]);
    start.finest.friction_error = f64::NAN;
    assert_eq!(
        visited(128, Some(0.01), Some(&start)),
        [32, 64, 128, 256, 512]
    );
}
