//! The linearised contact of the condensed block, solved exactly.
//!
//! Surface node a carries the force f_a grad(g_a), g_a = z_a - d - w(x_a) its gap to the profile at its
//! deformed abscissa, so that f_a is the vertical force. Linearised:
//!     (S + diag(f w'')) du = right + f_new grad(g),   g + grad(g) du - dd >= 0,  sum f = load,
//! with S the stiffness condensed to the surface (Wriggers, "Computational Contact Mechanics", 2006).
//!
//! Where the profile stands along x does not matter to a steady state. It is carried along with the
//! mean horizontal displacement of the surface, x_a = X_a + u_a - mean(u): otherwise the drag of
//! friction would push the contact from node to node while the load is raised, and every node
//! passed is a snap of the discrete problem that the continuous one does not know.

use super::complementarity;
use super::touching::{Contact, Linearised};
use super::{PressedBlock, State};
use crate::linear::{self, Elimination, Factor, Matrix};
use crate::settings::Settings;
use crate::status::Status;

impl PressedBlock<'_> {
    /// Surface displacement increments and contact forces of the linearised contact problem.
    pub fn linearised_contact(
        &self,
        state: &State,
        elimination: &Elimination,
        right: &[f64],
        load: f64,
        settings: &Settings,
    ) -> Result<(Vec<f64>, Contact), Status> {
        let nodes = self.mesh().layer_nodes();
        let at_x: Vec<usize> = (0..nodes).map(|a| self.mesh().place(a, 0)).collect();
        let at_z: Vec<usize> = (0..nodes).map(|a| self.mesh().place(a, 1)).collect();
        let x = self.abscissae(&state.field);
        let gap = self.gaps(state, &x);
        let slope: Vec<f64> = x.iter().map(|&x| self.heights.slope(x)).collect();
        let bend: Vec<f64> = (0..nodes)
            .map(|a| state.force[a] * self.heights.curvature(x[a]))
            .collect();
        let mut matrix = elimination.surface_matrix.clone();
        // Columns: response to a unit force along each node's gap gradient, to the residual, and to
        // a shift of the profile.
        let mut response = Matrix::<f64>::zeros(2 * nodes, nodes + 2);
        for a in 0..nodes {
            matrix[(at_x[a], at_x[a])] += bend[a];
            response[(at_x[a], a)] = -slope[a];
            response[(at_z[a], a)] = 1.0;
            response[(at_x[a], nodes + 1)] = bend[a];
        }
        for (i, &right) in right.iter().enumerate() {
            response[(i, nodes)] = right;
        }
        Factor::new(matrix.as_ref(), self.watch)?.solve(&mut response, self.watch)?;
        let shift = follow_mean(&mut response, &at_x);
        let opening = |column: usize, a: usize| {
            response[(at_z[a], column)] - slope[a] * (response[(at_x[a], column)] - shift[column])
        };
        let compliance = Matrix::from_fn(nodes, nodes, |a, b| opening(b, a));
        // Gaps before contact forces, measured without the approach, which is solved for anew.
        let free: Vec<f64> = (0..nodes)
            .map(|a| gap[a] + state.approach + opening(nodes, a))
            .collect();
        if free.iter().any(|g| !g.is_finite()) {
            return Err(Status::NotFinite);
        }
        let problem = Linearised {
            compliance: &compliance,
            free: &free,
            load,
        };
        let contact = complementarity::solve(&problem, &state.active, settings, self.watch)?;
        let surface = (0..2 * nodes)
            .map(|i| {
                let pushed: f64 = (0..nodes)
                    .map(|a| response[(i, a)] * contact.force[a])
                    .sum();
                pushed + response[(i, nodes)]
            })
            .collect();
        Ok((surface, contact))
    }
}

/// Let the profile follow the mean horizontal displacement: each response gets the shift it causes,
/// times the response to a shift (the last column). Returns the shift of every column.
fn follow_mean(response: &mut Matrix<f64>, at_x: &[usize]) -> Vec<f64> {
    let last = response.ncols() - 1;
    let mean = |column: &[f64]| at_x.iter().map(|&i| column[i]).sum::<f64>() / at_x.len() as f64;
    let to_shift = linear::column_ref(response, last).to_vec();
    let left = 1.0 - mean(&to_shift);
    (0..last)
        .map(|j| {
            let column = linear::column_mut(response, j);
            let shift = mean(column) / left;
            for (value, per_shift) in column.iter_mut().zip(&to_shift) {
                *value += shift * per_shift;
            }
            shift
        })
        .collect()
}
