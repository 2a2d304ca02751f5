//! One Newton step of static contact, its whole linear system assembled and eliminated by sparse
//! LU, against the iteration that never forms it: Jacobian, pressures, border, contact forces.

use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::Mat;

use crate::contact::sampling::Sampling;
use crate::contact::{PressedBlock, State};
use crate::fem::block::{Block, Memory, RowState};
use crate::fem::element_tangent::ElementTangent;
use crate::model::Model;
use crate::settings::Settings;
use crate::solve::bordered::Bordered;
use crate::solve::krylov::{self, Accuracy};
use crate::solve::newton_step::{Increment, Iterate};
use crate::solve::residual::Residual;

use crate::tests::fixture::{energies, mesh, serial, Case};

/// Entries and right-hand side; the unknowns are the displacements of a field, the lid's among
/// them, its pressures, the changes of the forces on the active set, and the approach.
struct System {
    entries: Vec<Triplet<usize, usize, f64>>,
    right: Vec<f64>,
}

impl System {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.entries.push(Triplet::new(row, column, value));
    }

    fn solve(&self) -> Vec<f64> {
        let size = self.right.len();
        let matrix = SparseColMat::try_new_from_triplets(size, size, &self.entries).unwrap();
        let right = Mat::from_fn(size, 1, |i, _| self.right[i]);
        let solution = matrix.sp_lu().unwrap().solve(&right);
        solution.col_as_slice(0).to_vec()
    }
}

/// Places of an element's unknowns (2 node + direction) in a field; the lid's are the last.
fn element_positions(block: &Block<'_>, (row, column): (usize, usize)) -> Vec<usize> {
    let mesh = block.mesh;
    let order = mesh.order;
    let nodes = (0..=order).flat_map(|layer| (0..=order).map(move |sub| (layer, sub)));
    nodes
        .flat_map(|(layer, sub)| {
            let from = (order * row + layer) * mesh.layer_size();
            [0, 1].map(|direction| from + mesh.position(order * column + sub, direction))
        })
        .collect()
}

/// The block: forces by displacements and pressures, volumes by displacements and pressures.
fn add_elements(system: &mut System, pressed: &PressedBlock<'_>, state: &State) {
    let block = &pressed.block;
    let mesh = block.mesh;
    let displacements = state.field.u.len();
    let free = displacements - mesh.layer_size();
    let mut element = ElementTangent::new(block);
    for row in 0..mesh.rows {
        let of_row = block.row_state(row, &state.field.u);
        let forces = block.row_forces(row, &state.field, &of_row);
        let from = row * mesh.order * mesh.layer_size();
        for (right, force) in system.right[from..free].iter_mut().zip(&forces) {
            *right -= force;
        }
        let volumes = block.row_volumes(row, &state.field, &of_row);
        for column in 0..mesh.columns {
            element.assemble_lower(block, &state.field, &of_row, (row, column));
            element.mirror();
            let positions = element_positions(block, (row, column));
            for (i, &to) in positions.iter().enumerate().filter(|(_, &to)| to < free) {
                for (j, &by) in positions.iter().enumerate().filter(|(_, &by)| by < free) {
                    system.add(to, by, element.stiffness[i * positions.len() + j]);
                }
            }
            for (m, mass) in mesh.elements[row].mode_mass.iter().enumerate() {
                let index = (row * mesh.columns + column) * mesh.modes() + m;
                let pressure = displacements + index;
                for (i, &position) in positions.iter().enumerate().filter(|(_, &p)| p < free) {
                    let volume = element.volume[m * positions.len() + i];
                    system.add(position, pressure, volume);
                    system.add(pressure, position, volume);
                }
                system.add(pressure, pressure, -mass / block.bulk_modulus);
                system.right[pressure] = -volumes[m * mesh.columns + column];
            }
        }
    }
    (free..displacements).for_each(|lid| system.add(lid, lid, 1.0));
}

/// The `active_nodes` stay on the profile, which follows the surface's mean shift, under
/// forces that turn with it; together they carry the load.
fn add_contact(
    system: &mut System,
    pressed: &PressedBlock<'_>,
    state: &State,
    active_nodes: &[usize],
    load: f64,
) {
    let mesh = pressed.block.mesh;
    let (nodes, first) = (mesh.layer_nodes(), system.right.len() - active_nodes.len() - 1);
    let approach = system.right.len() - 1;
    let profile = pressed.sampled(&state.field);
    let gap = pressed.gaps(state, &profile);
    let turning = profile.turning_stiffness(pressed.heights, &state.force);
    let share = 1.0 / nodes as f64;
    for a in 0..nodes {
        let (along, up) = (mesh.position(a, 0), mesh.position(a, 1));
        turning.row(a).for_each(|(b, bend)| system.add(along, mesh.position(b, 0), bend));
        let bend = turning.row_sum(a);
        (0..nodes).for_each(|b| system.add(along, mesh.position(b, 0), -bend * share));
        let Some(k) = active_nodes.iter().position(|&node| node == a) else {
            continue;
        };
        let force = first + k;
        system.right[up] += state.force[a];
        system.add(up, force, -1.0);
        system.add(force, up, 1.0);
        for (b, slope) in profile.slope.row(a) {
            let along = mesh.position(b, 0);
            system.right[along] -= slope * state.force[a];
            system.add(along, force, slope);
            system.add(force, along, -slope);
        }
        let slope = profile.slope.row_sum(a);
        (0..nodes).for_each(|b| system.add(force, mesh.position(b, 0), slope * share));
        system.add(force, approach, -1.0);
        system.right[force] = -gap[a];
        system.add(approach, force, 1.0);
    }
    let carried: f64 = active_nodes.iter().map(|&a| state.force[a]).sum();
    system.right[approach] = load - carried;
}

