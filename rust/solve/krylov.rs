//! The linearised problem of a Newton step without a matrix, by GMRES on displacement and pressure:
//!     J y - C^T df = r,   g + C y - dd = 0 on the active set,   sum f = load.
//!
//! J is applied (`fem::jacobian_product`), its average along the rows is solved (`fem::averaged_jacobian`).
//! With the average in place of J the whole problem, complementarity included, is dense in the contact
//! forces alone, and predicts the active set. On that set GMRES solves the problem with J; every direction
//! satisfies the conditions of the set (constraint preconditioning: Keller, Gould & Wathen, SIAM J. Matrix
//! Anal. Appl. 21 (2000) 1300). The next Newton step predicts the next set: to iterate one linearised
//! problem on set after set, until none changes, took more products and no fewer steps.

use super::newton_step::{Increment, Iterate};
use crate::contact::active_set_system::ActiveSetSystem;
use crate::contact::complementarity_problem::{ComplementarityProblem, Contact};
use crate::contact::linear_complementarity;
use crate::contact::sampling::Band;
use crate::contact::surface_compliance::SurfaceCompliance;
use crate::contact::{PressedBlock, State};
use crate::executor::Executor;
use crate::fem::averaged_jacobian::{AveragedJacobian, SolutionWorkspace};
use crate::fem::jacobian::Jacobian;
use crate::fem::jacobian_product::ProductWorkspace;
use crate::fem::mesh::Mesh;
use crate::linear::{gmres, norm};
use crate::settings::Settings;
use crate::status::Status;

/// Directions kept by GMRES, and the largest number of products.
const GMRES_LIMITS: (usize, usize) = (100, 200);

/// GMRES ends at this share of the residual, or at this absolute size.
#[derive(Debug, Clone, Copy)]
pub struct Accuracy {
    pub share: f64,
    pub least: f64,
}

/// The increment of a Newton step from `iterate` under `load`, with the nodes of `active_set` in contact; if
/// no set is given, the averaged compliance predicts it.
pub fn increment(
    pressed: &PressedBlock<'_>,
    iterate: Iterate<'_>,
    active_set: Option<&[bool]>,
    load: f64,
    accuracy: Accuracy,
    settings: &Settings,
) -> Result<Increment, Status> {
    let Iterate { state, rows, residual, .. } = iterate;
    let executor = pressed.executor;
    let jacobian = Jacobian::new(&pressed.block, &state.field, rows, executor)?;
    let average = AveragedJacobian::new(&jacobian, executor)?;
    let step = Step {
        mesh: pressed.mesh(),
        executor,
        jacobian: &jacobian,
        average: &average,
        compliance: SurfaceCompliance::new(&average, &residual.profile.slope),
        turning_stiffness: residual.turning_stiffness(pressed, state),
        gap: &residual.gap,
        state,
        active_set,
        load,
        right: residual.right_hand_side(pressed),
    };
    step.solve(accuracy, settings)
}

/// One linearised problem.
struct Step<'a> {
    mesh: &'a Mesh,
    executor: &'a Executor<'a>,
    jacobian: &'a Jacobian<'a>,
    average: &'a AveragedJacobian<'a>,
    compliance: SurfaceCompliance<'a>,
    /// The stiffness of contact forces that turn with the profile.
    turning_stiffness: Band,
    gap: &'a [f64],
    state: &'a State,
    active_set: Option<&'a [bool]>,
    load: f64,
    right: Vec<f64>,
}

/// Memory for products and averaged solutions.
struct StepWorkspace<'t> {
    product: ProductWorkspace<'t>,
    average: SolutionWorkspace<'t>,
    solution: Vec<f64>,
}

/// An approximate solution of the linearised problem.
struct Approximation {
    y: Vec<f64>,
    contact: Contact,
    /// Residual forces and volumes.
    residual: Vec<f64>,
}

