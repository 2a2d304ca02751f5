//! The linearised problem on a given active set by one sparse factor, for a memory that is known before the
//! step: the tangent is then that of the elements alone.
//!
//! At node a of the active set, du_z = w' (du_x - ds) + dd - gap, with the mean shift s and the approach d.
//! Its u_z and its force are eliminated, which leaves a sparse symmetric matrix and two borders,
//!     mean of du_x = ds,   sum of df = missing load.

use super::newton_step::Increment;
use super::residual::Residual;
use crate::contact::complementarity_problem::Contact;
use crate::contact::{PressedBlock, State};
use crate::fem::block::{Block, RowState};
use crate::fem::element_tangent::ElementTangent;
use crate::fem::mesh::Mesh;
use crate::fem::pattern::Pattern;
use crate::linear::{add, Ldl, LdlFactor};
use crate::status::Status;

/// Pattern and symbolic factor, which follow from the mesh alone.
pub struct Bordered {
    pattern: Pattern,
    ldl: Ldl,
}

/// The tangent of a state, factored with the active set kept on the profile.
pub struct Tangent {
    factor: LdlFactor,
    pub active_set: Vec<bool>,
    slope: Vec<f64>,
    /// Stiffness of the elements at the surface, with no unknown eliminated.
    surface: Vec<f64>,
    /// Change of volume of every pressure mode by its element's displacements, `[row][column][mode]`.
    volumes: Vec<f64>,
    /// Responses to a unit of approach and of mean shift.
    borders: [Response; 2],
}

/// Entries of the matrix, and the parts of a tangent that are not factored.
struct Assembled {
    values: Vec<f64>,
    surface: Vec<f64>,
    volumes: Vec<f64>,
}

/// Displacements as in a field, and the change of the contact forces on the active set.
#[derive(Default)]
struct Response {
    u: Vec<f64>,
    force: Vec<f64>,
}

/// Solution of the linearised problem: the changes of displacements and pressures, as in a field, of every
/// node's contact force, of the approach and of the mean shift.
pub struct LinearSolution {
    pub u: Vec<f64>,
    pub pressure: Vec<f64>,
    pub force: Vec<f64>,
    pub approach: f64,
    pub shift: f64,
}

/// A pressure mode: its number in a field, the number of its residual volume, K / M, its element's
/// displacements and how they change its volume.
struct Mode<'a> {
    pressure: usize,
    volume: usize,
    stiffness: f64,
    positions: &'a [usize],
    change: &'a [f64],
}

impl Bordered {
    /// None if memory does not suffice.
    pub fn new(block: &Block<'_>) -> Option<Self> {
        let pattern = Pattern::new(block);
        let ldl = Ldl::new(pattern.column_starts.clone(), pattern.rows.clone())?;
        Some(Self { pattern, ldl })
    }

    /// The tangent of `state`, whose rows are in the states `rows`.
    pub fn factor(
        &self,
        pressed: &PressedBlock<'_>,
        state: &State,
        rows: &[RowState],
        residual: &Residual,
    ) -> Result<Tangent, Status> {
        let mesh = pressed.mesh();
        let mut assembled = self.assemble(pressed, state, rows, residual)?;
        let turning = residual.turning_stiffness(pressed, state);
        let curvature: Vec<f64> = (0..state.force.len()).map(|a| turning.diagonal(a)).collect();
        let slope = |a| residual.profile.slope.diagonal(a);
        for (a, stiffness) in curvature.iter().enumerate() {
            let [x, z] = [0, 1].map(|d| self.pattern.diagonal_of(mesh.position(a, d)));
            assembled.values[x] += stiffness;
            if state.active_set[a] {
                assembled.values[z] = 1.0;
            }
        }
        let factor = self.ldl.factor(&assembled.values);
        let mut tangent = Tangent {
            factor: factor.ok_or(Status::NotFinite)?,
            active_set: state.active_set.clone(),
            slope: (0..state.force.len()).map(slope).collect(),
            surface: assembled.surface,
            volumes: assembled.volumes,
            borders: Default::default(),
        };
        tangent.borders = self.borders(mesh, &tangent, &curvature);
        Ok(tangent)
    }

