//! Work shared between threads: the same to the last bit, and ended by whom it was begun.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::sync::Mutex;
use std::thread;
use std::time::Duration;

use super::{Executor, Threads};
use crate::cancel::Cancel;
use crate::error::KernelError;
use crate::solution::Solution;

use crate::tests::fixture::Case;

/// Any number is worth a thread.
const EAGER: usize = 1;

fn wave(order: usize, speed: f64) -> Case {
    let case = Case::elastic(0.15, 0.6).sliding(speed, &[(2.0, 0.05), (6.0, 0.4)]);
    // Several bands of harmonics, several pieces of a vector, and a last band of one row.
    Case { load_time: 3.0, ..case.on_mesh(256 / order, 22 / order + 1, order) }
}

/// Every bit of the results of a wave and of its state.
fn bits(solution: &Solution) -> Vec<u64> {
    let (finest, outcome) = (&solution.finest, &solution.finest.outcome);
    let said = [
        finest.report.residual,
        finest.state.approach,
        outcome.contact_fraction,
        outcome.friction,
        outcome.friction_from_dissipation,
        outcome.min_stretch,
        outcome.max_stretch,
    ];
    let field = &finest.state.field;
    let numbers = said.iter().chain(&field.u).chain(&field.pressure);
    let numbers = numbers.chain(&finest.state.force);
    let numbers = numbers.chain(&outcome.lost_by_row);
    let counts = [solution.counts.iterations, solution.counts.products];
    let counts = counts.into_iter().map(|count| count as u64);
    counts.chain(numbers.map(|x| x.to_bits())).collect()
}

#[test]
fn no_bit_depends_on_the_number_of_threads() {
    for (order, speed) in [(1, 1.0), (1, 0.0), (2, 1.0), (2, 0.0)] {
        let case = wave(order, speed);
        let alone = bits(&case.solve(None).unwrap());
        for count in [2, 3] {
            let threads = Threads::each_worth(count, EAGER);
            let executor = Executor::new(&threads, Cancel::never());
            let together = bits(&case.solve_with(None, &executor).unwrap());
            assert!(alone == together, "order {order}, speed {speed}: {count} threads");
        }
    }
}

/// Parts that take a while are taken by all, each with its own workspace.
#[test]
fn every_part_is_done_once_and_by_all_threads() {
    let threads = Threads::each_worth(3, EAGER);
    let mut done = vec![0; 60];
    let mut workspaces = vec![0; threads.count_for(60)];
    let who = Mutex::new(BTreeSet::new());
    threads.share(60, &mut workspaces, done.iter_mut(), |workspace, part| {
        thread::sleep(Duration::from_millis(2));
        who.lock().unwrap().insert(format!("{:?}", thread::current().id()));
        *part += 1;
        *workspace += 1;
    });
    assert!(done.iter().all(|&times| times == 1));
    assert_eq!(workspaces.iter().sum::<usize>(), 60);
    assert_eq!(who.into_inner().unwrap().len(), 3);
}

/// A thread costs some ten microseconds to wake: as long as 100,000 numbers take.
#[test]
fn little_work_stays_with_the_calling_thread() {
    let threads = Threads::new(8);
    let counts = [0, 1, 150_000, 200_000, 10_000_000].map(|size| threads.count_for(size));
    assert_eq!(counts, [1, 1, 1, 2, 8]);
}

#[test]
fn a_refusal_ends_the_work_of_all() {
    let threads = Threads::each_worth(2, EAGER);
    let asked = Cell::new(0);
    let look = || {
        asked.set(asked.get() + 1);
        if asked.get() == 3 {
            Err("enough")
        } else {
            Ok(())
        }
    };
    let done = Mutex::new(0);
    let ended = threads.share_until(1000, &mut [(), ()], 0..1000, look, |(), _| {
        thread::sleep(Duration::from_millis(1));
        *done.lock().unwrap() += 1;
    });
    assert_eq!(ended, Err("enough"));
    assert!(done.into_inner().unwrap() < 100);
}

#[test]
fn a_caller_that_stops_is_heard_by_its_own_thread_alone() {
    let (caller, asked) = (thread::current().id(), Cell::new(0));
    let stopped = || {
        assert_eq!(thread::current().id(), caller);
        asked.set(asked.get() + 1);
        asked.get() == 2
    };
    let threads = Threads::each_worth(2, EAGER);
    let case = Case { columns: 1024, ..wave(1, 1.0) };
    let cancel = Cancel::new(&stopped, None).unwrap();
    let ended = case.solve_with(None, &Executor::new(&threads, cancel));
    assert!(matches!(ended, Err(KernelError::Stopped)));
    assert_eq!(asked.get(), 2);
}