impl Step<'_> {
    /// Predict the contact by the average, then solve on its active set.
    fn solve(&self, accuracy: Accuracy, settings: &Settings) -> Result<Increment, Status> {
        let threads = self.executor.threads;
        let mut work = StepWorkspace {
            product: self.jacobian.workspace(threads),
            average: self.average.workspace(threads),
            solution: vec![0.0; self.right.len()],
        };
        let mut approximation = Approximation {
            y: vec![0.0; self.right.len()],
            contact: Contact {
                force: self.state.force.clone(),
                approach: self.state.approach,
                active_set: self.state.active_set.clone(),
            },
            residual: self.right.clone(),
        };
        let surface = self.average.reduce(&approximation.residual, &mut work.average);
        let (contact, system) = self.predict_contact(&approximation, &surface, settings)?;
        self.apply_contact(&mut approximation, contact, surface, &mut work);
        let largest = norm(&self.right).max(norm(&approximation.residual));
        let target = (accuracy.share * largest).max(accuracy.least);
        let products = self.solve_on_active_set(&mut approximation, &system, target, &mut work)?;
        let displacements = self.jacobian.displacements();
        let mut u = approximation.y[..displacements].to_vec();
        u.resize(self.state.field.u.len(), 0.0);
        Ok(Increment {
            u,
            pressure: self.by_element(&approximation.y[displacements..]),
            contact: approximation.contact,
            products,
        })
    }

    /// Contact of the linearised problem with the average in place of the Jacobian; the residual displaces
    /// the surface by `surface`.
    fn predict_contact(
        &self,
        approximation: &Approximation,
        surface: &[f64],
        settings: &Settings,
    ) -> Result<(Contact, ActiveSetSystem<'_>), Status> {
        let forces = self.compliance.nodal_forces(&approximation.contact.force);
        let by_forces = self.compliance.displacements(&forces);
        let free_u: Vec<f64> = (approximation.y.iter().zip(surface).zip(by_forces))
            .map(|((y, surface), by_forces)| y + surface - by_forces)
            .collect();
        let mut free_gap = self.compliance.opening(&free_u);
        for (free, gap) in free_gap.iter_mut().zip(self.gap) {
            *free += gap + self.state.approach;
        }
        if free_gap.iter().any(|gap| !gap.is_finite()) {
            return Err(Status::NotFinite);
        }
        let problem = ComplementarityProblem {
            compliance: &self.compliance,
            free_gap: &free_gap,
            load: self.load,
        };
        let executor = self.executor;
        match self.active_set {
            None => {
                let start = &approximation.contact.active_set;
                linear_complementarity::solve(&problem, start, settings, executor)
            }
            Some(active_set) => linear_complementarity::solve_on_active_set(
                &problem, active_set, settings, executor,
            ),
        }
    }

    /// Add the averaged solution for the residual, which was reduced to `surface`, and for the change to
    /// the forces of `contact`; then compute the new residual.
    fn apply_contact(
        &self,
        approximation: &mut Approximation,
        contact: Contact,
        surface: Vec<f64>,
        work: &mut StepWorkspace<'_>,
    ) {
        let mut correction = std::mem::take(&mut work.solution);
        let force_change = difference(&contact.force, &approximation.contact.force);
        self.averaged_solution(surface, &force_change, &mut correction, work);
        for (y, change) in approximation.y.iter_mut().zip(&correction) {
            *y += change;
        }
        work.solution = correction;
        approximation.contact = contact;
        let force_change = difference(&approximation.contact.force, &self.state.force);
        self.product(&approximation.y, &force_change, &mut approximation.residual, work);
        for (residual, right) in approximation.residual.iter_mut().zip(&self.right) {
            *residual = right - *residual;
        }
    }

    /// The averaged solution of what was reduced to `surface`, with contact `forces` added.
    fn averaged_solution(
        &self,
        mut surface: Vec<f64>,
        forces: &[f64],
        out: &mut [f64],
        work: &mut StepWorkspace<'_>,
    ) {
        let by_forces = self.compliance.displacements(&self.compliance.nodal_forces(forces));
        for (u, by_forces) in surface.iter_mut().zip(by_forces) {
            *u += by_forces;
        }
        self.average.expand(&surface, out, &mut work.average);
    }

    /// `out` = J y - C^T `forces`.
    fn product(&self, y: &[f64], forces: &[f64], out: &mut [f64], work: &mut StepWorkspace<'_>) {
        self.jacobian.product(y, out, &mut work.product);
        let shift = self.mesh.mean_shift(y);
        let along = |a: usize| y[self.mesh.position(a, 0)] - shift;
        for a in 0..self.mesh.layer_nodes() {
            out[self.mesh.position(a, 0)] += self.turning_stiffness.product(along, a);
        }
        for (out, force) in out.iter_mut().zip(self.compliance.nodal_forces(forces)) {
            *out -= force;
        }
    }

    /// Reduce the residual to `target` by GMRES, with the active set of `system` in contact.
    fn solve_on_active_set(
        &self,
        approximation: &mut Approximation,
        system: &ActiveSetSystem<'_>,
        target: f64,
        work: &mut StepWorkspace<'_>,
    ) -> Result<usize, Status> {
        let mut failure = Ok(());
        let apply = |v: &[f64], out: &mut [f64]| {
            let mut solution = std::mem::take(&mut work.solution);
            match self.precondition(v, system, &mut solution, work) {
                Ok((force, _)) => self.product(&solution, &force, out, work),
                Err(status) => failure = Err(status),
            }
            work.solution = solution;
        };
        let solution = gmres(apply, &approximation.residual, target, GMRES_LIMITS, self.executor)?;
        failure?;
        let mut correction = std::mem::take(&mut work.solution);
        let (force, approach) = self.precondition(&solution.y, system, &mut correction, work)?;
        for (y, change) in approximation.y.iter_mut().zip(&correction) {
            *y += change;
        }
        work.solution = correction;
        for (total, force) in approximation.contact.force.iter_mut().zip(&force) {
            *total += force;
        }
        approximation.contact.approach += approach;
        approximation.residual = solution.residual;
        Ok(solution.iterations)
    }

    /// The averaged solution for forces and volumes `v` that keeps the gaps of the active set, with the
    /// contact forces and the approach that keep them.
    fn precondition(
        &self,
        v: &[f64],
        system: &ActiveSetSystem<'_>,
        out: &mut [f64],
        work: &mut StepWorkspace<'_>,
    ) -> Result<(Vec<f64>, f64), Status> {
        let surface = self.average.reduce(v, &mut work.average);
        let opening = self.compliance.opening(&surface);
        let closing = system.solve(&opening, 0.0, self.executor)?;
        let (force, approach) = closing.ok_or(Status::NoActiveSet)?;
        self.averaged_solution(surface, &force, out, work);
        Ok((force, approach))
    }

    /// Pressures `[row][mode][column]` in the order of a field, `[row][column][mode]`.
    fn by_element(&self, pressure: &[f64]) -> Vec<f64> {
        let (modes, columns) = (self.mesh.modes(), self.mesh.columns);
        let rows = pressure.chunks_exact(modes * columns);
        let ordered = rows.flat_map(|row| {
            (0..columns).flat_map(move |column| (0..modes).map(move |m| row[m * columns + column]))
        });
        ordered.collect()
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
