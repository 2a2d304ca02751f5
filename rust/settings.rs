//! What a user may set, with its default, its range and what it does. Other constants of the solver stand where
//! they are used.

use crate::error::{between, unknown, whole, KernelError};

/// A type of number that a setting can have.
trait Setting: Copy + std::fmt::Debug {
    fn read(name: &str, value: f64, least: Self, most: Self) -> Result<Self, KernelError>;
    fn number(self) -> f64;
}

impl Setting for usize {
    fn read(name: &str, value: f64, least: Self, most: Self) -> Result<Self, KernelError> {
        whole(name, value, least, most)
    }

    fn number(self) -> f64 {
        self as f64
    }
}

impl Setting for f64 {
    fn read(name: &str, value: f64, least: Self, most: Self) -> Result<Self, KernelError> {
        between(name, value, least, most)
    }

    fn number(self) -> f64 {
        self
    }
}

/// One line declares a setting: name, kind, default, range, and its sentence.
macro_rules! settings {
    ($($name:ident: $kind:ty = $default:literal in $least:literal..=$most:literal, $doc:literal;)+) => {
        /// Settings within their ranges; only `Settings::new` changes one.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct Settings {
            $(#[doc = $doc] pub(crate) $name: $kind,)+
        }

        impl Default for Settings {
            fn default() -> Self {
                Self { $($name: $default,)+ }
            }
        }

        impl Settings {
            /// Name, value and sentence of every setting.
            pub fn list(&self) -> Vec<(&'static str, f64, &'static str)> {
                vec![$((stringify!($name), self.$name.number(), $doc),)+]
            }

            fn set(&mut self, name: &str, value: f64) -> Result<(), KernelError> {
                match name {
                    $(stringify!($name) => {
                        self.$name = Setting::read(stringify!($name), value, $least, $most)?;
                    })+
                    _ => return Err(unknown("setting", name, &[$(stringify!($name)),+])),
                }
                Ok(())
            }
        }
    };
}

settings! {
    max_iterations: usize = 40 in 1..=1000, "Newton iterations in one load step.";
    residual_tolerance: f64 = 1e-8 in 1e-15..=1.0, "Largest residual force over the load, and gap over half the profile's range [-].";
    largest_step: f64 = 0.4 in 1e-6..=100.0, "Largest change of the displacement gradient in one Newton iteration [-].";
    smallest_volume_ratio: f64 = 0.15 in 1e-6..=0.9, "A Newton step may leave no Gauss point with a smaller ratio of volumes [-].";
    patience: usize = 12 in 1..=1000, "Newton iterations without a smaller residual after which a load step fails.";
    krylov_share: f64 = 1e-3 in 1e-12..=0.9, "Largest share of the residual forces to which the linearised problem is solved [-].";
    factored_contacts: usize = 512 in 0..=2048, "Most nodes in contact for which the linearised contact problem is factored; for more it is solved by iteration.";
    iteration_budget: usize = 500 in 1..=100_000, "Newton iterations while the load is raised once.";
    profile_patches: usize = 1 in 0..=1, "1: a profile touches averaged over the patches of the surface nodes; 0: at the nodes, as a sine does.";
    nodes_per_wave: usize = 12 in 3..=1000, "Nodes along a wave for which a mesh is fine enough to begin with this wave.";
    roughening_iterations: usize = 20 in 1..=1000, "Newton iterations after which waves are added in smaller parts.";
    smallest_roughening: f64 = 0.01 in 1e-6..=1.0, "Smallest part of the heights of new waves that is added at once [-].";
    finest_columns: usize = 2048 in 4..=4096, "Most columns of a mesh that is refined to meet a tolerance.";
    row_exponent: f64 = 0.585 in 0.01..=1.0, "Rows grow with this power of the columns [-]: by 1.5 for every doubling.";
    most_mismatch: f64 = 0.05 in 1e-6..=1e6, "Largest difference of the two frictions in a trusted solution, over the larger [-].";
    path_columns: usize = 128 in 4..=4096, "Most columns of a mesh finer than the problem's, solved only to confirm a solution, on which the load is raised from rest.";
    rescue_columns: usize = 256 in 4..=4096, "Most columns of a mesh finer than the problem's, solved because the solution on that one failed or cannot be trusted.";
    dwell_steps: usize = 40 in 2..=10_000, "Time steps of a dwell; their lengths grow geometrically.";
    dwell_first: f64 = 1e-4 in 1e-12..=0.5, "First time step of a dwell over its duration [-].";
    kept_factor_nodes: usize = 256 in 0..=8192, "Most nodes along the wave of a mesh on which time steps are solved by a sparse factor that is kept from step to step.";
}

impl Settings {
    /// The defaults with `changes` of (name, value).
    pub fn new<'n>(changes: impl IntoIterator<Item = (&'n str, f64)>) -> Result<Self, KernelError> {
        let mut settings = Self::default();
        for (name, value) in changes {
            settings.set(name, value)?;
        }
        Ok(settings)
    }
}
