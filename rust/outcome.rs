//! What one solved wave tells: contact length with sub-element edges, friction both ways, stretches.

use crate::element::edge_weights;
use crate::network;
use crate::newton::{Problem, State};

#[derive(Debug, Clone)]
pub struct Outcome {
    pub contact_fraction: f64,
    /// Contact intervals (from, to) in wavelengths of deformed abscissa.
    pub contacts: Vec<(f64, f64)>,
    pub friction: f64,
    pub friction_from_dissipation: f64,
    pub min_stretch: f64,
    pub max_stretch: f64,
    /// Deformed abscissa and pressure of the surface nodes.
    pub x: Vec<f64>,
    pub pressure: Vec<f64>,
}

impl Outcome {
    pub fn of(problem: &Problem<'_>, state: &State) -> Self {
        let nodes = state.force.len();
        let load: f64 = state.force.iter().sum();
        let rows = problem.row_states(&state.field);
        let x = problem.abscissae(&state.field);
        let pressure = pressures(problem.block.cell.order, &x, &state.force);
        let drag: f64 = (0..nodes)
            .map(|a| state.force[a] * problem.wave.slope(x[a]))
            .sum();
        let lost: f64 = rows
            .iter()
            .enumerate()
            .map(|(row, row_state)| problem.block.row_dissipation(row, row_state))
            .sum();
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for f in rows.iter().flat_map(|row| row.gradient.iter().flatten()) {
            let (least, most) = network::principal_stretches(f);
            low = low.min(least);
            high = high.max(most);
        }
        let gap = problem.gaps(state, &x);
        let contacts = contacts(&x, &pressure, &gap, &state.active);
        let length = contacts.iter().map(|(from, to)| to - from).sum::<f64>();
        Self {
            contact_fraction: length.clamp(0.0, 1.0),
            contacts,
            friction: drag / load,
            friction_from_dissipation: lost / load,
            min_stretch: low,
            max_stretch: high,
            x,
            pressure,
        }
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

/// Contact intervals from runs of active nodes, their edges located between the nodes.
fn contacts(x: &[f64], pressure: &[f64], gap: &[f64], active: &[bool]) -> Vec<(f64, f64)> {
    let n = x.len();
    if active.iter().all(|&a| a) {
        return vec![(x[0], x[0] + 1.0)];
    }
    let mut out = Vec::new();
    for a in 0..n {
        if active[a] && !active[(a + n - 1) % n] {
            let mut length = 1;
            while active[(a + length) % n] {
                length += 1;
            }
            let at = |i: isize| {
                let index = a as isize + i;
                let node = index.rem_euclid(n as isize);
                (
                    x[node as usize] + index.div_euclid(n as isize) as f64,
                    node as usize,
                )
            };
            let open = |from: isize, outward: isize| {
                (0..n as isize)
                    .take_while(|i| !active[at(from + i * outward).1])
                    .count()
            };
            let last = length as isize - 1;
            let from = edge(at, 0, -1, length, open(-1, -1), pressure, gap);
            let to = edge(at, last, 1, length, open(last + 1, 1), pressure, gap);
            out.push((from, to));
        }
    }
    out
}

/// One edge: pressure falls like the root of the distance inside, the gap opens like its 3/2 power
/// outside (Johnson, "Contact Mechanics" (1985), section 4.2).
///
/// The two estimates err to opposite sides with the edge's place between the nodes; their mean is
/// right to about a tenth of the node spacing. Too few nodes on one side leave the other estimate.
fn edge(
    at: impl Fn(isize) -> (f64, usize),
    last: isize,
    outward: isize,
    closed: usize,
    open: usize,
    pressure: &[f64],
    gap: &[f64],
) -> f64 {
    let (x0, inside) = at(last);
    let (x1, outside) = at(last + outward);
    let from_pressure = (closed > 1).then(|| {
        let (x_in, second) = at(last - outward);
        let (near, far) = (pressure[inside].powi(2), pressure[second].powi(2));
        (far > near).then(|| x0 + (x0 - x_in) * near / (far - near))
    });
    let from_gap = (open > 1).then(|| {
        let (x2, further) = at(last + 2 * outward);
        let near = gap[outside].max(0.0).powf(2.0 / 3.0);
        let far = gap[further].max(0.0).powf(2.0 / 3.0);
        (far > near).then(|| x1 - (x2 - x1) * near / (far - near))
    });
    let place = match (from_pressure.flatten(), from_gap.flatten()) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(a), None) => a,
        (None, Some(b)) => b,
        (None, None) => 0.5 * (x0 + x1),
    };
    let margin = 0.5 * (x1 - x0).abs();
    place.clamp(x0.min(x1) - margin, x0.max(x1) + margin)
}
