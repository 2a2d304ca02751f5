//! Contact of a finite-strain viscoelastic rubber block with one rigid sine wave.
