//! The Jacobian that is applied and never formed against the dense one, and its average along the rows
//! against itself where all columns are alike.

use gripscale_kernel::fem::block::{Block, Field, Memory};
use gripscale_kernel::fem::jacobian::Jacobian;
use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::fem::uniform::Uniform;
use gripscale_kernel::linear;
use gripscale_kernel::material::energy::Energy;
use gripscale_kernel::material::maxwell::Maxwell;
use gripscale_kernel::material::sliding_history::SlidingHistory;
use gripscale_kernel::watch::Watch;

use crate::{energy, mesh, noise};

fn memory(mesh: &Mesh, slides: bool) -> Memory {
    let maxwell = Maxwell {
        equilibrium: 1.0,
        moduli: vec![2.0, 6.0],
        times: vec![0.05, 0.4],
    };
    match slides {
        true => Memory::Sliding(SlidingHistory::new(mesh.columns, &maxwell, 0.7)),
        false => Memory::Relaxed,
    }
}

fn block<'a>(mesh: &'a Mesh, memory: &'a Memory, energy: Energy) -> Block<'a> {
    Block {
        mesh,
        energy,
        equilibrium: 1.0,
        memory,
        bulk_modulus: 30.0,
    }
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

/// With dp = K M^-1 B^T du the volumes balance and the forces are those of the condensed tangent,
/// which the dense path forms and finite differences confirm: the same sums in another order.
#[test]
fn the_product_is_that_of_the_dense_tangent() {
    for (order, slides, columns) in [(1, false, 6), (1, true, 13), (2, false, 5), (2, true, 10)] {
        for energy in [
            energy("neo_hookean", &[]),
            energy("mooney_rivlin", &[("share", 0.3)]),
        ] {
            let mesh = mesh(columns, 3, 0.8, order);
            let memory = memory(&mesh, slides);
            let block = block(&mesh, &memory, energy);
            let field = bent(&mesh);
            let rows: Vec<_> = (0..mesh.rows)
                .map(|row| block.row_state(row, &field.u))
                .collect();
            let jacobian = Jacobian::new(&block, &field, &rows);
            let (count, free) = (jacobian.unknowns(), jacobian.displacements());
            let mut x = vec![0.0; count];
            for (i, value) in x[..free].iter_mut().enumerate() {
                *value = noise(1000 + i);
            }
            let (mut y, mut room) = (vec![0.0; count], jacobian.room());
            jacobian.product(&x, &mut y, &mut room);
            let modes = mesh.modes();
            for row in 0..mesh.rows {
                for m in 0..modes {
                    let stiffness = 30.0 / mesh.elements[row].mode_mass[m];
                    for column in 0..columns {
                        let at = free + (row * modes + m) * columns + column;
                        x[at] = stiffness * y[at];
                    }
                }
            }
            jacobian.product(&x, &mut y, &mut room);
            let mut u = x[..free].to_vec();
            u.resize(field.u.len(), 0.0);
            let mut expected = vec![0.0; field.u.len()];
            for row in 0..mesh.rows {
                let matrix = block
                    .row_matrix(row, &field, &rows[row], &Watch::endless())
                    .unwrap();
                let offset = row * order * mesh.layer_size();
                let local = linear::column(&u[offset..offset + matrix.ncols()]);
                let mut forces = linear::Matrix::zeros(matrix.nrows(), 1);
                linear::product(&mut forces, &matrix, &local);
                for i in 0..matrix.nrows() {
                    expected[offset + i] += forces[(i, 0)];
                }
            }
            let scale = expected.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            for i in 0..free {
                let error = (y[i] - expected[i]).abs() / scale;
                assert!(error < 1e-13, "order {order}, sliding {slides}: {error}");
            }
            let volumes = y[free..].iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            assert!(
                volumes < 1e-14,
                "order {order}, sliding {slides}: {volumes}"
            );
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
                field.u[at + mesh.place(node, 0)] = 0.3 * (0.8 - z) + 0.1 * (z * 7.0).sin();
                field.u[at + mesh.place(node, 1)] = 0.02 * (0.8 - z) * (0.8 - z);
            }
        }
        for (i, p) in field.pressure.iter_mut().enumerate() {
            *p = if i % mesh.modes() == 0 { 0.3 } else { 0.0 };
        }
        let rows: Vec<_> = (0..mesh.rows)
            .map(|row| block.row_state(row, &field.u))
            .collect();
        let jacobian = Jacobian::new(&block, &field, &rows);
        let uniform = Uniform::new(&jacobian).unwrap();
        let right: Vec<f64> = (0..jacobian.unknowns()).map(noise).collect();
        let mut solution = vec![0.0; right.len()];
        let mut room = uniform.room();
        let surface = uniform.reduce(&right, &mut room);
        uniform.expand(&surface, &mut solution, &mut room);
        let mut back = vec![0.0; right.len()];
        jacobian.product(&solution, &mut back, &mut jacobian.room());
        for i in 0..right.len() {
            let error = (back[i] - right[i]).abs();
            assert!(
                error < 1e-10,
                "order {order}, sliding {slides}, unknown {i}: {error}"
            );
        }
    }
}
