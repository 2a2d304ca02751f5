//! The profile as the surface nodes feel it, at the nodes or averaged over their patches.
//!
//! The height under node a and its change with the displacements of the nodes b around it are
//!     h_a = sum_q m_a(q) h(x(q)),   S_ab = sum_q m_a(q) N_b(q) h'(x(q)),   x(q) = sum_b N_b(q) x_b
//! over points q of the elements of the surface. The contact force f_a acts along the gradient of its own
//! gap, (-S_ab, 1), so that all forces have a potential; the change of their direction is the stiffness
//!     K_bc = sum_a f_a sum_q m_a(q) N_b(q) N_c(q) h''(x(q)).
//!
//! At the nodes alone, m_a(q) = N_a(q) = 1 at node a, the surface between two nodes may cut through a crest
//! that is narrower than an element, and does where that releases energy. Averaged over the patches the mean
//! penetration vanishes. The weights m_a are dual to the shape functions, the integral of m_a N_b is zero
//! unless a = b: a node's height of a profile that is straight over its elements is that under the node
//! (B. I. Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989).

use super::profile::Heights;
use crate::fem::element::lagrange;
use crate::fem::mesh::Mesh;

/// Nodes on an edge of a biquadratic element, and neighbours of a node along the surface, itself included.
const MOST_EDGE_NODES: usize = 3;
const MOST_NEIGHBOURS: usize = 2 * MOST_EDGE_NODES - 1;

/// Gauss points and weights of an element of the surface on [-1, 1], for patches.
const PATCH_POINTS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Where the profile is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sampling {
    Nodes,
    Patches,
}

/// A point of an element of the surface, with the shape functions and the weights of its nodes.
#[derive(Clone, Copy)]
struct Point {
    shape: [f64; MOST_EDGE_NODES],
    weight: [f64; MOST_EDGE_NODES],
}

impl Sampling {
    /// The points of one element of `order`. Nodes belong to the element on their right.
    fn points(self, order: usize) -> Vec<Point> {
        let padded = |values: &[f64]| -> [f64; MOST_EDGE_NODES] {
            std::array::from_fn(|at| values.get(at).copied().unwrap_or(0.0))
        };
        let node = |sub: usize| {
            let unit = std::array::from_fn(|at| f64::from(u8::from(at == sub)));
            Point { shape: unit, weight: unit }
        };
        let in_patch = |&(place, weight): &(f64, f64)| {
            let shape = lagrange(order, place);
            let dual = dual(order, &shape).map(|value| 0.5 * weight * value);
            Point { shape: padded(&shape), weight: dual }
        };
        match self {
            Self::Nodes => (0..order).map(node).collect(),
            Self::Patches => PATCH_POINTS.iter().map(in_patch).collect(),
        }
    }
}

/// The functions dual to the shape functions on an edge, at the point where these are `shape`, over the share
/// of the node's patch in an edge of unit length: D M^-1 N, with the mass matrix M and its row sums D,
/// divided by the whole patch, which for a node between two elements is twice its share.
fn dual(order: usize, shape: &[f64]) -> [f64; MOST_EDGE_NODES] {
    match *shape {
        [a, b, c] if order == 2 => [
            4.5 * a - 0.75 * b + 1.5 * c,
            -1.5 * a + 2.25 * b - 1.5 * c,
            1.5 * a - 0.75 * b + 4.5 * c,
        ],
        [a, b, ..] => [2.0 * a - b, 2.0 * b - a, 0.0],
        _ => [0.0; MOST_EDGE_NODES],
    }
}

/// A matrix between the nodes of the surface that couples neighbours only: for each node its row,
/// from `order` nodes before it to `order` nodes behind it.
#[derive(Debug, Clone)]
pub struct Band {
    order: usize,
    rows: Vec<[f64; MOST_NEIGHBOURS]>,
}

impl Band {
    fn new(order: usize, nodes: usize) -> Self {
        let rows = vec![[0.0; MOST_NEIGHBOURS]; nodes];
        Self { order, rows }
    }

