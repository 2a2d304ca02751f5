//! Sparse factors of the assembled tangent (faer) against the iteration that the solver uses:
//! what they cost, static contact, time steps, and as preconditioner of steady sliding.
//!
//! cargo bench --features internals --bench sparse_factor -- [MOST NODES ALONG THE WAVE, by default 256]

mod clock;
mod factor;
mod newton_steps;
mod sliding;
mod time_steps;

use std::f64::consts::TAU;

use faer::Mat;
use gripscale_kernel::cancel::Cancel;
use gripscale_kernel::contact::State;
use gripscale_kernel::executor::Executor;
use gripscale_kernel::fem::block::Memory;
use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::fem::pattern::Pattern;
use gripscale_kernel::model::Model;
use gripscale_kernel::problem::{Energy, Heights, Load, MeshSize, Problem, Profile, Rubber};
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solution::MeshSolution;
use gripscale_kernel::solve::newton;
use gripscale_kernel::solve::transfer::transfer;
use gripscale_kernel::status::Status;
use gripscale_kernel::steady;

use clock::timed;
use factor::{Compressed, Ldl, Lu};
use gripscale_kernel::solve::bordered::Bordered;
use newton_steps::eliminate;

const SIZES: [usize; 6] = [32, 64, 128, 256, 512, 1024];
/// A / lambda and pressure over the relaxed modulus: a quarter to six tenths of the nodes touch.
const STATIC: [(f64, f64); 3] = [(0.05, 0.1), (0.1, 0.5), (0.2, 1.5)];

fn main() {
    let mut arguments = std::env::args()
        .skip(1)
        .filter_map(|text| text.parse().ok());
    let most: usize = arguments.next().unwrap_or(256);
    let sizes = || SIZES.into_iter().filter(|&nodes| nodes <= most);
    let meshes: Vec<(usize, usize)> = [1, 2]
        .into_iter()
        .flat_map(|order| sizes().map(move |nodes| (nodes, order)))
        .collect();
    println!(
        "Processor milliseconds, one thread. Meshes: columns x rows, order of the elements.\n"
    );
    let all = std::env::args().all(|text| text != "steps");
    if all {
        factors(&meshes);
        static_contact(&meshes);
    }
    let small = meshes.into_iter().filter(|&(nodes, _)| nodes <= 256);
    let small: Vec<(usize, usize)> = small.collect();
    time_steps::table(&small);
    sliding::table(&small);
}

/// The calling thread alone, never cancelled.
pub fn serial() -> Executor<'static> {
    Executor::serial(Cancel::never())
}

/// A block of unit modulus when relaxed, pressed on a sine; two Maxwell elements where it slides.
pub fn problem((amplitude, pressure): (f64, f64), slides: bool, mesh: (usize, usize)) -> Problem {
    let (nodes, order) = mesh;
    let elements = match slides {
        true => (vec![2.0, 6.0], vec![0.3, 0.03]),
        false => (vec![], vec![]),
    };
    let rows = 20.0 * (nodes as f64 / 128.0).powf(0.33) / order as f64;
    let energy = Energy::new("neo_hookean", &Default::default()).unwrap();
    Problem {
        rubber: Rubber::new(energy, 1.0, elements.0, elements.1, 1000.0).unwrap(),
        profile: Profile::new(1.0, Heights::sine(amplitude).unwrap()).unwrap(),
        load: Load::new(pressure, f64::from(u8::from(slides)), 5.0).unwrap(),
        mesh: MeshSize::new(nodes / order, rows.round() as usize, 1.5, order).unwrap(),
    }
}

/// A problem solved; on its mesh, the solution and what the one on half the columns starts it with.
pub struct Solved {
    pub model: Model,
    pub mesh: Mesh,
    pub start: State,
    pub state: State,
    pub load: f64,
}

impl Solved {
    /// None if there is no solution on just this mesh.
    pub fn new(case: (f64, f64), slides: bool, mesh: (usize, usize)) -> Option<Self> {
        let (problem, settings) = (problem(case, slides, mesh), Settings::default());
        let solution = steady::solve(&problem, &settings, None, None, &serial()).ok()?;
        let converged = solution.finest.report.status == Status::Converged;
        let MeshSolution {
            mesh,
            state,
            coarser,
            ..
        } = solution.finest;
        let (coarse, coarse_state) = coarser?;
        let wanted = Mesh::new(&problem.mesh);
        let solved = converged && mesh.same(&wanted);
        let passage = if slides { 1.0 } else { f64::INFINITY };
        solved.then(|| Self {
            model: Model::new(&problem.rubber, &problem.profile, passage, TAU),
            start: transfer(&coarse, &coarse_state, &wanted, 1.0),
            mesh: wanted,
            state,
            load: case.1 / solution.stress_unit,
        })
    }
}

