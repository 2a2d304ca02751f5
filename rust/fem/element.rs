//! The element on its reference square: Lagrange displacements, Gauss points, pressure modes.
//!
//! Order 1 is the bilinear element with one pressure (Q1P0), order 2 the biquadratic element with
//! a discontinuous linear pressure (Q2P-1): Boffi, Brezzi & Fortin, "Mixed Finite Element Methods
//! and Applications" (2013), section 8.6. Quadrature is the (order + 1)^2 Gauss rule.

/// Nodes and points of a biquadratic element.
pub const MOST_NODES: usize = 9;

/// Gauss points and weights on [-1, 1].
pub fn gauss(order: usize) -> Vec<(f64, f64)> {
    if order == 1 {
        let s = 1.0 / 3.0_f64.sqrt();
        vec![(-s, 1.0), (s, 1.0)]
    } else {
        let s = 0.6_f64.sqrt();
        vec![(-s, 5.0 / 9.0), (0.0, 8.0 / 9.0), (s, 5.0 / 9.0)]
    }
}

/// Values of the 1D Lagrange functions on equidistant nodes of [-1, 1] at `s`.
pub fn lagrange(order: usize, s: f64) -> Vec<f64> {
    if order == 1 {
        vec![0.5 * (1.0 - s), 0.5 * (1.0 + s)]
    } else {
        vec![0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)]
    }
}

/// Derivatives of the same functions.
pub fn lagrange_slope(order: usize, s: f64) -> Vec<f64> {
    if order == 1 {
        vec![-0.5, 0.5]
    } else {
        vec![s - 0.5, -2.0 * s, s + 0.5]
    }
}

/// Weights of the nodes of one element edge for a unit edge length (they sum to one).
pub fn edge_weights(order: usize) -> &'static [f64] {
    if order == 1 {
        &[0.5, 0.5]
    } else {
        &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]
    }
}

/// Shape gradients, weights and pressure modes of a `width` x `height` element.
///
/// Local nodes run column by column within a layer: node = layer * (order + 1) + column.
/// Gauss points likewise: point = row * (order + 1) + column.
#[derive(Debug, Clone)]
pub struct Element {
    pub order: usize,
    /// Gradient of every shape function at every Gauss point: `[point][node] -> (d/dx, d/dz)`.
    pub gradient: Vec<Vec<[f64; 2]>>,
    /// Area belonging to every Gauss point.
    pub weight: Vec<f64>,
    /// Pressure modes at every Gauss point; they are orthogonal on a rectangle.
    pub mode: Vec<Vec<f64>>,
    /// Integral of the square of every pressure mode.
    pub mode_mass: Vec<f64>,
}

impl Element {
    pub fn new(order: usize, width: f64, height: f64) -> Self {
        let rule = gauss(order);
        let (mut gradient, mut weight, mut mode) = (Vec::new(), Vec::new(), Vec::new());
        for &(eta, weight_z) in &rule {
            for &(xi, weight_x) in &rule {
                gradient.push(gradients(order, xi, eta, width, height));
                weight.push(weight_x * weight_z * width * height / 4.0);
                mode.push(if order == 1 { vec![1.0] } else { vec![1.0, xi, eta] });
            }
        }
        let area = width * height;
        let mode_mass = if order == 1 { vec![area] } else { vec![area, area / 3.0, area / 3.0] };
        Self { order, gradient, weight, mode, mode_mass }
    }

    pub fn nodes(&self) -> usize {
        (self.order + 1) * (self.order + 1)
    }
}

fn gradients(order: usize, xi: f64, eta: f64, width: f64, height: f64) -> Vec<[f64; 2]> {
    let (nx, dx) = (lagrange(order, xi), lagrange_slope(order, xi));
    let (nz, dz) = (lagrange(order, eta), lagrange_slope(order, eta));
    let mut out = Vec::with_capacity(nx.len() * nz.len());
    for layer in 0..=order {
        for column in 0..=order {
            out.push([dx[column] * nz[layer] * 2.0 / width, nx[column] * dz[layer] * 2.0 / height]);
        }
    }
    out
}
