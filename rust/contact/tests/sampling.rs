//! The profile under the nodes: exact where it is straight, and its slopes and stiffness are derivatives.

use crate::contact::profile::Heights;
use crate::contact::sampling::{SampledProfile, Sampling};
use crate::fem::mesh::{Mesh, MeshSize};

const BOTH: [Sampling; 2] = [Sampling::Nodes, Sampling::Patches];

fn mesh(order: usize) -> Mesh {
    Mesh::new(&MeshSize::new(24 / order, 2, 1.0, order).unwrap())
}

/// Nodes at uneven distances, which the elements of the surface map as their displacements do.
fn abscissae(mesh: &Mesh) -> Vec<f64> {
    let nodes = mesh.layer_nodes();
    let moved = |a: usize| a as f64 + 0.3 * (2.4 * a as f64).sin();
    (0..nodes).map(|a| moved(a) / nodes as f64).collect()
}

fn rough() -> Heights {
    let height = |j: i32| (0.8 * f64::from(j)).sin() + 0.4 * (2.1 * f64::from(j)).cos();
    Heights::sampled(&(0..16).map(|j| 0.01 * height(j)).collect::<Vec<f64>>()).unwrap()
}

/// The largest difference of `values` from the central differences of `of` by each node's abscissa.
fn largest_error(
    mesh: &Mesh,
    values: impl Fn(usize, usize) -> f64,
    of: impl Fn(Vec<f64>) -> Vec<f64>,
) -> f64 {
    let (x, step) = (abscissae(mesh), 1e-6);
    let mut largest: f64 = 0.0;
    for b in 0..x.len() {
        let moved = |by: f64| {
            let mut x = x.clone();
            x[b] += by;
            of(x)
        };
        for (a, (up, down)) in moved(step).iter().zip(moved(-step)).enumerate() {
            largest = largest.max((values(a, b) - (up - down) / (2.0 * step)).abs());
        }
    }
    largest
}

/// The slopes are the derivatives of the heights, and the turning stiffness that of horizontal forces, of
/// both signs as dual weights make of a traction at an edge. Differences of step 1e-6 are wrong by step^2
/// times third derivatives of 1e4, and by round-off of 1e-10.
#[test]
fn slopes_and_turning_stiffness_are_derivatives() {
    let heights = rough();
    for (sampling, order) in BOTH.into_iter().flat_map(|s| [(s, 1), (s, 2)]) {
        let mesh = mesh(order);
        let force: Vec<f64> = (0..24).map(|a| f64::from(a % 5) - 1.0).collect();
        let at = |x| SampledProfile::new(&heights, sampling, &mesh, x);
        let sampled = at(abscissae(&mesh));
        let stiffness = sampled.turning_stiffness(&heights, &force);
        let slope = |a: usize, b: usize| entry(sampled.slope.row(a), b);
        let error = largest_error(&mesh, slope, |x| at(x).height);
        assert!(error < 1e-7, "{sampling:?} {order}: {error}");
        let bend = |a: usize, b: usize| entry(stiffness.row(a), b);
        let error = largest_error(&mesh, bend, |x| at(x).slope.transposed(&force));
        assert!(error < 1e-5, "{sampling:?} {order}: {error}");
    }
}

/// The sum of a row's entries in one column.
fn entry(row: impl Iterator<Item = (usize, f64)>, column: usize) -> f64 {
    row.filter(|&(c, _)| c == column).map(|(_, value)| value).sum()
}

/// Over a patch of equal elements a parabola is lifted by its mean over the chords, h'' d^2 / 12 with the
/// distance d of the nodes; of the sine the next term is (k d)^2 / 20 of that, 0.3 %.
#[test]
fn patches_see_the_crest_between_nodes() {
    let (mesh, heights) = (mesh(1), Heights::sine(1.0).unwrap());
    let nodes = mesh.layer_nodes();
    let x: Vec<f64> = (0..nodes).map(|a| a as f64 / nodes as f64).collect();
    let patches = SampledProfile::new(&heights, Sampling::Patches, &mesh, x.clone());
    for (a, x) in x.into_iter().enumerate() {
        let lift = -heights.curvature(x) / (12.0 * (nodes * nodes) as f64);
        let error = patches.height[a] - heights.height(x) - lift;
        assert!(error.abs() < 0.01 * 0.0058, "{a}: {error}");
    }
}
