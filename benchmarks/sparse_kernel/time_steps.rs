//! Sliding in time from static contact: a step by the iteration, by a factor for every Newton
//! iteration, and by a factor that is kept from step to step.

use std::f64::consts::TAU;

use gripscale_kernel::contact::{PressedBlock, State};
use gripscale_kernel::fem::block::Memory;
use gripscale_kernel::material::carried_history::{CarriedHistory, Points};
use gripscale_kernel::model::Model;
use gripscale_kernel::problem::Problem;
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solve::newton;
use gripscale_kernel::status::Status;
use gripscale_kernel::watch::Watch;

use crate::bordered::{Bordered, Kept, Spent};
use crate::clock::now;
use crate::{name, problem, Solved};

/// Half a passage, but not more steps than these.
const MOST_STEPS: usize = 64;
/// A / lambda and pressure over the relaxed modulus.
const CASES: [(f64, f64); 3] = [(0.05, 0.15), (0.1, 0.4), (0.16, 1.0)];

#[derive(Clone, Copy, PartialEq)]
enum Way {
    Iterated,
    Eliminated,
    Kept,
}

/// What a run took, and where it ended.
struct Run {
    /// A step [ms].
    ms: f64,
    /// A step.
    iterations: f64,
    extra: f64,
    approach: f64,
    converged: bool,
}

pub fn table(meshes: &[(usize, usize)]) {
    println!(
        "time steps: mesh, A/lambda, p | GMRES: ms, Newton, products a step | factors: ms, Newton | \
         kept factors: ms, Newton, factors | GMRES over each, apart"
    );
    for &mesh in meshes {
        for case in CASES {
            let Some(solved) = Solved::new(case, false, mesh) else {
                continue;
            };
            let sliding = problem(case, true, mesh);
            let run = |way: Way| slide(&solved, &sliding, way);
            let [iterated, eliminated, kept] = [Way::Iterated, Way::Eliminated, Way::Kept].map(run);
            let apart = [&eliminated, &kept].map(|run| (run.approach - iterated.approach).abs());
            println!(
                "{}, {}, {} | {:.2}, {:.1}, {:.1} | {:.2}, {:.1} | {:.2}, {:.1}, {:.2} | {:.2}, {:.2}, {:.0e}{}",
                name(&solved.mesh),
                case.0,
                case.1,
                iterated.ms,
                iterated.iterations,
                iterated.extra,
                eliminated.ms,
                eliminated.iterations,
                kept.ms,
                kept.iterations,
                kept.extra,
                iterated.ms / eliminated.ms,
                iterated.ms / kept.ms,
                apart[0].max(apart[1]) / case.0,
                match iterated.converged && eliminated.converged && kept.converged {
                    true => "",
                    false => ", not all converged",
                }
            );
        }
    }
    println!();
}

fn slide(solved: &Solved, sliding: &Problem, way: Way) -> Run {
    let model = Model::new(&sliding.rubber, &sliding.profile, 1.0, TAU);
    let (watch, settings, relaxed) = (Watch::endless(), Settings::default(), Memory::Relaxed);
    let unit = solved.model.stress_unit / model.stress_unit;
    let (mut state, load) = (solved.state.restressed(unit), solved.load * unit);
    let mesh = &solved.mesh;
    let pressed = model.pressed(mesh, &relaxed, &watch);
    let y = remembered(&pressed, &state);
    let mut networks = CarriedHistory::relaxed(y, mesh.columns, &model.maxwell);
    let (bordered, mut kept): (_, Option<Kept>) = (Bordered::new(&pressed.block), None);
    let steps = (mesh.columns / 2).min(MOST_STEPS);
    let dt = 1.0 / mesh.columns as f64;
    let (mut ms, mut iterations, mut extra, mut converged) = (0.0, 0, 0, true);
    for _ in 0..steps {
        networks.carry(true);
        let memory = Memory::Given(networks.known_part(&model.maxwell, dt));
        let pressed = model.pressed(mesh, &memory, &watch);
        let begin = now();
        if way == Way::Iterated {
            let report = newton::solve(&pressed, &mut state, load, &settings);
            converged &= report.status == Status::Converged;
            iterations += report.iterations;
            extra += report.products;
        } else {
            let mut spent = Spent::default();
            let how = (way == Way::Eliminated, &mut spent);
            converged &= bordered.newton(&pressed, &mut state, load, &mut kept, how);
            iterations += spent.iterations;
            extra += spent.factors;
        }
        ms += now() - begin;
        networks.advance(remembered(&pressed, &state), &model.maxwell, dt);
    }
    Run {
        ms: ms / steps as f64,
        iterations: iterations as f64 / steps as f64,
        extra: extra as f64 / steps as f64,
        approach: state.approach,
        converged,
    }
}

fn remembered(pressed: &PressedBlock<'_>, state: &State) -> Points {
    let rows = pressed.row_states(&state.field).expect("an endless watch");
    rows.iter().map(|row| row.remembered()).collect()
}
