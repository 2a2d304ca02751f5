//! The rigid profile: slope and curvature against finite differences, range, full contact.

use std::f64::consts::PI;

use gripscale_kernel::contact::profile::Heights;

#[test]
fn slope_and_curvature_are_those_of_the_height() {
    let heights = Heights::sine(0.3).unwrap();
    // Central differences at step 1e-5 are right to about (2 pi 1e-5)^2 / 6 = 1e-9.
    let step = 1e-5;
    for i in 0..20 {
        let x = 0.05 * f64::from(i);
        let difference = |of: &dyn Fn(f64) -> f64| (of(x + step) - of(x - step)) / (2.0 * step);
        let slope = difference(&|x| heights.height(x));
        let curvature = difference(&|x| heights.slope(x));
        assert!((heights.slope(x) - slope).abs() < 1e-8);
        assert!((heights.curvature(x) - curvature).abs() < 1e-7);
    }
}

#[test]
fn the_range_bounds_the_heights_and_is_reached() {
    let heights = Heights::sine(0.3).unwrap();
    let (lowest, highest) = heights.range();
    assert_eq!(
        (lowest, highest),
        (heights.height(0.5), heights.height(0.0))
    );
    assert_eq!(heights.half_range(), 0.3);
    assert!((0..100).all(|i| (lowest..=highest).contains(&heights.height(0.01 * f64::from(i)))));
}

/// The same heights in other units of length, and p* = 4 pi A (Johnson 1985, section 13.2).
#[test]
fn units_and_full_contact_follow_the_amplitude() {
    let heights = Heights::sine(3e-4).unwrap().over(2e-3);
    assert_eq!(heights, Heights::sine(3e-4 / 2e-3).unwrap());
    assert!((heights.full_contact_pressure() - 4.0 * PI * 0.15).abs() < 1e-15);
}
