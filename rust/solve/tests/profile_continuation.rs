//! Rough profiles, begun smooth on coarse meshes: the same solution as by raising the load, where that
//! finds one.

use std::f64::consts::TAU;

use crate::contact::profile::Heights;
use crate::status::Status;

use crate::tests::fixture::{noise, Case};

/// Heights of `waves` waves with slopes of about `slope` each at phases without structure.
fn rough(waves: usize, slope: f64) -> Vec<f64> {
    let samples = 4 * waves.max(4);
    let height = |i: usize| -> f64 {
        let x = TAU * i as f64 / samples as f64;
        let wave = |n: usize| slope / (TAU * n as f64) * (n as f64 * x + 3.0 * noise(n)).cos();
        (1..=waves).map(wave).sum()
    };
    (0..samples).map(height).collect()
}

fn rough_case(waves: usize, slope: f64, speed: f64) -> Case {
    let case = Case::elastic(0.1, 0.15).sliding(speed, &[(2.0, 0.05)]).on_mesh(128, 18, 1);
    Case { heights: Some(rough(waves, slope)), ..case }
}

#[test]
fn waves_are_left_out_and_come_back() {
    let all = Heights::sampled(&rough(8, 0.2)).unwrap();
    let few = all.smoothed(3);
    assert_eq!((all.waves(), few.waves()), (8, 3));
    for i in 0..20 {
        let x = 0.05 * f64::from(i);
        let part = few.toward(&all, 0.25).height(x);
        let between = 0.75 * few.height(x) + 0.25 * all.height(x);
        assert!((part - between).abs() < 1e-15);
        assert_eq!(few.toward(&all, 1.0).height(x), all.height(x));
    }
    let sine = Heights::sine(0.1).unwrap();
    assert_eq!((sine.waves(), sine.smoothed(1)), (1, sine));
}

/// Eight nodes along the smallest of 16 waves. With three a wave every mesh is fine enough to begin
/// with, and the load is raised.
#[test]
fn the_way_to_the_solution_does_not_matter() {
    for speed in [0.0, 1.0] {
        let case = rough_case(16, 0.15, speed);
        let smooth_first = case.finest();
        let raised = case.with_settings([("nodes_per_wave", 3.0)]).finest();
        for solution in [&smooth_first, &raised] {
            assert!(solution.report.residual < 1e-8 && solution.report.load_reached == 1.0);
        }
        let (a, b) = (&smooth_first.outcome, &raised.outcome);
        assert!((a.friction - b.friction).abs() < 1e-7, "{} {}", a.friction, b.friction);
        assert!((a.contact_fraction - b.contact_fraction).abs() < 1e-7);
        // The errors of both are estimated from the mesh of half the columns, whichever was solved first.
        assert_eq!(smooth_first.coarser_columns(), Some(64));
        let change = (smooth_first.friction_error - raised.friction_error).abs();
        assert!(change < 1e-6, "{change}");
    }
}

/// Slopes of 3 in each of 20 waves, all of them added at once in three Newton iterations on a mesh with six
/// nodes to the smallest.
#[test]
fn a_profile_too_rough_for_the_mesh_says_so() {
    let hasty =
        [("roughening_iterations", 3.0), ("smallest_roughening", 1.0), ("rescue_columns", 128.0)];
    let solution = rough_case(20, 3.0, 1.0).with_settings(hasty).solve(None).unwrap();
    assert_eq!(solution.finest.report.status, Status::ProfileTooRough);
    assert!((1..20).contains(&solution.waves_carried.unwrap()));
    assert_eq!(solution.finest.report.load_reached, 0.0);
    let smooth = rough_case(16, 0.15, 1.0).solve(None).unwrap();
    assert_eq!(smooth.waves_carried, None);
}
