//! The linearised problem on given nodes in contact by one sparse factor.
//!
//! Where node a touches, u_z = w' (u_x - shift) + approach - gap: its u_z is eliminated and its
//! force with it, which leaves a sparse symmetric system and two borders, the approach and the mean
//! shift. That is the least that elimination can take: a factor and three solutions, no response
//! of the surface.

use faer::Mat;
use gripscale_kernel::contact::{PressedBlock, State};
use gripscale_kernel::fem::block::{Block, RowState};
use gripscale_kernel::fem::mesh::Mesh;

use crate::factor::Ldl;
use crate::local_tangent::ElementTangent;
use crate::pattern::{dissection, Pattern, NONE};

/// What the residuals of both ways end below.
const TOLERANCE: f64 = 1e-8;
/// A factor of another state is kept as long as residuals fall to this share.
const WORTH_KEEPING: f64 = 0.3;
const MOST_ITERATIONS: usize = 40;

/// A state seen from its forces, volumes and gaps.
pub struct Linear {
    pub rows: Vec<RowState>,
    pub slope: Vec<f64>,
    /// Contact force times curvature of the profile.
    pub bend: Vec<f64>,
    pub gap: Vec<f64>,
    /// Out of balance, in the order of a field.
    pub forces: Vec<f64>,
    pub volumes: Vec<f64>,
}

impl Linear {
    pub fn new(pressed: &PressedBlock<'_>, state: &State) -> Self {
        let block = &pressed.block;
        let mesh = block.mesh;
        let rows = pressed.row_states(&state.field).expect("an endless watch");
        let x = pressed.abscissae(&state.field);
        let slope: Vec<f64> = x.iter().map(|&x| pressed.heights.slope(x)).collect();
        let mut forces = vec![0.0; state.field.u.len()];
        let mut volumes = Vec::with_capacity(state.field.pressure.len());
        for (row, of) in rows.iter().enumerate() {
            let inner = block.row_forces(row, &state.field, of);
            let from = row * mesh.order * mesh.layer_size();
            let pairs = forces[from..].iter_mut().zip(&inner);
            pairs.for_each(|(to, force)| *to -= force);
            let own = block.row_volumes(row, &state.field, of);
            for column in 0..mesh.columns {
                volumes.extend((0..mesh.modes()).map(|m| -own[m * mesh.columns + column]));
            }
        }
        for (a, force) in state.force.iter().enumerate() {
            forces[mesh.place(a, 0)] -= slope[a] * force;
            forces[mesh.place(a, 1)] += force;
        }
        let lid = forces.len() - mesh.layer_size();
        forces[lid..].fill(0.0);
        let bend = x.iter().zip(&state.force);
        let bend = bend.map(|(&x, f)| f * pressed.heights.curvature(x));
        Self {
            bend: bend.collect(),
            gap: pressed.gaps(state, &x),
            rows,
            slope,
            forces,
            volumes,
        }
    }

    /// As Newton's method judges it.
    fn residual(&self, pressed: &PressedBlock<'_>, state: &State, load: f64) -> f64 {
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let total = (state.force.iter().sum::<f64>() / load - 1.0).abs();
        let violated = |(gap, touches): (&f64, &bool)| if *touches { gap.abs() } else { -gap };
        let gaps = self.gap.iter().zip(&state.active).map(violated);
        let gap = gaps.fold(0.0, f64::max) / pressed.heights.half_range();
        let unbalanced = size(&self.forces) / load;
        unbalanced.max(size(&self.volumes)).max(total).max(gap)
    }
}

/// The tangent assembled, its pressures condensed.
pub struct Assembled {
    pub values: Vec<f64>,
    /// Stiffness of the elements at the surface, as it was before nodes were held.
    surface: Vec<f64>,
    /// Change of every pressure mode's volume, element by element.
    volumes: Vec<f64>,
}

/// A factor, the contact it belongs to, and how that answers the approach and the mean shift.
pub struct Kept {
    assembled: Assembled,
    factor: Vec<f64>,
    slope: Vec<f64>,
    touching: Vec<usize>,
    borders: [Answer; 2],
}

