//! A solved wave: the problem, what was found on the finest mesh, and the work it took.

use crate::problem::Problem;
use crate::solve::load_stepping::Counts;
use crate::solve::mesh_solution::MeshSolution;

/// Contact and friction of one wave; also the start of another.
#[derive(Debug, Clone)]
pub struct Solution {
    pub problem: Problem,
    /// Unit of the stresses in `finest` [Pa].
    pub stress_unit: f64,
    pub finest: MeshSolution,
    pub counts: Counts,
    /// Contact widths in wavelengths, of Hertz and the smallest that can be followed, where there
    /// was nothing to solve for that reason.
    pub too_narrow: Option<(f64, f64)>,
    /// Waves, from the longest, with which the profile carried the load, where all are too rough.
    pub waves_carried: Option<usize>,
}

impl Solution {
    /// Deformed node positions in wavelengths, layer by layer: (x, z).
    pub fn node_positions(&self) -> Vec<Vec<(f64, f64)>> {
        let (mesh, state) = (&self.finest.mesh, &self.finest.state);
        let shift = mesh.mean_shift(&state.field.u);
        let place = |layer: usize, z: f64, node: usize| {
            let at = layer * mesh.layer_size();
            (
                node as f64 * mesh.node_spacing() + state.field.u[at + mesh.place(node, 0)] - shift,
                z - state.approach + state.field.u[at + mesh.place(node, 1)],
            )
        };
        let heights = mesh.layer_heights().into_iter().enumerate();
        heights
            .map(|(layer, z)| {
                (0..=mesh.layer_nodes())
                    .map(|node| place(layer, z, node))
                    .collect()
            })
            .collect()
    }
}
