//! No input panics: whatever the numbers, the answer is a refusal or a status.

use crate::transient::Stage;
use proptest::prelude::*;

use crate::tests::fixture::{cases, Case};

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        24 => 1e-3_f64..1e3,
        1 => prop::num::f64::ANY,
        1 => Just(0.0),
        1 => (-300.0_f64..300.0).prop_map(|e| 10f64.powf(e)),
    ]
}

proptest! {
    #![proptest_config(cases(300, "rust/proptest-regressions/hostile_input.txt"))]
    #[test]
    fn no_input_panics(
        numbers in prop::collection::vec(any_number(), 8),
        moduli in prop::collection::vec(any_number(), 0..4),
        times in prop::collection::vec(any_number(), 0..4),
        columns in 2_usize..20,
        rows in 1_usize..6,
        order in 1_usize..3,
    ) {
        let case = Case {
            energy: [("neo_hookean", vec![]), ("mooney_rivlin", vec![("share", numbers[0])]),
                ("yeoh", vec![("second", numbers[1]), ("third", numbers[2])])][rows % 3].clone(),
            equilibrium_modulus: numbers[0],
            moduli,
            relaxation_times: times,
            bulk_modulus: numbers[1],
            wavelength: numbers[2],
            amplitude: numbers[3],
            pressure: numbers[4],
            speed: numbers[5],
            load_time: numbers[6],
            depth: numbers[7],
            columns,
            rows,
            order,
            ..Case::elastic(1.0, 1.0)
        };
        let case = case.with_settings([("max_iterations", 5.0), ("iteration_budget", 60.0)]);
        let stage = Stage { duration: numbers[7], speed: numbers[5], pressure: numbers[4] };
        let sampled = Case { heights: Some(numbers.clone()), columns: 24, ..case.clone() };
        if let Ok(solution) = sampled.solve(None) {
            prop_assert!(solution.counts.iterations < 1000);
        }
        let solution = case.solve(None);
        if let Ok(solution) = &solution {
            prop_assert!(solution.counts.iterations < 1000);
        }
        if stage.duration * (stage.speed / numbers[2]).abs() < 2.0 {
            for start in [None, solution.as_ref().ok()] {
                if let Ok(run) = case.run(&[stage], start) {
                    prop_assert!(run.moments.len() <= 42);
                }
            }
        }
    }
}

#[test]
fn an_endless_way_is_refused() {
    let stage = Stage { duration: 1e9, speed: 1e9, pressure: 0.1 };
    let error = Case::elastic(0.1, 0.1).run(&[stage], None).map(|_| ()).unwrap_err();
    assert!(error.to_string().starts_with("a stage may slide over at most 10000 wavelengths"));
}

#[test]
fn refusals_name_the_value() {
    let refuse = |change: fn(&mut Case)| {
        let mut case = Case::elastic(0.1, 0.1);
        change(&mut case);
        case.solve(None).map(|_| ()).unwrap_err()
    };
    let error = refuse(|case| case.pressure = -2.0);
    assert_eq!(error.to_string(), "pressure must be greater than zero and finite; got -2");
    let columns = refuse(|case| case.columns = 2).to_string();
    assert_eq!(columns, "columns must be a whole number from 4 to 4096; got 2");
    assert!(refuse(|case| case.moduli = vec![1.0])
        .to_string()
        .contains("same length; got 1 and 0"));
    assert!(refuse(|case| case.load_time = f64::NAN)
        .to_string()
        .starts_with("load_time must be zero or more"));
}
