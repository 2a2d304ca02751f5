//! A solved wave: the problem, the solution on the finest mesh, and the work it took.

use crate::contact::State;
use crate::fem::mesh::Mesh;
use crate::problem::Problem;
use crate::status::Status;

pub use crate::outcome::Outcome;

/// Contact and friction of one wave; also a start for another solve.
#[derive(Debug, Clone)]
pub struct Solution {
    pub problem: Problem,
    /// Unit of the stresses in `finest` [Pa].
    pub stress_unit: f64,
    pub finest: MeshSolution,
    pub counts: Counts,
    /// Contact widths in wavelengths, Hertz's and the smallest that a mesh resolves, if nothing was
    /// solved because the first is the smaller.
    pub too_narrow: Option<(f64, f64)>,
    /// Number of waves, from the longest, with which the profile carried the load, if all waves together
    /// are too rough.
    pub waves_carried: Option<usize>,
}

impl Solution {
    /// Deformed node positions in wavelengths, layer by layer: (x, z).
    pub fn node_positions(&self) -> Vec<Vec<(f64, f64)>> {
        let (mesh, state) = (&self.finest.mesh, &self.finest.state);
        let shift = mesh.mean_shift(&state.field.u);
        let position = |layer: usize, z: f64, node: usize| {
            let at = layer * mesh.layer_size();
            (
                node as f64 * mesh.node_spacing() + state.field.u[at + mesh.position(node, 0)]
                    - shift,
                z - state.approach + state.field.u[at + mesh.position(node, 1)],
            )
        };
        let heights = mesh.layer_heights().into_iter().enumerate();
        heights
            .map(|(layer, z)| {
                (0..=mesh.layer_nodes()).map(|node| position(layer, z, node)).collect()
            })
            .collect()
    }
}

/// The solution on one mesh of a sequence.
#[derive(Debug, Clone)]
pub struct MeshSolution {
    pub mesh: Mesh,
    pub state: State,
    pub report: Report,
    pub outcome: Outcome,
    /// The coarser mesh from which the errors are estimated, with its solution.
    pub coarser: Option<(Mesh, State)>,
    /// Estimated discretisation errors, NaN without a coarser mesh.
    pub contact_fraction_error: f64,
    pub friction_error: f64,
    /// Largest difference of the two frictions that is allowed; None at rest.
    pub friction_bound: Option<f64>,
}

impl MeshSolution {
    pub fn converged(&self) -> bool {
        self.report.status == Status::Converged
    }

    /// Columns of the coarser mesh from which the errors are estimated.
    pub fn coarser_columns(&self) -> Option<usize> {
        self.coarser.as_ref().map(|(mesh, _)| mesh.columns)
    }

    /// The state on exactly this `mesh`, if it was solved.
    pub(crate) fn state_on(&self, mesh: &Mesh) -> Option<&State> {
        let coarser = self.coarser.iter().map(|(mesh, state)| (mesh, state));
        let mut solved = std::iter::once((&self.mesh, &self.state)).chain(coarser);
        solved.find(|(other, _)| other.same(mesh)).map(|(_, state)| state)
    }
}

/// How one Newton iteration, or the last of several, ended.
#[derive(Debug, Clone, Copy)]
pub struct Report {
    pub status: Status,
    pub iterations: usize,
    /// Products with the Jacobian in the linearised problems.
    pub products: usize,
    /// The larger of residual force over the load and gap over half the range of heights.
    pub residual: f64,
    /// Share of the load that was reached.
    pub load_reached: f64,
}

impl Report {
    /// The report of a solve without iterations.
    pub(crate) fn unsolved(status: Status) -> Self {
        Self { status, iterations: 0, products: 0, residual: f64::NAN, load_reached: 0.0 }
    }

    /// The status as an error, unless it is `Converged`.
    pub(crate) fn converged(&self) -> Result<(), Status> {
        match self.status {
            Status::Converged => Ok(()),
            other => Err(other),
        }
    }
}

/// The work of a solve.
#[derive(Debug, Default, Clone, Copy)]
pub struct Counts {
    pub load_steps: usize,
    pub iterations: usize,
    /// Products with the Jacobian in the linearised problems.
    pub products: usize,
}

impl Counts {
    /// Add a load step.
    pub(crate) fn add(&mut self, report: &Report) {
        self.load_steps += 1;
        self.iterations += report.iterations;
        self.products += report.products;
    }
}