    fn add(&mut self, a: usize, place: usize, value: f64) {
        self.rows[a][place] += value;
    }

    /// Entries of row `a` that are not zero, with their columns.
    pub fn row(&self, a: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let nodes = self.rows.len();
        let entries = self.rows[a][..=2 * self.order].iter().enumerate();
        let entries = entries.filter(|(_, value)| **value != 0.0);
        entries.map(move |(place, value)| ((a + nodes + place - self.order) % nodes, *value))
    }

    pub fn diagonal(&self, a: usize) -> f64 {
        self.rows[a][self.order]
    }

    pub fn row_sum(&self, a: usize) -> f64 {
        self.row(a).fold(0.0, |sum, (_, value)| sum + value)
    }

    pub fn product(&self, values: impl Fn(usize) -> f64, a: usize) -> f64 {
        self.row(a).fold(0.0, |sum, (b, entry)| sum + entry * values(b))
    }

    /// The transposed product.
    pub fn transposed(&self, values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; values.len()];
        for (a, value) in values.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            self.row(a).for_each(|(b, entry)| out[b] += entry * value);
        }
        out
    }
}

/// Height of the profile under every node, and its slope by the displacements of the nodes.
#[derive(Debug, Clone)]
pub struct SampledProfile {
    sampling: Sampling,
    /// Deformed abscissae of the nodes.
    pub x: Vec<f64>,
    pub height: Vec<f64>,
    pub slope: Band,
}

impl SampledProfile {
    /// The profile under nodes at the abscissae `x`.
    pub fn new(heights: &Heights, sampling: Sampling, mesh: &Mesh, x: Vec<f64>) -> Self {
        let order = mesh.order;
        let mut sampled =
            Self { sampling, height: vec![0.0; x.len()], slope: Band::new(order, x.len()), x };
        for (node, point, at) in sampled.points(order) {
            let (height, slope) = (heights.height(at), heights.slope(at));
            for (i, weight) in point.weight[..=order].iter().enumerate() {
                let a = (node + i) % sampled.x.len();
                sampled.height[a] += weight * height;
                for (j, shape) in point.shape[..=order].iter().enumerate() {
                    sampled.slope.add(a, order + j - i, weight * shape * slope);
                }
            }
        }
        sampled
    }

    /// The stiffness of contact forces that turn with the profile.
    pub fn turning_stiffness(&self, heights: &Heights, force: &[f64]) -> Band {
        let (order, nodes) = (self.slope.order, force.len());
        let mut stiffness = Band::new(order, nodes);
        for (node, point, at) in self.points(order) {
            let weights = point.weight[..=order].iter().enumerate();
            let traction: f64 = weights.map(|(i, m)| m * force[(node + i) % nodes]).sum();
            if traction == 0.0 {
                continue;
            }
            let bend = traction * heights.curvature(at);
            for (i, by) in point.shape[..=order].iter().enumerate() {
                for (j, to) in point.shape[..=order].iter().enumerate() {
                    stiffness.add((node + i) % nodes, order + j - i, by * to * bend);
                }
            }
        }
        stiffness
    }

    /// All points: the first node of the element, the point, and its abscissa.
    fn points(&self, order: usize) -> Vec<(usize, Point, f64)> {
        let nodes = self.x.len();
        let end = |node: usize| self.x[node % nodes] + (node / nodes) as f64;
        let points = self.sampling.points(order);
        let of_element = |element: usize| {
            let node = element * order;
            points.clone().into_iter().map(move |point| {
                let shapes = point.shape[..=order].iter().enumerate();
                let terms = shapes.filter(|(_, shape)| **shape != 0.0);
                let at = terms.fold(0.0, |sum, (i, shape)| sum + shape * end(node + i));
                (node, point, at)
            })
        };
        (0..nodes / order).flat_map(of_element).collect()
    }
}