/// The increment by elimination, with `active_set` in contact.
fn eliminated(
    pressed: &PressedBlock<'_>,
    state: &State,
    load: f64,
    active_set: &[bool],
) -> Vec<f64> {
    let active_nodes: Vec<usize> = (0..active_set.len()).filter(|&a| active_set[a]).collect();
    let field = state.field.u.len() + state.field.pressure.len();
    let mut system =
        System { entries: Vec::new(), right: vec![0.0; field + active_nodes.len() + 1] };
    add_elements(&mut system, pressed, state);
    add_contact(&mut system, pressed, state, &active_nodes, load);
    system.solve()
}

/// Both orders and three energies, of which two have a permanent network that follows the strain: from
/// a contact that has slid and is not symmetric, but at rest, to a higher load, `increment` against the
/// same by elimination.
fn compare(
    more: f64,
    sampling: Sampling,
    mut increment: impl FnMut(&PressedBlock<'_>, &State, &[RowState], f64) -> (Increment, Vec<bool>),
) {
    for (order, columns, rows) in [(1, 32, 9), (2, 16, 5)] {
        for energy in &energies() {
            let case = Case::elastic(0.12, 0.6).sliding(1.0, &[(0.3, 0.15)]);
            let case = Case { energy: energy.clone(), ..case.on_mesh(columns, rows, order) };
            let problem = case.problem().unwrap();
            let solved = case.solve(None).unwrap();
            assert_eq!(solved.finest.mesh.columns, columns);
            let mut model = Model::new(&problem.rubber, &problem.profile, f64::INFINITY, 1.0);
            model.sampling = sampling;
            let unit = solved.stress_unit / model.stress_unit;
            let state = &solved.finest.state.in_stress_unit(unit);
            let load = more * case.pressure / model.stress_unit;
            let mesh = mesh(columns, rows, case.depth, order);
            let (memory, executor) = (Memory::Relaxed, serial());
            let pressed = model.pressed(&mesh, &memory, &executor);
            let rows = pressed.row_states(&state.field).unwrap();
            let (step, active_set) = increment(&pressed, state, &rows, load);
            let expected = eliminated(&pressed, state, load, &active_set);
            let change = |a: usize| step.contact.force[a] - state.force[a];
            let active_nodes = (0..state.force.len()).filter(|&a| active_set[a]);
            let parts: [Vec<f64>; 4] = [
                step.u.clone(),
                step.pressure.clone(),
                active_nodes.map(change).collect(),
                vec![step.contact.approach - state.approach],
            ];
            let mut at = 0;
            for (which, part) in parts.iter().enumerate() {
                let expected = &expected[at..at + part.len()];
                at += part.len();
                let scale = expected.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
                assert!(scale > 0.0);
                for (step, expected) in part.iter().zip(expected) {
                    let error = (step - expected).abs() / scale;
                    assert!(error < 1e-8, "{order} {energy:?} part {which}: {error}");
                }
            }
        }
    }
}

/// Nodes open and close. GMRES leaves 1e-12 of the forces; what the system's condition makes of that is
/// far below the 1e-8 allowed.
#[test]
fn a_step_by_iteration_is_that_of_sparse_elimination() {
    let (share, least) = (1e-12, 1e-15);
    for sampling in [Sampling::Nodes, Sampling::Patches] {
        compare(1.5, sampling, |pressed, state, rows, load| {
            let settings = Settings::default();
            let residual = Residual::new(pressed, state, rows).unwrap();
            let iterate = Iterate {
                state,
                rows,
                residual: &residual,
                residual_norm: residual.norm(pressed, state, load),
            };
            let accuracy = Accuracy { share, least };
            let step =
                krylov::increment(pressed, iterate, None, load, accuracy, &settings).unwrap();
            assert_ne!(step.contact.active_set, state.active_set);
            let active_set = step.contact.active_set.clone();
            (step, active_set)
        });
    }
}

/// The bordered factor, with pressures condensed and active nodes eliminated, keeps the active set. A little
/// more load pulls no node.
#[test]
fn a_step_by_the_bordered_factor_is_that_of_sparse_elimination() {
    compare(1.3, Sampling::Nodes, |pressed, state, rows, load| {
        let residual = Residual::new(pressed, state, rows).unwrap();
        let bordered = Bordered::new(&pressed.block).unwrap();
        let tangent = bordered.factor(pressed, state, rows, &residual).unwrap();
        let step = bordered.increment(pressed, &tangent, state, &residual, load);
        (step, state.active_set.clone())
    });
}
