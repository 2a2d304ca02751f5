//! Whole waves, through the entry points of the kernel, and what all tests share. Tests of parts of the kernel
//! stand beside the code.

pub mod fixture;
mod hostile_input;
mod krylov;
mod settings;
mod steady;
mod transient;