    /// The elements alone, with the active set kept on the profile.
    fn assemble(
        &self,
        pressed: &PressedBlock<'_>,
        state: &State,
        rows: &[RowState],
        residual: &Residual,
    ) -> Result<Assembled, Status> {
        let (block, mesh) = (&pressed.block, pressed.mesh());
        let mut values = vec![0.0; self.pattern.rows.len()];
        let mut element = ElementTangent::new(block);
        let (mut surface, mut volumes) = (Vec::new(), Vec::new());
        for (row, of_row) in rows.iter().enumerate() {
            pressed.executor.check_cancelled()?;
            for column in 0..mesh.columns {
                element.assemble_condensed(block, &state.field, of_row, (row, column));
                volumes.extend_from_slice(&element.volume);
                if row == 0 {
                    surface.extend_from_slice(&element.stiffness);
                    for sub in 0..=mesh.order {
                        let a = (column * mesh.order + sub) % mesh.layer_nodes();
                        if state.active_set[a] {
                            let slope = residual.profile.slope.diagonal(a);
                            follow_slope(&mut element.stiffness, sub, slope);
                        }
                    }
                }
                let number = row * mesh.columns + column;
                self.pattern.add(number, &element.stiffness, &mut values);
            }
        }
        Ok(Assembled { values, surface, volumes })
    }

    fn borders(&self, mesh: &Mesh, tangent: &Tangent, curvature: &[f64]) -> [Response; 2] {
        let no_forces = vec![0.0; mesh.layers() * mesh.layer_size()];
        let mut turning_forces = no_forces.clone();
        for (a, stiffness) in curvature.iter().enumerate() {
            turning_forces[mesh.position(a, 0)] = *stiffness;
        }
        let by_approach = self.respond(mesh, tangent, no_forces, |_| 1.0);
        let by_shift = self.respond(mesh, tangent, turning_forces, |a| -tangent.slope[a]);
        [by_approach, by_shift]
    }

    /// The increment by `tangent` that removes the `residual` of `state` under `load`. Nodes that would be
    /// pulled leave the active set at its end, and nodes that would penetrate the profile enter it.
    pub fn increment(
        &self,
        pressed: &PressedBlock<'_>,
        tangent: &Tangent,
        state: &State,
        residual: &Residual,
        load: f64,
    ) -> Increment {
        let mesh = pressed.mesh();
        let missing = load - state.force.iter().sum::<f64>();
        let solution = self.solve(&pressed.block, tangent, residual, missing);
        let LinearSolution { u, mut force, .. } = solution;
        add(&mut force, 1.0, &state.force);
        let in_contact = |a: usize| {
            if tangent.active_set[a] {
                return force[a] >= 0.0;
            }
            let along = u[mesh.position(a, 0)] - solution.shift;
            let opening = u[mesh.position(a, 1)] - tangent.slope[a] * along - solution.approach;
            residual.gap[a] + opening < 0.0
        };
        let active_set: Vec<bool> = (0..force.len()).map(in_contact).collect();
        for (force, &active) in force.iter_mut().zip(&active_set) {
            if !active {
                *force = 0.0;
            }
        }
        Increment {
            u,
            pressure: solution.pressure,
            contact: Contact { force, approach: state.approach + solution.approach, active_set },
            products: 0,
        }
    }

    /// The solution that removes the `residual` with the active set on the profile and no other node in
    /// contact, the contact forces growing by `missing` in sum.
    pub fn solve(
        &self,
        block: &Block<'_>,
        tangent: &Tangent,
        residual: &Residual,
        missing: f64,
    ) -> LinearSolution {
        let mut right: Vec<f64> = residual.forces.iter().map(|force| -force).collect();
        self.each_mode(block, tangent, |mode| {
            let pressure = -mode.stiffness * residual.volumes[mode.volume];
            for (&position, change) in mode.positions.iter().zip(mode.change) {
                right[position] += pressure * change;
            }
        });
        let response = self.respond(block.mesh, tangent, right, |a| -residual.gap[a]);
        let (approach, shift) = border_amounts(block.mesh, &response, &tangent.borders, missing);
        let Response { mut u, mut force } = response;
        for (border, amount) in tangent.borders.iter().zip([approach, shift]) {
            add(&mut u, amount, &border.u);
            add(&mut force, amount, &border.force);
        }
        let mut pressure = vec![0.0; residual.volumes.len()];
        self.each_mode(block, tangent, |mode| {
            let changes = mode.positions.iter().zip(mode.change);
            let volume: f64 = changes.map(|(&position, change)| change * u[position]).sum();
            pressure[mode.pressure] = mode.stiffness * (volume + residual.volumes[mode.volume]);
        });
        LinearSolution { u, pressure, force, approach, shift }
    }

