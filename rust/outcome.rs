//! Contact, friction and stretches of a state: contact length with edges located between the nodes, and
//! friction from traction and from dissipation.

use crate::contact::edges::{contacts, EdgeLaw};
use crate::contact::{PressedBlock, State};
use crate::fem::element::edge_weights;
use crate::material::kinematics::principal_stretches;
use crate::status::Status;

#[derive(Debug, Clone)]
pub struct Outcome {
    pub contact_fraction: f64,
    /// Contact intervals (from, to) in wavelengths of deformed abscissa.
    pub contacts: Vec<(f64, f64)>,
    pub friction: f64,
    pub friction_from_dissipation: f64,
    /// Contribution of each row of elements to it.
    pub lost_by_row: Vec<f64>,
    pub min_stretch: f64,
    pub max_stretch: f64,
    /// Deformed abscissae of the surface nodes in wavelengths, and the pressure on them in stress units.
    pub x: Vec<f64>,
    pub pressure: Vec<f64>,
}

impl Outcome {
    /// The outcome of a state; fails only if the executor of `pressed` is cancelled.
    pub(crate) fn of(
        pressed: &PressedBlock<'_>,
        state: &State,
        law: EdgeLaw,
    ) -> Result<Self, Status> {
        let nodes = state.force.len();
        let load: f64 = state.force.iter().sum();
        let rows = pressed.row_states(&state.field)?;
        let profile = pressed.sampled(&state.field);
        let pressure = pressures(pressed.block.mesh.order, &profile.x, &state.force);
        let drag: f64 = (0..nodes).map(|a| state.force[a] * profile.slope.row_sum(a)).sum();
        let lost = pressed.block.dissipation(&rows, pressed.executor)?;
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for point in rows.iter().flat_map(|row| row.deformation.iter().flatten()) {
            let (least, most) = principal_stretches(&point.f);
            low = low.min(least);
            high = high.max(most);
        }
        let gap = pressed.gaps(state, &profile);
        let contacts = contacts(&profile.x, &pressure, &gap, &state.active_set, law);
        let length = contacts.iter().fold(0.0, |sum, (from, to)| sum + (to - from));
        Ok(Self {
            contact_fraction: length.clamp(0.0, 1.0),
            contacts,
            friction: drag / load,
            friction_from_dissipation: lost.whole / load,
            lost_by_row: lost.rows.iter().map(|lost| lost / load).collect(),
            min_stretch: low,
            max_stretch: high,
            x: profile.x,
            pressure,
        })
    }
}

/// Nodal pressures: vertical force over the projected length that belongs to the node.
fn pressures(order: usize, x: &[f64], force: &[f64]) -> Vec<f64> {
    let nodes = x.len();
    let mut length = vec![0.0; nodes];
    let weights = edge_weights(order);
    for element in 0..nodes / order {
        let first = element * order;
        let end = first + order;
        let to = if end < nodes { x[end] } else { x[0] + 1.0 };
        for (sub, weight) in weights.iter().enumerate() {
            length[(first + sub) % nodes] += weight * (to - x[first]);
        }
    }
    force.iter().zip(&length).map(|(f, l)| f / l).collect()
}
