//! Whole waves through the public interface of the kernel. Tests of its parts stand beside the code.

mod case;
mod hostile_input;
mod krylov;
mod settings;
mod steady;
mod transient;
