//! Settings: one list by name, ranges held, unknown names refused with what there is.

use crate::settings::Settings;

#[test]
fn every_setting_can_be_given_by_its_name() {
    let defaults = Settings::default().list();
    let names: Vec<&str> = defaults.iter().map(|entry| entry.0).collect();
    for &(name, value, sentence) in &defaults {
        assert!(sentence.ends_with('.') && sentence.len() > 20, "{name}");
        assert_eq!(names.iter().filter(|other| **other == name).count(), 1);
        assert_eq!(Settings::new([(name, value)]).unwrap(), Settings::default());
        let changed_value = if value >= 2.0 {
            value - 1.0
        } else if name == "profile_patches" {
            0.0 // a switch
        } else {
            value * 1.05
        };
        let changed = Settings::new([(name, changed_value)]).unwrap().list();
        for (before, after) in defaults.iter().zip(&changed) {
            assert_eq!(before.1 != after.1, before.0 == name, "{name} and {}", after.0);
        }
    }
}

#[test]
fn refusals_name_value_and_range() {
    for (name, value, text) in [
        ("max_iterations", 0.0, "max_iterations must be a whole number from 1 to 1000; got 0"),
        ("max_iterations", 1.5, "max_iterations must be a whole number from 1 to 1000; got 1.5"),
        ("dwell_first", f64::NAN, "dwell_first must be from 1e-12 to 0.5; got NaN"),
        ("newton", 1.0, "setting must be one of max_iterations, residual_tolerance, "),
    ] {
        let refusal = Settings::new([(name, value)]).unwrap_err().to_string();
        assert!(refusal.starts_with(text), "{refusal}");
    }
}
