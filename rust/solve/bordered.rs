//! The linearised problem on given nodes in contact by one sparse factor, for a memory known before
//! the step: the tangent is that of the elements alone.
//!
//! Where node a touches, du_z = w' (du_x - ds) + dd - gap, s the mean shift and d the approach. Its u_z
//! is eliminated and its force with it, which leaves a sparse symmetric matrix and two borders,
//!     mean of du_x = ds,   sum of df = what is missing of the load.

use super::balance::Balance;
use super::increment::Increment;
use crate::contact::touching::Contact;
use crate::contact::{PressedBlock, State};
use crate::fem::block::{Block, RowState};
use crate::fem::element_tangent::ElementTangent;
use crate::fem::mesh::Mesh;
use crate::fem::pattern::Pattern;
use crate::linear::{add, Ldl, LdlFactor};
use crate::status::Status;

/// What follows from the mesh alone.
pub struct Bordered {
    pattern: Pattern,
    ldl: Ldl,
}

/// The tangent of a state, factored with the nodes that touched held on the profile.
pub struct Tangent {
    factor: LdlFactor,
    pub active: Vec<bool>,
    slope: Vec<f64>,
    /// Stiffness of the elements at the surface, as it is where no node is held.
    surface: Vec<f64>,
    /// Change of volume of every pressure mode, `[row][column][mode]`, by its element's displacements.
    volumes: Vec<f64>,
    /// Answers to a unit of approach and of mean shift.
    borders: [Answer; 2],
}

/// Entries of the matrix, and of a tangent what is not factored.
struct Assembled {
    values: Vec<f64>,
    surface: Vec<f64>,
    volumes: Vec<f64>,
}

/// Displacements as in a field, and what they add to the forces of the nodes held.
#[derive(Default)]
struct Answer {
    u: Vec<f64>,
    force: Vec<f64>,
}

/// Solution of the linearised problem: displacements and pressures as in a field, and the change of
/// every node's contact force, of the approach and of the mean shift.
pub struct Change {
    pub u: Vec<f64>,
    pub pressure: Vec<f64>,
    pub force: Vec<f64>,
    pub approach: f64,
    pub shift: f64,
}

/// A pressure mode: its number in a field, that of its volume out of balance, K / M, its element's
/// displacements and how they change its volume.
struct Mode<'a> {
    pressure: usize,
    volume: usize,
    stiffness: f64,
    places: &'a [usize],
    change: &'a [f64],
}

