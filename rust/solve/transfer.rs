//! Transfer of a solution from one mesh to another, which may be finer, coarser or differently graded.

use crate::contact::State;
use crate::fem::mesh::Mesh;

/// `state` on the mesh `from`, interpolated on the mesh `to`; `stress_ratio` is the unit of its stresses over
/// the new one.
pub fn transfer(from: &Mesh, state: &State, to: &Mesh, stress_ratio: f64) -> State {
    let mut out = State::at_rest(to);
    let nodes = to.layer_nodes();
    for (layer, z) in to.layer_heights().into_iter().enumerate().take(to.layers() - 1) {
        for node in 0..nodes {
            let u = from.interpolate(&state.field.u, node as f64 * to.node_spacing(), z);
            let at = layer * to.layer_size();
            out.field.u[at + to.position(node, 0)] = u[0];
            out.field.u[at + to.position(node, 1)] = u[1];
        }
    }
    out.approach = state.approach;
    transfer_pressure(from, state, to, stress_ratio, &mut out);
    let ratio = from.layer_nodes() as f64 / nodes as f64;
    for node in 0..nodes {
        let source = (node as f64 * ratio).round() as usize % from.layer_nodes();
        out.active_set[node] = state.active_set[source];
        out.force[node] = state.force[source] * ratio * stress_ratio;
    }
    out
}

/// Each element takes the mean pressure of the nearest element.
fn transfer_pressure(from: &Mesh, state: &State, to: &Mesh, stress_ratio: f64, out: &mut State) {
    let source_rows = from.row_middles();
    for (row, z) in to.row_middles().into_iter().enumerate() {
        let distance = |r: usize| (source_rows[r] - z).abs();
        let nearer = |best, r| {
            if distance(r) < distance(best) {
                r
            } else {
                best
            }
        };
        let nearest = (1..from.rows).fold(0, nearer);
        for column in 0..to.columns {
            let source = (2 * column + 1) * from.columns / (2 * to.columns);
            let value = state.field.pressure[(nearest * from.columns + source) * from.modes()];
            out.field.pressure[(row * to.columns + column) * to.modes()] = stress_ratio * value;
        }
    }
}
