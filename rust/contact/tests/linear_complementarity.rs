//! The dense contact problem: its conditions hold, and the answer is that of trying every set.

use std::f64::consts::{PI, TAU};

use crate::contact::complementarity_problem::{
    ApproximateInverse, ComplementarityProblem, Compliance, Contact,
};
use crate::contact::linear_complementarity::solve;
use crate::linear::{Factor, Matrix};
use crate::settings::Settings;
use crate::tests::fixture::{cases, serial};
use proptest::prelude::*;

/// A smooth, slightly unsymmetric compliance as contact has: decaying with distance.
fn compliance(n: usize, skew: f64) -> Matrix<f64> {
    Matrix::from_fn(n, n, |i, j| {
        let distance = i as f64 - j as f64;
        (-distance.abs() / 2.0).exp() * (1.0 + skew * distance / n as f64)
    })
}

/// Compliance of a half-plane in steady sliding whose modulus grows like i w at the smallest waves:
/// the reciprocal of k (1 + 1.4 i k); the mean and the smallest wave make it regular.
fn viscous(n: usize) -> Matrix<f64> {
    let part = |m: f64| -> f64 {
        let wave = |k: usize| {
            let k = k as f64;
            let (turn, loss) = (TAU * k * m / n as f64, 1.4 * k);
            2.0 * (turn.cos() + loss * turn.sin()) / (k * (1.0 + loss * loss))
        };
        1.0 + (1..n / 2).map(wave).sum::<f64>() + (PI * m).cos() / n as f64
    };
    let by_distance: Vec<f64> = (0..n).map(|m| part(m as f64)).collect();
    Matrix::from_fn(n, n, |i, j| by_distance[(n + i - j) % n])
}

struct Dense<'a>(&'a Matrix<f64>);

impl Compliance for Dense<'_> {
    fn entry(&self, to: usize, from: usize) -> f64 {
        self.0[(to, from)]
    }

    fn add_opening(&self, force: &[f64], gap: &mut [f64]) {
        for (j, &f) in force.iter().enumerate() {
            if f != 0.0 {
                for (g, c) in gap.iter_mut().zip(self.0.col_as_slice(j)) {
                    *g += c * f;
                }
            }
        }
    }

    fn approximate_inverse(&self, _active_nodes: &[usize]) -> Option<ApproximateInverse<'_>> {
        let factor = Factor::new(self.0);
        Some(Box::new(move |opening| {
            let mut force = opening.to_vec();
            assert!(factor.solve(&mut force));
            force
        }))
    }
}

/// With any number of nodes factored, and none.
fn solved(c: &Matrix<f64>, free: &[f64], load: f64, start: &[bool]) -> [Contact; 2] {
    let problem = ComplementarityProblem { compliance: &Dense(c), free_gap: free, load };
    [512.0, 0.0].map(|most| {
        let settings = Settings::new([("factored_contacts", most)]).unwrap();
        let executor = serial();
        let (contact, system) = solve(&problem, start, &settings, &executor).unwrap();
        // The system is that of the contact's active set.
        let (force, approach) = system.solve(free, load, &executor).unwrap().unwrap();
        let apart = |(a, b): (&f64, &f64)| (a - b).abs();
        let most = force.iter().zip(&contact.force).map(apart);
        let most = most.fold((approach - contact.approach).abs(), f64::max);
        assert!(most < 1e-8 * load.max(1.0), "{most}");
        contact
    })
}

fn fulfils(c: &Matrix<f64>, free: &[f64], load: f64, contact: &Contact) -> bool {
    let n = free.len();
    let total: f64 = contact.force.iter().sum();
    let scale = load.max(1.0);
    (total - load).abs() < 1e-9 * scale
        && (0..n).all(|i| {
            let pushed: f64 = (0..n).map(|j| c[(i, j)] * contact.force[j]).sum();
            let gap = free[i] + pushed - contact.approach;
            let open = !contact.active_set[i];
            contact.force[i] >= -1e-9 * scale
                && gap >= -1e-9 * scale
                && (if open { contact.force[i] == 0.0 } else { gap.abs() < 1e-9 * scale })
        })
}

/// Every active set by brute force: how many fulfil the conditions, and the approach of the first.
fn brute_force(c: &Matrix<f64>, free: &[f64], load: f64) -> Vec<f64> {
    let n = free.len();
    let mut approaches = Vec::new();
    for mask in 1u32..1 << n {
        let set: Vec<usize> = (0..n).filter(|i| mask >> i & 1 == 1).collect();
        let m = set.len();
        let matrix = Matrix::from_fn(m + 1, m + 1, |i, j| {
            if i < m && j < m {
                c[(set[i], set[j])]
            } else if i == m && j == m {
                0.0
            } else if i < m {
                -1.0
            } else {
                1.0
            }
        });
        let mut right: Vec<f64> = set.iter().map(|&i| -free[i]).collect();
        right.push(load);
        if !Factor::new(&matrix).solve(&mut right) {
            continue;
        }
        let mut contact =
            Contact { force: vec![0.0; n], approach: right[m], active_set: vec![false; n] };
        for (&i, &f) in set.iter().zip(&right) {
            contact.force[i] = f;
            contact.active_set[i] = true;
        }
        if fulfils(c, free, load, &contact) {
            approaches.push(contact.approach);
        }
    }
    approaches
}

const FAILED: &str = "rust/proptest-regressions/complementarity.txt";

proptest! {
    #![proptest_config(cases(256, FAILED))]

    #[test]
    fn the_answer_is_that_of_trying_every_set(
        free in prop::collection::vec(-1.0_f64..1.0, 2..9),
        load in 1e-3_f64..10.0,
        skew in -0.5_f64..0.5,
        start in prop::collection::vec(any::<bool>(), 9),
    ) {
        let c = compliance(free.len(), skew);
        let all = brute_force(&c, &free, load);
        for contact in solved(&c, &free, load, &start[..free.len()]) {
            prop_assert!(fulfils(&c, &free, load, &contact));
            prop_assert!(all.iter().any(|d| (d - contact.approach).abs() < 1e-8));
        }
    }

    #[test]
    fn many_nodes_from_any_start(
        free in prop::collection::vec(-1.0_f64..1.0, 60),
        load in 1e-3_f64..100.0,
        start in prop::collection::vec(any::<bool>(), 60),
    ) {
        let c = compliance(60, 0.3);
        for contact in solved(&c, &free, load, &start) {
            prop_assert!(fulfils(&c, &free, load, &contact));
        }
    }

}

proptest! {
    #![proptest_config(cases(40, FAILED))]

    #[test]
    fn a_very_lossy_wave_under_any_load_from_any_start(
        load in 1e-2_f64..100.0,
        crest in 0_usize..48,
        touching in 1_usize..48,
    ) {
        let c = viscous(48);
        let free: Vec<f64> = (0..48).map(|i| -(TAU * i as f64 / 48.0).cos()).collect();
        let start: Vec<bool> = (0..48).map(|i| (48 + i - crest) % 48 < touching).collect();
        for contact in solved(&c, &free, load, &start) {
            prop_assert!(fulfils(&c, &free, load, &contact));
        }
    }
}
