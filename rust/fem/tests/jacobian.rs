//! The Jacobian that is applied and never formed, against finite differences, and its average along
//! the rows against itself where all columns are alike.

use crate::fem::averaged_jacobian::AveragedJacobian;
use crate::fem::block::{Block, Field, Memory, RowState};
use crate::fem::jacobian::Jacobian;
use crate::fem::mesh::Mesh;
use crate::material::energy::Energy;
use crate::material::maxwell::Maxwell;
use crate::material::sliding_history::SlidingHistory;

use crate::tests::fixture::{energy, mesh, noise, serial};

fn memory(mesh: &Mesh, slides: bool) -> Memory {
    let maxwell = Maxwell { equilibrium: 1.0, moduli: vec![2.0, 6.0], times: vec![0.05, 0.4] };
    match slides {
        true => Memory::Sliding(SlidingHistory::new(mesh.columns, &maxwell, 0.7)),
        false => Memory::Relaxed,
    }
}

fn block<'a>(mesh: &'a Mesh, memory: &'a Memory, energy: Energy) -> Block<'a> {
    Block { mesh, energy, equilibrium: 1.0, memory, bulk_modulus: 30.0 }
}

fn states(block: &Block<'_>, field: &Field) -> Vec<RowState> {
    let rows = 0..block.mesh.rows;
    rows.map(|row| block.row_state(row, &field.u)).collect()
}

fn jacobian<'a>(block: &Block<'a>, field: &Field) -> Jacobian<'a> {
    let rows = states(block, field);
    Jacobian::new(block, field, &rows, &serial()).unwrap()
}

/// Displacements, and pressures `[row][mode][column]`.
fn unknowns(jacobian: &Jacobian<'_>) -> usize {
    let mesh = jacobian.mesh;
    jacobian.displacements() + mesh.rows * mesh.modes() * mesh.columns
}

fn energies() -> [Energy; 3] {
    [
        energy("neo_hookean", &[]),
        energy("mooney_rivlin", &[("share", 0.3)]),
        energy("yeoh", &[("second", -0.1), ("third", 0.02)]),
    ]
}

fn bent(mesh: &Mesh) -> Field {
    let mut field = Field::at_rest(mesh);
    let free = field.u.len() - mesh.layer_size();
    for (i, u) in field.u[..free].iter_mut().enumerate() {
        *u = 0.2 * mesh.node_spacing() * noise(i);
    }
    for (i, p) in field.pressure.iter_mut().enumerate() {
        *p = 0.5 * noise(70_000 + i);
    }
    field
}

/// Forces and volumes of a field, in the order of the mixed unknowns.
fn residual(block: &Block<'_>, field: &Field) -> Vec<f64> {
    let mesh = block.mesh;
    let mut out = vec![0.0; (mesh.layers() - 1) * mesh.layer_size()];
    let mut all = Vec::new();
    for (row, state) in states(block, field).iter().enumerate() {
        let forces = block.row_forces(row, field, state);
        let at = row * mesh.order * mesh.layer_size();
        out[at..].iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
        all.extend(block.row_volumes(row, field, state));
    }
    out.extend(all);
    out
}

/// Numbers of columns that fill their lanes and that do not. 1e-6 is asked for; central differences at
/// this step are right to about 1e-9.
#[test]
fn the_product_is_the_slope_of_forces_and_volumes() {
    for (order, slides, columns) in [(1, false, 6), (1, true, 13), (2, false, 8), (2, true, 10)] {
        for energy in energies() {
            let mesh = mesh(columns, 3, 0.8, order);
            let memory = memory(&mesh, slides);
            let block = block(&mesh, &memory, energy);
            let field = bent(&mesh);
            let jacobian = jacobian(&block, &field);
            let x: Vec<f64> = (0..unknowns(&jacobian)).map(|i| noise(1000 + i)).collect();
            let moved = |step: f64| {
                let mut moved = field.clone();
                let (u, p) = x.split_at(jacobian.displacements());
                moved.u.iter_mut().zip(u).for_each(|(u, d)| *u += step * d);
                let (modes, columns) = (mesh.modes(), mesh.columns);
                for (at, d) in p.iter().enumerate() {
                    let (row, m, column) =
                        (at / columns / modes, at / columns % modes, at % columns);
                    moved.pressure[(row * columns + column) * modes + m] += step * d;
                }
                residual(&block, &moved)
            };
            let (high, low) = (moved(1e-6), moved(-1e-6));
            let mut product = vec![0.0; x.len()];
            jacobian.product(&x, &mut product, &mut jacobian.workspace(serial().threads));
            let scale = product.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            for i in 0..x.len() {
                let error = (product[i] - (high[i] - low[i]) / 2e-6).abs() / scale;
                assert!(error < 1e-7, "order {order}, sliding {slides}: {error}");
            }
        }
    }
}

/// A block stretched, sheared and pressed alike in all columns: its average is itself, and solving
/// with it undoes the product.
#[test]
fn a_uniform_state_is_solved_at_once() {
    for (order, slides, columns) in [(1, false, 8), (1, true, 13), (2, false, 7), (2, true, 16)] {
        let mesh = mesh(columns, 4, 0.8, order);
        let memory = memory(&mesh, slides);
        let block = block(&mesh, &memory, energy("mooney_rivlin", &[("share", 0.3)]));
        let mut field = Field::at_rest(&mesh);
        for (layer, z) in mesh.layer_heights().into_iter().enumerate() {
            for node in 0..mesh.layer_nodes() {
                let at = layer * mesh.layer_size();
                field.u[at + mesh.position(node, 0)] = 0.3 * (0.8 - z) + 0.1 * (z * 7.0).sin();
                field.u[at + mesh.position(node, 1)] = 0.02 * (0.8 - z) * (0.8 - z);
            }
        }
        for (i, p) in field.pressure.iter_mut().enumerate() {
            *p = if i % mesh.modes() == 0 { 0.3 } else { 0.0 };
        }
        let jacobian = jacobian(&block, &field);
        let average = AveragedJacobian::new(&jacobian, &serial()).unwrap();
        let right: Vec<f64> = (0..unknowns(&jacobian)).map(noise).collect();
        let mut solution = vec![0.0; right.len()];
        let mut work = average.workspace(serial().threads);
        let surface = average.reduce(&right, &mut work);
        average.expand(&surface, &mut solution, &mut work);
        let mut back = vec![0.0; right.len()];
        jacobian.product(&solution, &mut back, &mut jacobian.workspace(serial().threads));
        for i in 0..right.len() {
            let error = (back[i] - right[i]).abs();
            assert!(error < 1e-10, "order {order}, sliding {slides}, unknown {i}: {error}");
        }
    }
}