/// Displacements and what they press the touching nodes with.
struct Answer {
    u: Vec<f64>,
    force: Vec<f64>,
}

/// Solution of the linearised problem.
pub struct Change {
    pub u: Vec<f64>,
    pub pressure: Vec<f64>,
    /// Of every node's contact force.
    pub force: Vec<f64>,
    pub approach: f64,
    shift: f64,
}

pub struct Bordered {
    pub pattern: Pattern,
    pub ldl: Ldl,
}

/// Newton iterations and factors that they took.
#[derive(Default, Clone, Copy)]
pub struct Spent {
    pub iterations: usize,
    pub factors: usize,
}

impl Bordered {
    pub fn new(block: &Block<'_>) -> Self {
        let pattern = Pattern::new(block, &dissection(block.mesh), true);
        let ldl = Ldl::new(&pattern, false);
        Self { pattern, ldl }
    }

    /// Newton's method from `state`, without limits of its steps: with a factor for every iteration
    /// (`anew`), or with the one in `kept` as long as the same nodes touch and it serves. False if
    /// it does not end.
    pub fn newton(
        &self,
        pressed: &PressedBlock<'_>,
        state: &mut State,
        load: f64,
        kept: &mut Option<Kept>,
        (anew, spent): (bool, &mut Spent),
    ) -> bool {
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let linear = Linear::new(pressed, state);
            let residual = linear.residual(pressed, state, load);
            if residual < TOLERANCE {
                return true;
            }
            let serves = kept.as_ref().is_some_and(|kept| {
                kept.touching == touching(&state.active) && residual < WORTH_KEEPING * before
            });
            if anew || !serves {
                *kept = self.keep(&pressed.block, state, &linear);
                spent.factors += 1;
            }
            let Some(kept) = kept.as_ref() else {
                return false;
            };
            spent.iterations += 1;
            before = residual;
            if self.step(pressed, state, load, &linear, kept) {
                before = f64::INFINITY;
            }
        }
        false
    }

    /// One step; whether nodes changed sides.
    fn step(
        &self,
        pressed: &PressedBlock<'_>,
        state: &mut State,
        load: f64,
        linear: &Linear,
        kept: &Kept,
    ) -> bool {
        let block = &pressed.block;
        let old: f64 = kept.touching.iter().map(|&a| state.force[a]).sum();
        let right = (&linear.forces[..], &linear.volumes[..], &linear.gap[..]);
        let change = self.solve(block, kept, right, load - old);
        let mut next = vec![false; state.active.len()];
        for a in 0..next.len() {
            let (x, z) = (block.mesh.place(a, 0), block.mesh.place(a, 1));
            let along = change.u[x] - change.shift;
            let opened = change.u[z] - kept.slope[a] * along - change.approach;
            state.force[a] += change.force[a];
            next[a] = match state.active[a] {
                true => state.force[a] >= 0.0,
                false => linear.gap[a] + opened < 0.0,
            };
            if !next[a] {
                state.force[a] = 0.0;
            }
        }
        add(&mut state.field.u, &change.u, 1.0);
        add(&mut state.field.pressure, &change.pressure, 1.0);
        state.approach += change.approach;
        std::mem::replace(&mut state.active, next) != state.active
    }

    /// The tangent with the nodes that touch held on the profile.
    pub fn assemble(&self, block: &Block<'_>, state: &State, linear: &Linear) -> Assembled {
        let mesh = block.mesh;
        let mut values = vec![0.0; self.pattern.rows.len()];
        let mut element = ElementTangent::new(block);
        let entries = element.stiffness.len();
        let (mut surface, mut volumes) = (Vec::new(), Vec::new());
        for (e, to) in self.pattern.to.chunks_exact(entries).enumerate() {
            let (row, column) = (e / mesh.columns, e % mesh.columns);
            element.fill(block, &state.field, &linear.rows[row], (row, column));
            condense(
                &mut element,
                &mesh.elements[row].mode_mass,
                block.bulk_modulus,
            );
            volumes.extend_from_slice(&element.volume);
            if row == 0 {
                surface.extend_from_slice(&element.stiffness);
                for sub in 0..=mesh.order {
                    let a = (column * mesh.order + sub) % mesh.layer_nodes();
                    if state.active[a] {
                        hold(&mut element.stiffness, sub, linear.slope[a]);
                    }
                }
            }
            for (&to, value) in to.iter().zip(&element.stiffness) {
                if to != NONE {
                    values[to] += value;
                }
            }
        }
        for (a, bend) in linear.bend.iter().enumerate() {
            let [x, z] = [0, 1].map(|d| self.pattern.number[mesh.place(a, d)]);
            values[self.pattern.diagonal[x]] += bend;
            if state.active[a] {
                values[self.pattern.diagonal[z]] = 1.0;
            }
        }
        Assembled {
            values,
            surface,
            volumes,
        }
    }

    /// Factor the tangent of `state`.
    pub fn keep(&self, block: &Block<'_>, state: &State, linear: &Linear) -> Option<Kept> {
        let mesh = block.mesh;
        let assembled = self.assemble(block, state, linear);
        let nothing = || Answer {
            u: Vec::new(),
            force: Vec::new(),
        };
        let mut kept = Kept {
            factor: self.ldl.factor(&self.pattern, &assembled.values)?,
            assembled,
            slope: linear.slope.clone(),
            touching: touching(&state.active),
            borders: [nothing(), nothing()],
        };
        let still = vec![0.0; linear.forces.len()];
        let up = |a: usize| (mesh.place(a, 1), 1.0);
        let raised = self.answer(mesh, &kept, &still, kept.touching.iter().map(|&a| up(a)));
        let mut turned = still.clone();
        for (a, bend) in linear.bend.iter().enumerate() {
            turned[mesh.place(a, 0)] = *bend;
        }
        let down = |a: usize| (mesh.place(a, 1), -linear.slope[a]);
        let shifted = self.answer(mesh, &kept, &turned, kept.touching.iter().map(|&a| down(a)));
        kept.borders = [raised, shifted];
        Some(kept)
    }

    /// The change that brings forces and volumes into balance and closes `gap` at the nodes that
    /// touch, whose forces change by `more` together.
    pub fn solve(
        &self,
        block: &Block<'_>,
        kept: &Kept,
        (forces, volumes, gap): (&[f64], &[f64], &[f64]),
        more: f64,
    ) -> Change {
        let mesh = block.mesh;
        let mut condensed = forces.to_vec();
        self.each_mode(block, kept, |own, b, stiffness, mode| {
            let pressed = stiffness * volumes[mode];
            own.iter()
                .zip(b)
                .for_each(|(&p, b)| condensed[p] += pressed * b);
        });
        let closed = kept.touching.iter().map(|&a| (mesh.place(a, 1), -gap[a]));
        let Answer { mut u, force } = self.answer(mesh, kept, &condensed, closed);
        // mean u_x = shift, sum f = more.
        let [raised, shifted] = &kept.borders;
        let mean = |u: &[f64]| mesh.mean_shift(u);
        let sum = |f: &[f64]| f.iter().sum::<f64>();
        let (a, b, c) = (mean(&raised.u), mean(&shifted.u) - 1.0, -mean(&u));
        let (d, e, f) = (sum(&raised.force), sum(&shifted.force), more - sum(&force));
        let determinant = a * e - b * d;
        let (approach, shift) = ((c * e - b * f) / determinant, (a * f - c * d) / determinant);
        add(&mut u, &raised.u, approach);
        add(&mut u, &shifted.u, shift);
        let mut all = vec![0.0; gap.len()];
        for (k, &a) in kept.touching.iter().enumerate() {
            all[a] = force[k] + approach * raised.force[k] + shift * shifted.force[k];
        }
        let mut pressure = vec![0.0; volumes.len()];
        self.each_mode(block, kept, |own, b, stiffness, mode| {
            let volume: f64 = own.iter().zip(b).map(|(&p, b)| b * u[p]).sum();
            pressure[mode] = stiffness * (volume - volumes[mode]);
        });
        Change {
            u,
            pressure,
            force: all,
            approach,
            shift,
        }
    }

    /// Answer to forces, with `lifts` of the nodes that touch above where their u_x leads them.
    fn answer(
        &self,
        mesh: &Mesh,
        kept: &Kept,
        forces: &[f64],
        lifts: impl Iterator<Item = (usize, f64)>,
    ) -> Answer {
        let mut u = vec![0.0; forces.len()];
        lifts.for_each(|(place, lift)| u[place] = lift);
        let mut right = forces.to_vec();
        self.add_surface(kept, &u, &mut right, -1.0);
        for &a in &kept.touching {
            let up = std::mem::take(&mut right[mesh.place(a, 1)]);
            right[mesh.place(a, 0)] += kept.slope[a] * up;
        }
        let mut solution = Mat::zeros(self.pattern.size, 1);
        let numbers = || self.pattern.number.iter().enumerate();
        for (place, &number) in numbers().filter(|(_, &number)| number != NONE) {
            solution[(number, 0)] = right[place];
        }
        self.ldl.solve(&kept.factor, solution.as_mut());
        for (place, &number) in numbers().filter(|(_, &number)| number != NONE) {
            u[place] += solution[(number, 0)];
        }
        for &a in &kept.touching {
            u[mesh.place(a, 1)] += kept.slope[a] * u[mesh.place(a, 0)];
        }
        let mut pressed = vec![0.0; forces.len()];
        self.add_surface(kept, &u, &mut pressed, 1.0);
        let of = |&a: &usize| pressed[mesh.place(a, 1)] - forces[mesh.place(a, 1)];
        Answer {
            force: kept.touching.iter().map(of).collect(),
            u,
        }
    }

    /// Add `factor` times the forces of the elements at the surface.
    fn add_surface(&self, kept: &Kept, u: &[f64], to: &mut [f64], factor: f64) {
        let size = self.pattern.to.len() / self.pattern.places.len();
        let elements = kept.assembled.surface.chunks_exact(size * size);
        for (stiffness, own) in elements.zip(self.pattern.places.chunks_exact(size)) {
            for (line, &place) in stiffness.chunks_exact(size).zip(own) {
                let force: f64 = line.iter().zip(own).map(|(k, &p)| k * u[p]).sum();
                to[place] += factor * force;
            }
        }
    }

    /// Visit every pressure mode: its element's places, its volume's change, K / M and its number.
    fn each_mode(
        &self,
        block: &Block<'_>,
        kept: &Kept,
        mut visit: impl FnMut(&[usize], &[f64], f64, usize),
    ) {
        let mesh = block.mesh;
        let (modes, size) = (mesh.modes(), 2 * mesh.elements[0].nodes());
        for (mode, b) in kept.assembled.volumes.chunks_exact(size).enumerate() {
            let e = mode / modes;
            let mass = mesh.elements[e / mesh.columns].mode_mass[mode % modes];
            let own = &self.pattern.places[e * size..][..size];
            visit(own, b, block.bulk_modulus / mass, mode);
        }
    }
}

fn touching(active: &[bool]) -> Vec<usize> {
    (0..active.len()).filter(|&a| active[a]).collect()
}

fn add(to: &mut [f64], change: &[f64], factor: f64) {
    to.iter_mut()
        .zip(change)
        .for_each(|(to, c)| *to += factor * c);
}

/// Add what the pressures leave when they are eliminated: K / M b b^T of every mode.
fn condense(element: &mut ElementTangent, masses: &[f64], bulk_modulus: f64) {
    let size = element.volume.len() / masses.len();
    for (volume, mass) in element.volume.chunks_exact(size).zip(masses) {
        for (line, b) in element.stiffness.chunks_exact_mut(size).zip(volume) {
            add(line, volume, bulk_modulus / mass * b);
        }
    }
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
