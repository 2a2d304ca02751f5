//! Which nodes the next Newton step holds in contact.
//!
//! Far from balance complementarity with the averaged compliance tells the whole set at once. Near it the
//! signs of forces and gaps decide as they came out: primal-dual active set method, which is Newton's for
//! the exact problem (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865). The average is not
//! exact, and where it is far from what the block is at an edge, under pressures like the modulus, its
//! sets call for one another for ever.

use super::increment::Now;
use crate::settings::Settings;

/// The nodes to hold from `now` on; none where the average is to tell.
pub fn next_set(now: Now<'_>, settings: &Settings) -> Option<Vec<bool>> {
    if now.residual > settings.signs_below {
        return None;
    }
    let (state, gap) = (now.state, &now.balance.gap);
    let tolerance = settings.active_set_tolerance;
    let touching = state.active.iter().filter(|&&active| active).count();
    let force_scale = state.force.iter().sum::<f64>() / touching as f64;
    let gap_scale = gap.iter().fold(0.0_f64, |most, gap| most.max(gap.abs()));
    let touches = |a: usize| match state.active[a] {
        true => state.force[a] >= -tolerance * force_scale,
        false => gap[a] < -tolerance * gap_scale,
    };
    let set: Vec<bool> = (0..gap.len()).map(touches).collect();
    set.contains(&true).then_some(set)
}
