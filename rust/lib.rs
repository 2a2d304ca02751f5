//! Contact of a finite-strain viscoelastic rubber block with one period of a rigid profile.
//!
//! A user needs `problem` (what is solved), `settings` (how), `steady::solve` and
//! `transient::solve`, and `solution`, `status` and `error` (what comes back). The other rooms are
//! public for the tests alone. Each uses only what stands before it:
//!
//! | room | what |
//! |---|---|
//! | `error`, `status`, `settings` | refusals, endings, every constant of the solver |
//! | `threads` | the one file with rayon: work shared between threads, in parts that do not depend on them |
//! | `watch` | whether to go on: a caller that stops, a limit of time; who does the work |
//! | `spectral` | the one file with realfft: transforms of lines |
//! | `linear` | the one room with faer: dense LU, sparse L D L^T, small complex blocks, GMRES |
//! | `material` | kinematics, stress, strain energies, Maxwell elements and what they remember |
//! | `fem` | element, mesh, block, element rows, their Jacobian applied or assembled |
//! | `contact` | profile, answer of the averaged surface, complementarity, edges between nodes |
//! | `outcome` | contact, friction and stretches of a state |
//! | `problem`, `model` | one wave in SI units, checked; the same in kernel units |
//! | `solve` | Newton, its linear problem by GMRES or a kept factor, load stepping, meshes, transfer |
//! | `solution`, `steady`, `transient` | one wave solved; steady sliding; sliding in time |
//! | `python` | bindings, no numerics |
//!
//! Conventions: inside, lengths are in wavelengths and stresses in units of |G*(2 pi v / lambda)|;
//! x along sliding (the rubber moves in +x over the profile, whose frame is used), z up, rubber
//! above, pressure positive in compression, friction positive when it opposes the sliding.

pub mod contact;
pub mod error;
pub mod fem;
pub mod linear;
pub mod material;
pub mod model;
pub mod outcome;
pub mod problem;
#[cfg(feature = "python")]
mod python;
pub mod settings;
pub mod solution;
pub mod solve;
pub mod spectral;
pub mod status;
pub mod steady;
pub mod threads;
pub mod transient;
pub mod watch;
