//! The sequence of meshes: never empty from any input, and an empty one is an error of its own.

use gripscale_kernel::error::KernelError;
use gripscale_kernel::settings::Settings;
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

/// A start on a mesh beyond twice the finest that the tolerance may refine to.
#[test]
fn a_start_on_a_much_finer_mesh_leaves_one_mesh() {
    let mut case = Case::elastic(0.05, 0.2);
    let start = case.solve(None).unwrap();
    (case.columns, case.rows) = (16, 6);
    case.tolerance = Some(0.5);
    case.settings = Settings::new([("finest_columns", 16.0)]).unwrap();
    let solution = case.solve(Some(&start)).unwrap();
    assert_eq!(solution.finest.mesh.columns, 16);
}
