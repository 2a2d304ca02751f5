//! Steady sliding: the first Newton step on a mesh, preconditioned by the average along the rows
//! and by a sparse factor of the tangent at fixed memory, the contact of the first kept by both.

use gripscale_kernel::executor::Threads;
use gripscale_kernel::fem::block::Memory;
use gripscale_kernel::fem::jacobian::Jacobian;
use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::linear::gmres;
use gripscale_kernel::material::sliding_history::SlidingHistory;
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solve::bordered::{Bordered, LinearSolution};
use gripscale_kernel::solve::krylov::{self, Accuracy};
use gripscale_kernel::solve::newton_step::Iterate;
use gripscale_kernel::solve::residual::Residual;

use crate::clock::timed;
use crate::{name, serial, Solved};

/// A / lambda and pressure over the relaxed modulus.
const CASES: [(f64, f64); 3] = [(0.05, 0.5), (0.1, 2.0), (0.16, 5.0)];
/// The forces out of balance fall to this share.
const SHARE: f64 = 1e-3;
const LIMITS: (usize, usize) = (100, 400);

pub fn table(meshes: &[(usize, usize)]) {
    println!("sliding: mesh, A/lambda, p | average: ms, products | factor: ms, products | ratio");
    for &mesh in meshes {
        for case in CASES {
            let Some(solved) = Solved::new(case, true, mesh) else {
                continue;
            };
            let model = &solved.model;
            let history = SlidingHistory::new(solved.mesh.columns, &model.maxwell, 5.0);
            let (memory, executor) = (Memory::Sliding(history), serial());
            let pressed = model.pressed(&solved.mesh, &memory, &executor);
            let start = &solved.start;
            let (averaged, found) = timed(|| {
                let rows = pressed.row_states(&start.field).expect("never cancelled");
                let accuracy = Accuracy {
                    share: SHARE,
                    least: 0.0,
                };
                let settings = Settings::default();
                let residual = Residual::new(&pressed, start, &rows).expect("never cancelled");
                let now = Iterate {
                    state: start,
                    rows: &rows,
                    residual: &residual,
                    residual_norm: residual.norm(&pressed, start, solved.load),
                };
                krylov::increment(&pressed, now, None, solved.load, accuracy, &settings)
                    .expect("a step")
            });
            let bordered = Bordered::new(&pressed.block).expect("memory");
            let (factored, products) = timed(|| {
                let mut state = start.clone();
                state.active_set = found.contact.active_set.clone();
                for (force, active) in state.force.iter_mut().zip(&state.active_set) {
                    *force *= f64::from(u8::from(*active));
                }
                let rows = pressed.row_states(&state.field).expect("never cancelled");
                let residual = Residual::new(&pressed, &state, &rows).expect("never cancelled");
                let jacobian =
                    Jacobian::new(&pressed.block, &state.field, &rows, &executor).unwrap();
                let more = solved.load - state.force.iter().sum::<f64>();
                let tangent = bordered.factor(&pressed, &state, &rows, &residual);
                let tangent = tangent.expect("a factor");
                let bend = residual.turning_stiffness(&pressed, &state);
                let solve = |v: &[f64], gap: &[f64], more: f64| {
                    let (forces, volumes) = v.split_at(jacobian.displacements());
                    let mut forces: Vec<f64> = forces.iter().map(|force| -force).collect();
                    forces.resize(state.field.u.len(), 0.0);
                    let wrong = Residual {
                        forces,
                        volumes: volumes.iter().map(|volume| -volume).collect(),
                        profile: residual.profile.clone(),
                        gap: gap.to_vec(),
                    };
                    bordered.solve(&pressed.block, &tangent, &wrong, more)
                };
                let threads = Threads::new(1);
                let mut work = jacobian.workspace(&threads);
                let mut product = |change: &LinearSolution, out: &mut [f64]| {
                    let y = mixed(&jacobian, &change.u, &change.pressure);
                    jacobian.product(&y, out, &mut work);
                    let shift = solved.mesh.mean_shift(&y);
                    let along = residual.profile.slope.transposed(&change.force);
                    let moved = |a: usize| y[solved.mesh.position(a, 0)] - shift;
                    for (a, force) in change.force.iter().enumerate() {
                        let [x, z] = [0, 1].map(|d| solved.mesh.position(a, d));
                        out[x] += bend.product(moved, a) + along[a];
                        out[z] -= force;
                    }
                };
                let right = residual.right_hand_side(&pressed);
                let mut left = vec![0.0; right.len()];
                product(&solve(&right, &residual.gap, more), &mut left);
                left.iter_mut()
                    .zip(&right)
                    .for_each(|(left, r)| *left = r - *left);
                let closed = vec![0.0; residual.gap.len()];
                let apply = |v: &[f64], out: &mut [f64]| product(&solve(v, &closed, 0.0), out);
                let target = SHARE * size(&right).max(size(&left));
                gmres(apply, &left, target, LIMITS, &executor)
                    .unwrap()
                    .iterations
            });
            println!(
                "{}, {}, {} | {:.2}, {} | {:.2}, {products} | {:.2}",
                name(&solved.mesh),
                case.0,
                case.1,
                averaged.ms,
                found.products,
                factored.ms,
                averaged.ms / factored.ms
            );
        }
    }
}

fn size(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Free displacements, then pressures `[row][mode][column]`.
fn mixed(jacobian: &Jacobian<'_>, u: &[f64], pressure: &[f64]) -> Vec<f64> {
    let mut out = u[..jacobian.displacements()].to_vec();
    let mut turned = vec![0.0; pressure.len()];
    each(jacobian.mesh, |field, mixed| {
        turned[mixed] = pressure[field]
    });
    out.extend(turned);
    out
}

/// Places of a pressure in a field and among the mixed unknowns.
fn each(mesh: &Mesh, mut visit: impl FnMut(usize, usize)) {
    let (modes, columns) = (mesh.modes(), mesh.columns);
    for field in 0..mesh.rows * columns * modes {
        let (row, column, mode) = (
            field / modes / columns,
            field / modes % columns,
            field % modes,
        );
        visit(field, (row * modes + mode) * columns + column);
    }
}