impl Bordered {
    /// None where there is no memory for it.
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
        balance: &Balance,
    ) -> Result<Tangent, Status> {
        let mesh = pressed.mesh();
        let mut assembled = self.assemble(pressed, state, rows, balance)?;
        let bend = balance.bend(pressed, state);
        for (a, bend) in bend.iter().enumerate() {
            let [x, z] = [0, 1].map(|d| self.pattern.diagonal_of(mesh.place(a, d)));
            assembled.values[x] += bend;
            if state.active[a] {
                assembled.values[z] = 1.0;
            }
        }
        let factor = self.ldl.factor(&assembled.values);
        let mut tangent = Tangent {
            factor: factor.ok_or(Status::NotFinite)?,
            active: state.active.clone(),
            slope: balance.slope.clone(),
            surface: assembled.surface,
            volumes: assembled.volumes,
            borders: Default::default(),
        };
        tangent.borders = self.borders(mesh, &tangent, &bend);
        Ok(tangent)
    }

    /// The elements alone, the nodes in contact held.
    fn assemble(
        &self,
        pressed: &PressedBlock<'_>,
        state: &State,
        rows: &[RowState],
        balance: &Balance,
    ) -> Result<Assembled, Status> {
        let (block, mesh) = (&pressed.block, pressed.mesh());
        let mut values = vec![0.0; self.pattern.rows.len()];
        let mut element = ElementTangent::new(block);
        let (mut surface, mut volumes) = (Vec::new(), Vec::new());
        for (row, of_row) in rows.iter().enumerate() {
            pressed.watch.look()?;
            for column in 0..mesh.columns {
                element.fill(block, &state.field, of_row, (row, column));
                volumes.extend_from_slice(&element.volume);
                if row == 0 {
                    surface.extend_from_slice(&element.stiffness);
                    for sub in 0..=mesh.order {
                        let a = (column * mesh.order + sub) % mesh.layer_nodes();
                        if state.active[a] {
                            hold(&mut element.stiffness, sub, balance.slope[a]);
                        }
                    }
                }
                let number = row * mesh.columns + column;
                self.pattern.add(number, &element.stiffness, &mut values);
            }
        }
        Ok(Assembled {
            values,
            surface,
            volumes,
        })
    }

    fn borders(&self, mesh: &Mesh, tangent: &Tangent, bend: &[f64]) -> [Answer; 2] {
        let still = vec![0.0; mesh.layers() * mesh.layer_size()];
        let mut turned = still.clone();
        for (a, bend) in bend.iter().enumerate() {
            turned[mesh.place(a, 0)] = *bend;
        }
        let raised = self.answer(mesh, tangent, still, |_| 1.0);
        let shifted = self.answer(mesh, tangent, turned, |a| -tangent.slope[a]);
        [raised, shifted]
    }

    /// The increment by `tangent` that undoes `balance` of `state` under `load`. The contact it leads to
    /// is that of the tangent without the nodes it would pull, and with those that would come to lie in
    /// the profile.
    pub fn increment(
        &self,
        pressed: &PressedBlock<'_>,
        tangent: &Tangent,
        state: &State,
        balance: &Balance,
        load: f64,
    ) -> Increment {
        let mesh = pressed.mesh();
        let missing = load - state.force.iter().sum::<f64>();
        let change = self.change(&pressed.block, tangent, balance, missing);
        let Change { u, mut force, .. } = change;
        add(&mut force, 1.0, &state.force);
        let touches = |a: usize| {
            if tangent.active[a] {
                return force[a] >= 0.0;
            }
            let along = u[mesh.place(a, 0)] - change.shift;
            let opening = u[mesh.place(a, 1)] - balance.slope[a] * along - change.approach;
            balance.gap[a] + opening < 0.0
        };
        let active: Vec<bool> = (0..force.len()).map(touches).collect();
        for (force, _) in force.iter_mut().zip(&active).filter(|(_, &active)| !active) {
            *force = 0.0;
        }
        Increment {
            u,
            pressure: change.pressure,
            contact: Contact {
                force,
                approach: state.approach + change.approach,
                active,
            },
            products: 0,
        }
    }

    /// What undoes `balance` where the nodes held stay on the profile and no other touches, the forces
    /// growing by `missing` together.
    pub fn change(
        &self,
        block: &Block<'_>,
        tangent: &Tangent,
        balance: &Balance,
        missing: f64,
    ) -> Change {
        let mut right: Vec<f64> = balance.forces.iter().map(|force| -force).collect();
        self.each_mode(block, tangent, |mode| {
            let pressed = -mode.stiffness * balance.volumes[mode.volume];
            for (&place, change) in mode.places.iter().zip(mode.change) {
                right[place] += pressed * change;
            }
        });
        let own = self.answer(block.mesh, tangent, right, |a| -balance.gap[a]);
        let (approach, shift) = amounts(block.mesh, &own, &tangent.borders, missing);
        let Answer { mut u, mut force } = own;
        for (border, amount) in tangent.borders.iter().zip([approach, shift]) {
            add(&mut u, amount, &border.u);
            add(&mut force, amount, &border.force);
        }
        let mut pressure = vec![0.0; balance.volumes.len()];
        self.each_mode(block, tangent, |mode| {
            let changes = mode.places.iter().zip(mode.change);
            let volume: f64 = changes.map(|(&place, change)| change * u[place]).sum();
            pressure[mode.pressure] = mode.stiffness * (volume + balance.volumes[mode.volume]);
        });
        Change {
            u,
            pressure,
            force,
            approach,
            shift,
        }
    }

    /// Answer to forces with each node held `lift` above where its u_x leads it.
    fn answer(
        &self,
        mesh: &Mesh,
        tangent: &Tangent,
        forces: Vec<f64>,
        lift: impl Fn(usize) -> f64,
    ) -> Answer {
        let held = || (0..tangent.active.len()).filter(|&a| tangent.active[a]);
        let mut u = vec![0.0; forces.len()];
        held().for_each(|a| u[mesh.place(a, 1)] = lift(a));
        let mut right = forces.clone();
        self.add_surface(mesh, tangent, &u, -1.0, &mut right);
        for a in held() {
            let up = std::mem::take(&mut right[mesh.place(a, 1)]);
            right[mesh.place(a, 0)] += tangent.slope[a] * up;
        }
        let unknowns = &self.pattern.unknowns;
        let mut solution: Vec<f64> = unknowns.iter().map(|&place| right[place]).collect();
        self.ldl.solve(&tangent.factor, &mut solution);
        for (&place, solution) in unknowns.iter().zip(&solution) {
            u[place] += solution;
        }
        for a in held() {
            u[mesh.place(a, 1)] += tangent.slope[a] * u[mesh.place(a, 0)];
        }
        let mut pulled: Vec<f64> = forces[..mesh.layer_size()].iter().map(|f| -f).collect();
        pulled.resize(forces.len(), 0.0);
        self.add_surface(mesh, tangent, &u, 1.0, &mut pulled);
        let mut force = vec![0.0; tangent.active.len()];
        held().for_each(|a| force[a] = pulled[mesh.place(a, 1)]);
        Answer { u, force }
    }

    /// Add `factor` times the forces of the elements at the surface.
    fn add_surface(&self, mesh: &Mesh, tangent: &Tangent, u: &[f64], factor: f64, to: &mut [f64]) {
        let elements = tangent
            .surface
            .chunks_exact(tangent.surface.len() / mesh.columns);
        for (element, stiffness) in elements.enumerate() {
            let places = self.pattern.places(element);
            for (line, &place) in stiffness.chunks_exact(places.len()).zip(places) {
                let force: f64 = line.iter().zip(places).map(|(k, &p)| k * u[p]).sum();
                to[place] += factor * force;
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
                places: self.pattern.places(element),
                change,
            });
        }
    }
}

/// Approach and mean shift of which the borders make an answer complete.
fn amounts(mesh: &Mesh, own: &Answer, borders: &[Answer; 2], missing: f64) -> (f64, f64) {
    let sum = |answer: &Answer| answer.force.iter().sum::<f64>();
    let [raised, shifted] = borders;
    let (a, b) = (
        mesh.mean_shift(&raised.u),
        mesh.mean_shift(&shifted.u) - 1.0,
    );
    let (c, d) = (sum(raised), sum(shifted));
    let (e, f) = (-mesh.mean_shift(&own.u), missing - sum(own));
    let determinant = a * d - b * c;
    ((e * d - b * f) / determinant, (a * f - e * c) / determinant)
}

/// Let u_z of a surface node follow its u_x along `slope`.
fn hold(stiffness: &mut [f64], node: usize, slope: f64) {
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
