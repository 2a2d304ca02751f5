//! Sliding in time from static contact: whole steps by GMRES, and by a factor that is kept.

use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::problem::Problem;
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solution::Solution;
use gripscale_kernel::status::Status;
use gripscale_kernel::steady;
use gripscale_kernel::transient::{self, Run, Stage};

use crate::clock::{timed, Cost};
use crate::{name, problem, serial};

/// Half a passage, but not more steps than these.
const MOST_STEPS: usize = 64;
/// A / lambda and pressure over the relaxed modulus.
const CASES: [(f64, f64); 3] = [(0.05, 0.15), (0.1, 0.4), (0.16, 1.0)];

pub fn table(meshes: &[(usize, usize)]) {
    println!(
        "time steps: mesh, A/lambda, p | GMRES: ms, Newton, products a step, MB | kept factor: ms, \
         iterations, products a step, MB | ratio, largest difference of the moments"
    );
    for &mesh in meshes {
        for case in CASES {
            let still = problem(case, false, mesh);
            let sliding = problem(case, true, mesh);
            let start = Problem {
                load: still.load,
                ..problem(case, true, mesh)
            };
            let settings = Settings::default();
            let start = steady::solve(&start, &settings, None, None, &serial());
            let Ok(start) = start else { continue };
            let [iterated, kept] = [0.0, 1e3].map(|most| slide(&sliding, case.1, &start, most));
            let ended = |run: &Run| run.status == Status::Converged;
            let steps = iterated.1.moments.len() as f64;
            let line = |(cost, run): &(Cost, Run)| {
                format!(
                    "{:.2}, {:.1}, {:.1}, {:.1}",
                    cost.ms / steps,
                    run.counts.iterations as f64 / steps,
                    run.counts.products as f64 / steps,
                    cost.megabytes
                )
            };
            println!(
                "{}, {}, {} | {} | {} | {:.2}, {:.0e}{}",
                name(&Mesh::new(&sliding.mesh)),
                case.0,
                case.1,
                line(&iterated),
                line(&kept),
                iterated.0.ms / kept.0.ms,
                apart(&iterated.1, &kept.1),
                match ended(&iterated.1) && ended(&kept.1) {
                    true => "",
                    false => ", not both converged",
                }
            );
        }
    }
    println!();
}

fn slide(sliding: &Problem, pressure: f64, start: &Solution, most_nodes: f64) -> (Cost, Run) {
    let columns = Mesh::new(&sliding.mesh).columns;
    let stage = Stage {
        duration: (columns / 2).min(MOST_STEPS) as f64 / columns as f64,
        speed: 1.0,
        pressure,
    };
    let settings = Settings::new([("kept_factor_nodes", most_nodes)]).expect("a setting");
    let Problem {
        rubber,
        profile,
        mesh,
        ..
    } = sliding;
    let (start, executor) = (Some(start), serial());
    timed(|| {
        transient::solve(rubber, profile, mesh, &settings, &[stage], start, &executor)
            .expect("a start of the same rubber")
    })
}

fn apart(one: &Run, other: &Run) -> f64 {
    let pairs = one.moments.iter().zip(&other.moments);
    let differences = pairs.flat_map(|(one, other)| {
        [
            one.friction - other.friction,
            one.contact_fraction - other.contact_fraction,
            one.approach - other.approach,
        ]
    });
    differences.fold(0.0, |most, difference| most.max(difference.abs()))
}