    /// Response to `forces`, with each node of the active set `lift` above the profile under its u_x.
    fn respond(
        &self,
        mesh: &Mesh,
        tangent: &Tangent,
        forces: Vec<f64>,
        lift: impl Fn(usize) -> f64,
    ) -> Response {
        let active_nodes = || (0..tangent.active_set.len()).filter(|&a| tangent.active_set[a]);
        let mut u = vec![0.0; forces.len()];
        active_nodes().for_each(|a| u[mesh.position(a, 1)] = lift(a));
        let mut right = forces.clone();
        self.add_surface(mesh, tangent, &u, -1.0, &mut right);
        for a in active_nodes() {
            let up = std::mem::take(&mut right[mesh.position(a, 1)]);
            right[mesh.position(a, 0)] += tangent.slope[a] * up;
        }
        let unknowns = &self.pattern.unknowns;
        let mut solution: Vec<f64> = unknowns.iter().map(|&position| right[position]).collect();
        self.ldl.solve(&tangent.factor, &mut solution);
        for (&position, solution) in unknowns.iter().zip(&solution) {
            u[position] += solution;
        }
        for a in active_nodes() {
            u[mesh.position(a, 1)] += tangent.slope[a] * u[mesh.position(a, 0)];
        }
        let mut reaction: Vec<f64> = forces[..mesh.layer_size()].iter().map(|f| -f).collect();
        reaction.resize(forces.len(), 0.0);
        self.add_surface(mesh, tangent, &u, 1.0, &mut reaction);
        let mut force = vec![0.0; tangent.active_set.len()];
        active_nodes().for_each(|a| force[a] = reaction[mesh.position(a, 1)]);
        Response { u, force }
    }

    /// Add `factor` times the forces of the elements at the surface.
    fn add_surface(&self, mesh: &Mesh, tangent: &Tangent, u: &[f64], factor: f64, to: &mut [f64]) {
        let elements = tangent.surface.chunks_exact(tangent.surface.len() / mesh.columns);
        for (element, stiffness) in elements.enumerate() {
            let positions = self.pattern.positions(element);
            for (line, &position) in stiffness.chunks_exact(positions.len()).zip(positions) {
                let force: f64 = line.iter().zip(positions).map(|(k, &p)| k * u[p]).sum();
                to[position] += factor * force;
            }
        }
    }

    fn each_mode(&self, block: &Block<'_>, tangent: &Tangent, mut visit: impl FnMut(Mode<'_>)) {
        let mesh = block.mesh;
        let (modes, columns) = (mesh.modes(), mesh.columns);
        let size = 2 * mesh.elements[0].nodes();
        for (pressure, change) in tangent.volumes.chunks_exact(size).enumerate() {
            let (element, mode) = (pressure / modes, pressure % modes);
            let (row, column) = (element / columns, element % columns);
            visit(Mode {
                pressure,
                volume: (row * modes + mode) * columns + column,
                stiffness: block.bulk_modulus / mesh.elements[row].mode_mass[mode],
                positions: self.pattern.positions(element),
                change,
            });
        }
    }
}

/// The approach and the mean shift with which a response satisfies the two border conditions.
fn border_amounts(
    mesh: &Mesh,
    response: &Response,
    borders: &[Response; 2],
    missing: f64,
) -> (f64, f64) {
    let sum = |response: &Response| response.force.iter().sum::<f64>();
    let [by_approach, by_shift] = borders;
    let (a, b) = (mesh.mean_shift(&by_approach.u), mesh.mean_shift(&by_shift.u) - 1.0);
    let (c, d) = (sum(by_approach), sum(by_shift));
    let (e, f) = (-mesh.mean_shift(&response.u), missing - sum(response));
    let determinant = a * d - b * c;
    ((e * d - b * f) / determinant, (a * f - e * c) / determinant)
}

/// Let u_z of a surface node follow its u_x along `slope`.
fn follow_slope(stiffness: &mut [f64], node: usize, slope: f64) {
    let size = stiffness.len().isqrt();
    let (x, z) = (2 * node, 2 * node + 1);
    for line in stiffness.chunks_exact_mut(size) {
        line[x] += slope * std::mem::take(&mut line[z]);
    }
    for j in 0..size {
        let by = std::mem::take(&mut stiffness[z * size + j]);
        stiffness[x * size + j] += slope * by;
    }
}
