//! The whole tangent of one element row, local and along the stream, against finite differences.

use crate::{add_pressure, energy, mesh, noise};
use gripscale_kernel::fem::block::{Block, Field, Memory};
use gripscale_kernel::linear;
use gripscale_kernel::material::energy::Energy;
use gripscale_kernel::material::maxwell::Maxwell;
use gripscale_kernel::material::sliding_history::SlidingHistory;
use gripscale_kernel::watch::Watch;

fn worst_error(order: usize, energy: Energy, memory: bool) -> f64 {
    let mesh = mesh(6, 3, 0.8, order);
    let maxwell = Maxwell {
        equilibrium: 1.0,
        moduli: vec![2.0, 6.0],
        times: vec![0.05, 0.4],
    };
    let memory = if memory {
        Memory::Sliding(SlidingHistory::new(mesh.columns, &maxwell, 0.7))
    } else {
        Memory::Relaxed
    };
    let block = Block {
        mesh: &mesh,
        energy,
        equilibrium: maxwell.equilibrium,
        memory: &memory,
        bulk_modulus: 30.0,
    };
    let row = 1;
    let mut field = Field::at_rest(&mesh);
    for (i, u) in field.u.iter_mut().enumerate() {
        *u = 0.03 * noise(i);
    }
    // Fulfil the pressure equation, so that the condensed system is the slope of the forces alone.
    let still = vec![0.0; field.u.len()];
    let state = block.row_state(row, &field.u);
    add_pressure(&block, row, &state, &still, &mut field);
    let matrix = block
        .row_matrix(row, &field, &state, &Watch::endless())
        .unwrap();
    let direction: Vec<f64> = (0..field.u.len()).map(|i| noise(1000 + i)).collect();
    let forces = |step: f64| {
        let mut moved = field.clone();
        let change: Vec<f64> = direction.iter().map(|d| step * d).collect();
        for (u, d) in moved.u.iter_mut().zip(&change) {
            *u += d;
        }
        add_pressure(&block, row, &state, &change, &mut moved);
        let moved_state = block.row_state(row, &moved.u);
        block.row_forces(row, &moved, &moved_state).0
    };
    let step = 1e-6;
    let (high, low) = (forces(step), forces(-step));
    let offset = row * order * mesh.layer_size();
    let local = linear::column(&direction[offset..offset + high.len()]);
    let mut slope = linear::Matrix::zeros(high.len(), 1);
    linear::product(&mut slope, &matrix, &local);
    let scale = (0..high.len()).fold(0.0_f64, |m, i| m.max(slope[(i, 0)].abs()));
    (0..high.len()).fold(0.0_f64, |m, i| {
        let difference = (high[i] - low[i]) / (2.0 * step);
        m.max((slope[(i, 0)] - difference).abs() / scale)
    })
}

fn energies() -> [Energy; 3] {
    [
        energy("neo_hookean", &[]),
        energy("mooney_rivlin", &[("share", 0.3)]),
        energy("yeoh", &[("second", -0.1), ("third", 0.02)]),
    ]
}

/// 1e-6 is asked for; central differences at this step are right to about 1e-9.
#[test]
fn local_tangent_equals_finite_differences() {
    for order in [1, 2] {
        for energy in energies() {
            let error = worst_error(order, energy, false);
            assert!(error < 1e-7, "order {order}, {energy:?}: {error}");
        }
    }
}

#[test]
fn streamline_tangent_equals_finite_differences() {
    for order in [1, 2] {
        for energy in energies() {
            let error = worst_error(order, energy, true);
            assert!(error < 1e-7, "order {order}, {energy:?}: {error}");
        }
    }
}
