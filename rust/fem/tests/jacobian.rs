//! The Jacobian that is applied and never formed, against sums over points and against finite
//! differences, and its average along the rows against itself where all columns are alike.

use crate::fem::averaged_jacobian::AveragedJacobian;
use crate::fem::block::{Block, Field, Memory, RowState};
use crate::fem::jacobian::Jacobian;
use crate::fem::mesh::Mesh;
use crate::material::energy::Energy;
use crate::material::kinematics::cofactor;
use crate::material::maxwell::Maxwell;
use crate::material::sliding_history::SlidingHistory;
use crate::material::stress::{memory_slope, tangent};

use crate::material::tests::material_point::remembered_slope;
use crate::material::tests::sliding_history::weights;
use crate::tests::fixture::noise;
use crate::tests::fixture::{energy, mesh, serial};

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

/// J x summed point by point, and over all pairs of columns for the memory.
fn expected(block: &Block<'_>, field: &Field, x: &[f64]) -> Vec<f64> {
    let mesh = block.mesh;
    let (points, modes, columns) = (mesh.order + 1, mesh.modes(), mesh.columns);
    let free = (mesh.layers() - 1) * mesh.layer_size();
    let mut u = x[..free].to_vec();
    u.resize(field.u.len(), 0.0);
    let mut forces = vec![0.0; u.len()];
    let mut volumes = vec![0.0; x.len() - free];
    for row in 0..mesh.rows {
        let state = block.row_state(row, &field.u);
        let change = block.gradients(row, &u, 0.0);
        let element = &mesh.elements[row];
        for (line, df) in change.iter().enumerate() {
            let times = |slope: &[[f64; 4]; 4], x: &[f64; 4]| -> [f64; 4] {
                slope.map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum())
            };
            let dy: Vec<[f64; 4]> = df
                .iter()
                .zip(&state.deformation[line])
                .map(|(df, f)| times(&remembered_slope(f), df))
                .collect();
            for q in 0..df.len() {
                let (column, point) = (q / points, q % points);
                let at = line * points + point;
                let (f, h) = (&state.deformation[line][q], &state.h[line][q]);
                let level = |p: &dyn Fn(usize) -> f64| -> f64 {
                    (0..modes).map(|m| element.mode[at][m] * p(m)).sum()
                };
                let position = |m: usize| (row * modes + m) * columns + column;
                let pressure = level(&|m| field.pressure[(row * columns + column) * modes + m]);
                let pressure_change = level(&|m| x[free + position(m)]);
                let mut dp = times(&tangent(f, h, pressure), &df[q]);
                if let Some(slope) = block.energy.network_slope(f) {
                    let dh = times(&slope, &df[q]).map(|b| block.equilibrium * b);
                    let by_network = times(&memory_slope(f), &dh);
                    (0..4).for_each(|k| dp[k] += by_network[k]);
                }
                if let Memory::Sliding(history) = block.memory {
                    let mut dh = [0.0; 4];
                    for (m, weight) in weights(history).iter().enumerate() {
                        let from = (column + columns - m) % columns * points + point;
                        (0..4).for_each(|k| dh[k] += weight * dy[from][k]);
                    }
                    let by_memory = times(&memory_slope(f), &dh);
                    (0..4).for_each(|k| dp[k] += by_memory[k]);
                }
                let cof = cofactor(&f.f);
                let volume: f64 = (0..4).map(|k| cof[k] * df[q][k]).sum();
                for m in 0..modes {
                    volumes[position(m)] += element.weight[at] * element.mode[at][m] * volume;
                }
                for (node, slope) in element.gradient[at].iter().enumerate() {
                    let (layer, sub) = (node / points, node % points);
                    let base = (row * mesh.order + layer) * mesh.layer_size();
                    for i in 0..2 {
                        let p = [0, 1].map(|k| dp[2 * i + k] + pressure_change * cof[2 * i + k]);
                        let force = p[0] * slope[0] + p[1] * slope[1];
                        let unknown = mesh.position(mesh.order * column + sub, i);
                        forces[base + unknown] += element.weight[at] * force;
                    }
                }
            }
        }
        for (m, mass) in element.mode_mass.iter().enumerate() {
            for column in 0..columns {
                let at = (row * modes + m) * columns + column;
                volumes[at] -= mass / block.bulk_modulus * x[free + at];
            }
        }
    }
    forces.truncate(free);
    forces.extend(volumes);
    forces
}

/// Numbers of columns that fill their lanes and that do not; sums in another order agree to round-off.
#[test]
fn the_product_is_the_sum_over_points_and_pairs() {
    for (order, slides, columns) in [(1, false, 6), (1, true, 13), (2, false, 8), (2, true, 10)] {
        for energy in energies() {
            let mesh = mesh(columns, 3, 0.8, order);
            let memory = memory(&mesh, slides);
            let block = block(&mesh, &memory, energy);
            let field = bent(&mesh);
            let jacobian = jacobian(&block, &field);
            let x: Vec<f64> = (0..unknowns(&jacobian)).map(|i| noise(1000 + i)).collect();
            let mut product = vec![0.0; x.len()];
            jacobian.product(&x, &mut product, &mut jacobian.workspace(serial().threads));
            let expected = expected(&block, &field, &x);
            let scale = expected.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            for (product, expected) in product.iter().zip(&expected) {
                let error = (product - expected).abs() / scale;
                assert!(error < 1e-13, "order {order}, sliding {slides}: {error}");
            }
        }
    }
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

/// 1e-6 is asked for; central differences at this step are right to about 1e-9.
#[test]
fn the_product_is_the_slope_of_forces_and_volumes() {
    for (order, slides) in [(1, false), (1, true), (2, false), (2, true)] {
        for energy in energies() {
            let mesh = mesh(6, 3, 0.8, order);
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
