//! Every constant of the solver that may be tuned, with its default, its range and what it does.

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
    step_halvings: usize = 8 in 1..=50, "Lengths tried for one Newton step, each half of the one before.";
    patience: usize = 12 in 1..=1000, "Newton iterations without a smaller residual after which a load step fails.";

    krylov_share: f64 = 1e-3 in 1e-12..=0.9, "Largest share of the residual forces to which the linearised problem is solved [-].";
    krylov_least_share: f64 = 1e-5 in 1e-12..=0.9, "Smallest share of the residual forces to which it is solved [-].";
    krylov_safety: f64 = 0.9 in 0.01..=1.0, "The share over the square of the last ratio of residuals [-].";
    krylov_basis: usize = 100 in 2..=1000, "Directions kept in the iteration before it restarts.";
    krylov_iterations: usize = 200 in 1..=100_000, "Most iterations for one linearised problem.";

    active_set_rounds: usize = 60 in 0..=10_000, "Changes of the whole active set before nodes enter and leave it one by one, along a path that finds a set if there is one.";
    single_node_rounds: usize = 2000 in 1..=100_000, "Changes of single nodes of the active set.";
    active_set_tolerance: f64 = 1e-12 in 1e-15..=1e-3, "Largest tension and overlap, in units of the mean contact force and the largest gap [-].";
    signs_below: f64 = 0.005 in 0.0..=10.0, "Residual below which the signs of forces and gaps decide the next active set, instead of complementarity with the averaged compliance [-].";
    factored_contacts: usize = 512 in 0..=2048, "Most nodes in contact for which the linearised contact problem is factored; for more it is solved by iteration.";

    iteration_budget: usize = 500 in 1..=100_000, "Newton iterations while the load is raised once.";
    most_load_steps: usize = 300 in 1..=10_000, "Load steps while the load is raised once.";
    first_load: f64 = 0.02 in 1e-6..=1.0, "First pressure over that of full contact [-]: contact a tenth of the wave, small strain.";
    first_load_cut: f64 = 0.3 in 0.01..=0.9, "A first pressure that fails is tried again at this share [-].";
    smallest_first_load: f64 = 1e-7 in 1e-15..=1e-2, "No first pressure is tried below this share of the pressure or of that of full contact [-].";
    largest_growth: f64 = 3.0 in 1.1..=100.0, "Largest ratio of a pressure to the one before [-].";
    smallest_growth: f64 = 1.001 in 1.000001..=1.1, "A load path that needs a smaller ratio has reached a fold [-].";
    growth_gain: f64 = 1.5 in 1.0..=10.0, "Power that raises the ratio of pressures after an easy load step [-].";
    growth_cut: f64 = 0.4 in 0.01..=0.9, "Power that reduces the ratio of pressures after a failed load step [-].";
    easy_iterations: usize = 7 in 1..=1000, "Newton iterations of an easy load step.";

    profile_patches: usize = 1 in 0..=1, "1: a profile touches averaged over the patches of the surface nodes; 0: at the nodes, as a sine does.";
    nodes_per_wave: usize = 12 in 3..=1000, "Nodes along a wave for which a mesh is fine enough to begin with this wave.";
    roughening_patience: usize = 4 in 1..=1000, "Newton iterations without a smaller residual after which waves are added in smaller parts.";
    roughening_iterations: usize = 20 in 1..=1000, "Newton iterations after which waves are added in smaller parts.";
    roughening_share: f64 = 0.03 in 1e-12..=0.9, "Largest share of the residual forces to which the linearised problem is solved while waves are added [-].";
    roughening_step: f64 = 1.0 in 1e-6..=100.0, "Largest change of the displacement gradient in one Newton iteration while waves are added [-].";
    smallest_roughening: f64 = 0.01 in 1e-6..=1.0, "Smallest part of the heights of new waves that is added at once [-].";

    coarsest_nodes: usize = 32 in 8..=2048, "Fewest nodes along the wave on the coarsest mesh of a sequence.";
    finest_columns: usize = 2048 in 4..=4096, "Most columns of a mesh that is refined to meet a tolerance.";
    row_exponent: f64 = 0.585 in 0.01..=1.0, "Rows grow with this power of the columns [-]: by 1.5 for every doubling.";
    edge_error: f64 = 0.15 in 1e-6..=10.0, "Uncertainty of both edges together of a contact of many nodes, in node spacings [-].";
    edge_nodes: f64 = 16.0 in 0.0..=1000.0, "Nodes in a contact or gap for which this uncertainty doubles [-].";
    most_edge_error: f64 = 0.4 in 1e-6..=10.0, "Largest uncertainty of the edges of a contact, in node spacings [-].";
    error_safety: f64 = 1.5 in 1.0..=100.0, "Estimated error of the contact fraction over its change between meshes [-].";
    closing_error: f64 = 1.5 in 0.0..=100.0, "Relative error of the pressure of full contact over (k h)^2, h the node spacing [-].";
    friction_order_error: f64 = 0.6 in 0.0..=100.0, "Least relative error of friction over (k h)^2 [-].";
    friction_node_error: f64 = 1.5 in 0.0..=100.0, "Least relative error of friction times the square of the nodes in a contact [-].";
    pinning: f64 = 0.05 in 0.0..=10.0, "Node spacings by which a contact pinned by nodes may be shifted [-].";
    most_mismatch: f64 = 0.05 in 1e-6..=1e6, "Largest difference of the two frictions in a trusted solution, over the larger [-].";
    small_friction: f64 = 0.04 in 1e-6..=1.0, "Friction over the slope k A below which errors are relative to this share of k A [-].";
    fewest_contact_nodes: usize = 4 in 1..=1000, "Fewest nodes of the contacts that carry half of the load in a trusted solution.";

    dwell_steps: usize = 40 in 2..=10_000, "Time steps of a dwell; their lengths grow geometrically.";
    dwell_first: f64 = 1e-4 in 1e-12..=0.5, "First time step of a dwell over its duration [-].";
    longest_stage: f64 = 10_000.0 in 1.0..=1e6, "Longest sliding distance of one stage [wavelengths].";
    path_columns: usize = 128 in 4..=4096, "Most columns of a mesh finer than the problem's, solved only to confirm a solution, on which the load is raised from rest.";
    rescue_columns: usize = 256 in 4..=4096, "Most columns of a mesh finer than the problem's, solved because the solution on that one failed or cannot be trusted.";
    large_mean_shear: f64 = 2.0 in 0.1..=100.0, "Mean shear of the block beyond which it is the reason why a load path ends [-].";

    kept_factor_nodes: usize = 256 in 0..=8192, "Most nodes along the wave of a mesh on which time steps are solved by a sparse factor that is kept from step to step.";
    load_parts: usize = 8 in 1..=1000, "Parts into which a change of load is cut if a time step fails.";
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
