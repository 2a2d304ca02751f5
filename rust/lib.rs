//! Contact of a finite-strain viscoelastic rubber block with one period of a rigid profile.
//!
//! The public modules are `problem` (what is solved), `settings` (how), `steady` and `transient` (the two
//! entry points), `solution` and `status` (the result), `error`, and `cancel` and `executor` (when to stop,
//! and with how many threads). All other modules are internal; tests stand beside the code. Each module
//! uses only what stands before it:
//!
//! | module | contents |
//! |---|---|
//! | `error`, `status`, `settings` | refusals, endings, what a user may set |
//! | `cancel` | whether to go on: a caller who stops, a time limit |
//! | `executor` | the one file with rayon: work shared between threads, in parts that do not depend on them |
//! | `spectral` | the one file with realfft: transforms, convolutions and correlations of lines |
//! | `linear` | the one module with faer: dense LU, small complex blocks, sparse L D L^T, GMRES |
//! | `material` | kinematics, stress, strain energies, Maxwell elements and their memory |
//! | `fem` | element, mesh, block, element rows, their Jacobian applied, averaged or assembled |
//! | `contact` | profile, compliance of the averaged surface, linear complementarity, edges between nodes |
//! | `outcome` | contact, friction and stretches of a state |
//! | `problem`, `model` | one wave in SI units, checked; the same in kernel units |
//! | `solution` | a solved wave, with reports and counts |
//! | `solve` | Newton, its linear problem by GMRES or a kept factor, load stepping, meshes, transfer |
//! | `steady`, `transient` | steady sliding; sliding in time |
//! | `line_filter`, `map_filter` | filters of lines and maps in single precision, by rustfft |
//! | `gap_extension`, `line_system`, `map_system` | points in contact with a half-space, for the bindings |
//! | `python` | bindings, no numerics |
//!
//! `KernelError` means that there is no result: an input was refused, the caller stopped, or the kernel has a
//! bug; `Status` is part of every result and says whether it converged or why it did not, so internal
//! functions also return it as their error.
//!
//! Conventions: inside, lengths are in wavelengths and stresses in units of |G*(2 pi v / lambda)|;
//! x along sliding (the rubber moves in +x over the profile, whose frame is used), z up, rubber
//! above, pressure positive in compression, friction positive when it opposes the sliding.

/// Internal modules, public with the feature `internals` for `benchmarks/sparse_kernel` alone.
macro_rules! internal_modules {
    ($($name:ident),+ $(,)?) => {
        $(
            #[cfg(not(feature = "internals"))]
            mod $name;
            #[cfg(feature = "internals")]
            pub mod $name;
        )+
    };
}

pub mod cancel;
pub mod error;
pub mod executor;
pub mod problem;
pub mod settings;
pub mod solution;
pub mod status;
pub mod steady;
pub mod transient;

internal_modules!(contact, fem, linear, material, model, outcome, solve, spectral);

#[cfg_attr(not(feature = "python"), allow(dead_code))]
mod gap_extension;
#[cfg_attr(not(feature = "python"), allow(dead_code))]
mod line_filter;
#[cfg_attr(not(feature = "python"), allow(dead_code))]
mod line_system;
#[cfg_attr(not(feature = "python"), allow(dead_code))]
mod map_filter;
#[cfg_attr(not(feature = "python"), allow(dead_code))]
mod map_system;
#[cfg(feature = "python")]
mod python;
#[cfg(test)]
mod tests;