pub fn name(mesh: &Mesh) -> String {
    format!("{}x{} order {}", mesh.columns, mesh.rows, mesh.order)
}

/// What a factor costs, in contact at the middle load.
fn factors(meshes: &[(usize, usize)]) {
    println!(
        "mesh, unknowns | way | pattern, symbolic once, assembly, factor, solve [ms] | L [1e6], Gflop, MB"
    );
    for &mesh in meshes {
        let Some(solved) = Solved::new(STATIC[1], false, mesh) else {
            continue;
        };
        let (memory, executor) = (Memory::Relaxed, serial());
        let pressed = solved.model.pressed(&solved.mesh, &memory, &executor);
        let rows = pressed
            .row_states(&solved.state.field)
            .expect("never cancelled");
        let block = &pressed.block;
        let (patterned, pattern) = timed(|| Pattern::new(block));
        let assemble = || Compressed::lower(block, &pattern, &solved.state, &rows);
        let (assembly, lower) = timed(assemble);
        let full = lower.full();
        let names = ["LDL dissection", "LDL minimum degree", "LU COLAMD"];
        for (which, way) in names.into_iter().enumerate() {
            let matrix = if which < 2 { &lower } else { &full };
            let right = Mat::from_fn(matrix.size, 1, |i, _| (i % 7) as f64);
            let line = |symbolic: f64, costs: [&clock::Cost; 2], (fill, flops): (f64, f64)| {
                println!(
                    "{}, {} | {way} | {:.2}, {symbolic:.2}, {:.2}, {:.2}, {:.3} | {:.3}, {:.4}, {:.1}",
                    name(&solved.mesh),
                    matrix.size,
                    patterned.ms,
                    assembly.ms,
                    costs[0].ms,
                    costs[1].ms,
                    fill * 1e-6,
                    flops * 1e-9,
                    costs[0].megabytes
                );
            };
            if which < 2 {
                let (symbolic, ldl) = timed(|| Ldl::new(matrix, which == 1));
                let (numeric, factor) = timed(|| ldl.factor(matrix).expect("a factor"));
                let (solve, ()) = timed(|| ldl.solve(&factor, right.clone().as_mut()));
                line(symbolic.ms, [&numeric, &solve], ldl.cost());
            } else {
                let (symbolic, lu) = timed(|| Lu::new(matrix));
                let (numeric, factor) = timed(|| lu.factor(matrix).expect("a factor"));
                let (solve, ()) = timed(|| lu.solve(&factor, right.clone().as_mut()));
                line(symbolic.ms, [&numeric, &solve], (f64::NAN, f64::NAN));
            }
        }
    }
    println!();
}

/// Newton's method on a mesh from the solution on half its columns.
fn static_contact(meshes: &[(usize, usize)]) {
    println!(
        "static: mesh, A/lambda, p | GMRES: ms, Newton, products, MB | factors: ms, pattern and \
         symbolic, Newton, MB | GMRES over factors, apart"
    );
    for &mesh in meshes {
        for case in STATIC {
            let Some(solved) = Solved::new(case, false, mesh) else {
                continue;
            };
            let (memory, executor) = (Memory::Relaxed, serial());
            let pressed = solved.model.pressed(&solved.mesh, &memory, &executor);
            let (iterated, report) = timed(|| {
                let settings = Settings::default();
                newton::solve(&pressed, &mut solved.start.clone(), solved.load, &settings)
            });
            let (symbolic, bordered) = timed(|| Bordered::new(&pressed.block).expect("memory"));
            let (eliminated, (steps, state)) = timed(|| {
                let mut state = solved.start.clone();
                let steps = eliminate(&bordered, &pressed, &mut state, solved.load);
                (steps, state)
            });
            let apart = (state.approach - solved.state.approach).abs() / case.0;
            println!(
                "{}, {}, {} | {:.2}, {}, {}, {:.1} | {:.2}, {:.2}, {}, {:.1} | {}",
                name(&solved.mesh),
                case.0,
                case.1,
                iterated.ms,
                report.iterations,
                report.products,
                iterated.megabytes,
                eliminated.ms,
                symbolic.ms,
                steps.unwrap_or(0),
                eliminated.megabytes,
                match steps.is_some() && apart < 1e-6 {
                    true => {
                        let ratio = iterated.ms / (eliminated.ms + symbolic.ms);
                        format!("{ratio:.2}, {apart:.0e}")
                    }
                    false => "factors do not get there".to_owned(),
                }
            );
        }
    }
    println!();
}
