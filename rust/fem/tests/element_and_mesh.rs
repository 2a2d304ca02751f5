//! Shape functions reproduce what they must; the mesh adds up; an affine field is in equilibrium.

use crate::fem::block::{Block, Field, Memory};
use crate::fem::element::{lagrange, lagrange_slope, Element};
use crate::material::energy::{Energy, NeoHookean};
use crate::material::maxwell::Maxwell;
use crate::material::sliding_history::SlidingHistory;

use crate::tests::fixture::{balance_volumes, mesh};

#[test]
fn shape_functions_sum_to_one_and_their_slopes_to_zero() {
    for order in [1, 2] {
        for s in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            let sum: f64 = lagrange(order, s).iter().sum();
            let slope: f64 = lagrange_slope(order, s).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15 && slope.abs() < 1e-15);
        }
    }
}

#[test]
fn gradients_are_exact_for_linear_fields_and_weights_give_the_area() {
    for order in [1, 2] {
        let (width, height) = (0.2, 0.7);
        let element = Element::new(order, width, height);
        let area: f64 = element.weight.iter().sum();
        assert!((area - width * height).abs() < 1e-15);
        for gradient in &element.gradient {
            let mut slope = [0.0; 2];
            for layer in 0..=order {
                for column in 0..=order {
                    let x = width * column as f64 / order as f64;
                    let z = height * layer as f64 / order as f64;
                    let value = 3.0 * x - 2.0 * z;
                    let g = gradient[layer * (order + 1) + column];
                    slope[0] += value * g[0];
                    slope[1] += value * g[1];
                }
            }
            assert!((slope[0] - 3.0).abs() < 1e-13 && (slope[1] + 2.0).abs() < 1e-13);
        }
    }
}

#[test]
fn pressure_modes_are_orthogonal_with_the_stated_mass() {
    let element = Element::new(2, 0.3, 0.4);
    for m in 0..3 {
        for n in 0..3 {
            let product: f64 =
                (0..9).map(|q| element.weight[q] * element.mode[q][m] * element.mode[q][n]).sum();
            let expected = if m == n { element.mode_mass[m] } else { 0.0 };
            assert!((product - expected).abs() < 1e-15);
        }
    }
}

#[test]
fn rows_grow_away_from_the_contact_and_fill_the_depth() {
    let mesh = mesh(64, 14, 1.5, 1);
    let total: f64 = mesh.row_height.iter().sum();
    assert!((total - 1.5).abs() < 1e-12);
    assert!((mesh.row_height[0] - 1.0 / 64.0).abs() < 1e-6);
    assert!(mesh.row_height.windows(2).all(|pair| pair[1] >= pair[0]));
}

/// Patch test: simple shear and stretch, u = (a z, b z), leaves every inner layer in balance.
#[test]
fn an_affine_deformation_is_in_equilibrium() {
    let maxwell = Maxwell { equilibrium: 1.0, moduli: vec![4.0], times: vec![0.1] };
    for order in [1, 2] {
        let mesh = mesh(8, 5, 1.5, order);
        let memory = Memory::Sliding(SlidingHistory::new(mesh.columns, &maxwell, 0.3));
        let block = Block {
            mesh: &mesh,
            energy: Energy::NeoHookean(NeoHookean),
            equilibrium: maxwell.equilibrium,
            memory: &memory,
            bulk_modulus: 50.0,
        };
        let mut field = Field::at_rest(&mesh);
        for (layer, z) in mesh.layer_heights().into_iter().enumerate() {
            for node in 0..mesh.layer_nodes() {
                let at = layer * mesh.layer_size();
                field.u[at + mesh.position(node, 0)] = 0.4 * z;
                field.u[at + mesh.position(node, 1)] = -0.2 * z;
            }
        }
        let mut total = vec![0.0; field.u.len()];
        for row in 0..mesh.rows {
            let state = block.row_state(row, &field.u);
            balance_volumes(&block, row, &state, &mut field);
            let forces = block.row_forces(row, &field, &state);
            let volumes = block.row_volumes(row, &field, &state);
            assert!(volumes.iter().map(|v| v * v).sum::<f64>() < 1e-28);
            let offset = row * order * mesh.layer_size();
            for (sum, force) in total[offset..].iter_mut().zip(&forces) {
                *sum += force;
            }
        }
        let inner = mesh.layer_size()..(mesh.layers() - 1) * mesh.layer_size();
        let worst = total[inner].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let surface = total[..mesh.layer_size()].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        // Round-off of forces of the order of the surface forces.
        assert!(worst < 1e-13 * surface.max(1.0), "{worst} of {surface}");
        assert!(surface > 0.1);
    }
}
