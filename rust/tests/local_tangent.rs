//! The block's tangent at fixed memory, assembled: element by element from the slopes of the stress
//! at the Gauss points, with nothing of `fem::jacobian` in it.

use gripscale_kernel::fem::block::{Block, Field, RowState};
use gripscale_kernel::material::kinematics::{cofactor, Deformation, Gradient};
use gripscale_kernel::material::stress::{memory_slope, tangent};

/// Slopes of the forces and volumes of one element.
pub struct ElementTangent {
    /// Row by row, unknown 2 node + direction.
    pub stiffness: Vec<f64>,
    /// Change of every pressure mode's volume, `[mode][unknown]`.
    pub volume: Vec<f64>,
}

impl ElementTangent {
    pub fn new(block: &Block<'_>) -> Self {
        let size = 2 * block.mesh.elements[0].nodes();
        Self {
            stiffness: vec![0.0; size * size],
            volume: vec![0.0; size * block.mesh.modes()],
        }
    }

    /// Of element (`row`, `column`) in the state of `field`.
    pub fn fill(
        &mut self,
        block: &Block<'_>,
        field: &Field,
        state: &RowState,
        (row, column): (usize, usize),
    ) {
        let mesh = block.mesh;
        let element = &mesh.elements[row];
        let (points, modes) = (mesh.order + 1, mesh.modes());
        let size = 2 * element.nodes();
        let pressures = &field.pressure[(row * mesh.columns + column) * modes..][..modes];
        self.stiffness.fill(0.0);
        self.volume.fill(0.0);
        for at in 0..points * points {
            let (line, q) = (at / points, column * points + at % points);
            let point = &state.deformation[line][q];
            let mode = &element.mode[at];
            let level = mode.iter().zip(pressures).map(|(mode, p)| mode * p).sum();
            let weight = element.weight[at];
            let slopes = weighted_slopes(block, point, &state.h[line][q], level, weight);
            let cof = cofactor(&point.f).map(|slope| weight * slope);
            for (j, gradient) in element.gradient[at].iter().enumerate() {
                for direction in 0..2 {
                    let unknown = 2 * j + direction;
                    let along = |of: &Gradient| {
                        of[2 * direction] * gradient[0] + of[2 * direction + 1] * gradient[1]
                    };
                    let stress: Gradient = std::array::from_fn(|a| along(&slopes[a]));
                    for (i, to) in element.gradient[at].iter().enumerate() {
                        for d in 0..2 {
                            self.stiffness[(2 * i + d) * size + unknown] +=
                                to[0] * stress[2 * d] + to[1] * stress[2 * d + 1];
                        }
                    }
                    for (m, mode) in mode.iter().enumerate() {
                        self.volume[m * size + unknown] += mode * along(&cof);
                    }
                }
            }
        }
    }
}

/// dP/dF at fixed memory, the permanent network's b following the strain.
fn weighted_slopes(
    block: &Block<'_>,
    f: &Deformation,
    h: &[f64; 4],
    level: f64,
    weight: f64,
) -> [Gradient; 4] {
    let mut slopes = tangent(f, h, level);
    if let Some(network) = block.energy.network_slope(f) {
        for (a, by_h) in memory_slope(f).iter().enumerate() {
            for k in 0..4 {
                let sum: f64 = (0..4).map(|c| by_h[c] * network[c][k]).sum();
                slopes[a][k] += block.equilibrium * sum;
            }
        }
    }
    slopes.map(|row| row.map(|slope| weight * slope))
}

/// Places of an element's unknowns (2 node + direction) in a field; the lid's come last of all.
pub fn places(block: &Block<'_>, (row, column): (usize, usize)) -> Vec<usize> {
    let mesh = block.mesh;
    let order = mesh.order;
    let nodes = (0..=order).flat_map(|layer| (0..=order).map(move |sub| (layer, sub)));
    nodes
        .flat_map(|(layer, sub)| {
            let from = (order * row + layer) * mesh.layer_size();
            [0, 1].map(|direction| from + mesh.place(order * column + sub, direction))
        })
        .collect()
}
