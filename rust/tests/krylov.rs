//! The linearised problem solved by iteration leads to what dense elimination leads to.

use std::time::Instant;

use gripscale_kernel::settings::Settings;

use crate::Case;

#[test]
fn trial() {
    for (columns, rows, order, amplitude, pressure, speed) in [
        (64, 12, 1, 0.1, 0.2, 0.0),
        (64, 12, 1, 0.1, 0.2, 1.0),
        (64, 12, 1, 0.2, 0.4, 1.0),
        (64, 12, 1, 0.3, 0.6, 1.0),
        (32, 8, 2, 0.2, 0.4, 1.0),
        (128, 20, 1, 0.2, 0.4, 1.0),
        (256, 30, 1, 0.2, 0.4, 1.0),
        (256, 30, 1, 0.2, 2.5, 1.0),
        (128, 20, 1, 0.27, 2.5, 1.0),
        (512, 45, 1, 0.2, 0.4, 1.0),
        (1024, 60, 1, 0.2, 0.4, 1.0),
    ] {
        if std::env::var("ONLY").is_ok_and(|only| only != columns.to_string()) {
            continue;
        }
        let mut case = Case::elastic(amplitude, pressure);
        (case.columns, case.rows, case.order, case.speed) = (columns, rows, order, speed);
        if speed > 0.0 {
            case.moduli = vec![1.0, 2.0];
            case.relaxation_times = vec![0.05, 0.5];
            case.load_time = 5.0;
        }
        for dense in [8192.0, 32.0] {
            if columns > 128 && dense > 100.0 {
                continue;
            }
            let mut changes = vec![("dense_nodes", dense), ("residual_tolerance", 1e-10)];
            if let Ok(text) = std::env::var("CHANGES") {
                for pair in text.leak().split(',').filter(|p| !p.is_empty()) {
                    let (name, value) = pair.split_once('=').unwrap();
                    changes.push((name, value.parse().unwrap()));
                }
            }
            case.settings = Settings::new(changes).unwrap();
            let start = Instant::now();
            let found = case.solve(None).unwrap();
            let outcome = &found.finest.outcome;
            println!(
                "{columns}x{rows} order {order} A {amplitude} p {pressure} v {speed} dense {dense}: {} steps {} its {} prod {} mu {:.12} area {:.12} {:.3} s",
                found.finest.report.status.word(), found.counts.load_steps, found.counts.iterations, found.counts.products,
                outcome.friction, outcome.contact_fraction, start.elapsed().as_secs_f64()
            );
        }
    }
}
