//! The rigid profile: slope and curvature against finite differences, range, full contact, refusals.

use std::f64::consts::{PI, TAU};

use crate::contact::profile::Heights;
use crate::error::KernelError;
use crate::problem::Profile;

use crate::tests::fixture::{noise, Case};

fn sampled(count: usize, height: impl Fn(f64) -> f64) -> Heights {
    let at = |i: usize| height(i as f64 / count as f64);
    Heights::sampled(&(0..count).map(at).collect::<Vec<_>>()).unwrap()
}

fn rough(count: usize) -> Vec<f64> {
    (0..count).map(|i| 0.1 * noise(i)).collect()
}

/// Central differences at step 1e-5 are right to (2 pi n 1e-5)^2 / 6 of the derivative of wave n: 1e-9
/// for the first, 4e-8 for the eighth, of slopes up to some 10 and curvatures up to some 100.
#[test]
fn slope_and_curvature_are_those_of_the_height() {
    let step = 1e-5;
    for (heights, slope_error, curvature_error) in [
        (Heights::sine(0.3).unwrap(), 1e-8, 1e-7),
        (Heights::sampled(&rough(16)).unwrap(), 1e-6, 1e-4),
        (Heights::sampled(&rough(15)).unwrap(), 1e-6, 1e-4),
    ] {
        for i in 0..20 {
            let x = 0.05 * f64::from(i);
            let difference = |of: &dyn Fn(f64) -> f64| (of(x + step) - of(x - step)) / (2.0 * step);
            let slope = difference(&|x| heights.height(x));
            let curvature = difference(&|x| heights.slope(x));
            assert!((heights.slope(x) - slope).abs() < slope_error);
            assert!((heights.curvature(x) - curvature).abs() < curvature_error);
        }
    }
}

/// Odd and even numbers of samples; only the mean is lost.
#[test]
fn the_function_goes_through_its_samples() {
    for count in [8, 9, 64, 65] {
        let samples = rough(count);
        let mean = samples.iter().sum::<f64>() / count as f64;
        let heights = Heights::sampled(&samples).unwrap();
        for (i, sample) in samples.iter().enumerate() {
            let height = heights.height(i as f64 / count as f64);
            assert!((height - (sample - mean)).abs() < 1e-14);
        }
    }
}

/// The largest of 1e5 points lies below a crest of wave 8 by up to (2 pi 8 5e-6)^2 / 2 = 3e-8.
#[test]
fn the_range_is_that_of_the_function() {
    let sine = Heights::sine(0.3).unwrap();
    assert_eq!((sine.range(), sine.half_range()), ((sine.height(0.5), sine.height(0.0)), 0.3));
    for heights in [sine, Heights::sampled(&rough(16)).unwrap()] {
        let all = (0..100_000).map(|i| heights.height(1e-5 * f64::from(i)));
        let (low, high) = all.fold((0.0_f64, 0.0_f64), |(low, high), h| (low.min(h), high.max(h)));
        let (lowest, highest) = heights.range();
        assert!(lowest <= low && low - lowest < 1e-8);
        assert!(highest >= high && highest - high < 1e-8);
    }
}

/// The same heights in other units of length, and p* = 4 pi A (Johnson 1985, section 13.2).
#[test]
fn units_and_full_contact_follow_the_amplitude() {
    let heights = Heights::sine(3e-4).unwrap().over(2e-3);
    assert_eq!(heights, Heights::sine(3e-4 / 2e-3).unwrap());
    assert!((heights.full_contact_pressure() - 4.0 * PI * 0.15).abs() < 1e-15);
}

/// Wave n of amplitude A alone needs 4 pi n A, wherever its crests are; of two waves the pulls add
/// where their valleys meet: 0.1 cos(2 pi x) - 0.05 cos(4 pi x) has them at x = 1/2 and 0, where
/// the function sum n h_n is -0.1 - 0.1 and 0.1 - 0.1.
#[test]
fn full_contact_of_sampled_heights() {
    let single = sampled(64, |x| 0.1 * (3.0 * TAU * x + 0.4).cos());
    let full = single.full_contact_pressure() / (4.0 * PI * 0.3);
    // One of 32 points a wave is within half a step of the valley: cos(pi / 32) = 0.995.
    assert!((0.995..=1.0 + 1e-12).contains(&full));
    let double = sampled(64, |x| 0.1 * (TAU * x).cos() - 0.05 * (2.0 * TAU * x).cos());
    assert!((double.full_contact_pressure() / (4.0 * PI * 0.2) - 1.0).abs() < 1e-12);
}

#[test]
fn what_is_no_profile_is_refused() {
    let refusal = |samples: &[f64]| Heights::sampled(samples).unwrap_err().to_string();
    let few = "the number of heights must be a whole number from 8 to 8192; got 7";
    assert_eq!(refusal(&[0.0; 7]), few);
    assert!(refusal(&vec![0.0; 8193]).ends_with("got 8193"));
    let flat = "heights must be different from each other, by a finite amount; got 9 times 0.3";
    assert_eq!(refusal(&[0.3; 9]), flat);
    let mut holed = rough(16);
    holed[3] = f64::NAN;
    assert_eq!(refusal(&holed), "heights must be a finite number; got NaN");
}

/// Six nodes along the smallest wave, twice as many nodes as columns in elements of order 2.
#[test]
fn a_mesh_too_coarse_for_the_smallest_wave_is_refused() {
    let mut case = Case::elastic(0.1, 0.5);
    case.heights = Some((0..64).map(|i| 0.01 * (TAU * i as f64 / 8.0).cos()).collect());
    (case.columns, case.rows) = (46, 8);
    let text = case.solve(None).unwrap_err().to_string();
    let expected = "columns must be at least 48 to follow the smallest wave of the heights; got 46";
    assert_eq!(text, expected);
    assert_eq!(case.run(&[], None).unwrap_err().to_string(), expected);
    case.order = 2;
    assert!(case.solve(None).is_ok());
}

/// Same numbers in brief, another profile all the same.
#[test]
fn a_start_on_other_heights_is_refused_briefly() {
    let mut case = Case::elastic(0.1, 0.5);
    let wave = |sign: f64| {
        let height = move |x: f64| (TAU * x).cos() + sign * 0.1 * (2.0 * TAU * x).sin();
        Some((0..64).map(|i| 0.1 * height(i as f64 / 64.0)).collect())
    };
    case.heights = wave(1.0);
    let start = case.solve(None).unwrap();
    assert!(case.run(&[], Some(&start)).is_ok());
    case.heights = wave(-1.0);
    let error = case.run(&[], Some(&start)).unwrap_err();
    assert!(matches!(error, KernelError::OtherStart { name: "profile", .. }));
    assert!(error.to_string().len() < 400);
    assert!(Profile::new(0.0, Heights::sine(1.0).unwrap()).is_err());
}
