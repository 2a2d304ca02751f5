//! Contact of a finite-strain viscoelastic rubber block with one rigid sine wave.
//!
//! The rooms, each using only what stands above it:
//! `error`, `element`, `cell` (mesh), `network` and `hyperelastic` (material at a point), `memory`
//! (Maxwell history), `linear` (faer), `assembly`, `wave`, `active_set`, `surface_contact` and
//! `newton` (one load), `march` (raising it), `transfer` (between meshes), `outcome`, `ladder` and
//! `scale` (one wave, from inputs to solution), `networks` and `transient` (sliding in time),
//! `python` (bindings, no numerics).
//!
//! Conventions: inside, lengths are in wavelengths and stresses in units of |G*(2 pi v / lambda)|;
//! x along sliding (the rubber moves in +x over the wave, whose frame is used), z up, rubber above,
//! pressure positive in compression, friction positive when it opposes the sliding.

pub mod active_set;
pub mod assembly;
pub mod cell;
pub mod element;
pub mod error;
pub mod hyperelastic;
pub mod ladder;
pub mod linear;
pub mod march;
pub mod memory;
pub mod network;
pub mod networks;
pub mod newton;
pub mod outcome;
#[cfg(feature = "python")]
mod python;
pub mod scale;
pub mod surface_contact;
pub mod transfer;
pub mod transient;
pub mod wave;
