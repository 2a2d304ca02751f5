//! How a solve ended: converged, or why its numbers are not to be trusted.

/// One entry declares a status: name, word, what it means, and what the user can do about it.
macro_rules! statuses {
    ($($name:ident = $word:literal, $sentence:literal, $advice:literal;)+) => {
        /// The ending of a solve. A solution carries one of `ALL`.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Status {
            $(#[doc = $sentence] $name,)+
            /// The caller stopped the work. No solution carries this: the solve returns
            /// `KernelError::Stopped`.
            Stopped,
        }

        impl Status {
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// The name of the status in results and messages.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$name => $word,)+
                    Self::Stopped => "stopped",
                }
            }

            /// What the status means.
            pub fn sentence(self) -> &'static str {
                match self {
                    $(Self::$name => $sentence,)+
                    Self::Stopped => "The caller stopped the work.",
                }
            }

            /// What the user can do; empty if there is nothing to do.
            pub fn advice(self) -> &'static str {
                match self {
                    $(Self::$name => $advice,)+
                    Self::Stopped => "",
                }
            }
        }
    };
}

statuses! {
    Converged = "converged",
        "The solution meets the contact conditions and the bound of the residual at the full pressure.",
        "";
    IterationLimit = "iteration limit",
        "The solve used all allowed Newton iterations before it reached the full pressure.",
        "Raise max_iterations, or start from the solution at a lower pressure or a lower speed.";
    ElementInverted = "element inverted",
        "A Newton step turned an element inside out, even at the smallest step of the pressure.",
        "Try another mesh: set element_order = 2 at large strain, or take more rows where the mean shear is large.";
    NoActiveSet = "no active set",
        "No set of nodes in contact satisfies the contact conditions.",
        "Try more columns, or start from the solution at a lower pressure.";
    NotFinite = "not finite",
        "A number overflowed.",
        "Check the units of modulus, pressure and profile.";
    Fold = "fold in the load path",
        "The pressure cannot rise further, not even by a thousandth: the steady solution ends at this pressure, or jumps to another solution.",
        "Leave out shorter waves, shorten the load time, or use the half-plane model.";
    MeanShear = "mean shear too large",
        "The pressure cannot rise further because friction shears the bonded block by more than 2. This mean shear is friction times pressure over the relaxation modulus after the load time.",
        "Take a shorter load time, or a rubber that is still solid after the load time.";
    TimeLimit = "time limit",
        "The solve reached the time limit. Its numbers belong to the finest mesh that was solved, or to the pressure that was reached.",
        "Raise time_limit, or take fewer columns.";
    ToleranceNotMet = "tolerance not met",
        "The solve converged, but its estimated error on the finest mesh is above the tolerance.",
        "Accept the estimated error, or raise the tolerance.";
    FrictionsDisagree = "frictions disagree",
        "The wave has a solution, but on the finest mesh friction from traction and friction from dissipation differ by more than friction_bound.",
        "Take more columns.";
    ContactTooNarrow = "contact too narrow",
        "The contact is too narrow for the finest allowed mesh: contacts of fewer than 4 nodes carry half of the load. Nothing is solved if Hertz's contact on the crest is narrower than half a node spacing.",
        "Take more columns or a higher pressure, or use the half-plane model.";
    ProfileTooRough = "profile too rough",
        "The long waves of the profile have a solution, but all waves together have none. The nodes of the mesh are too far apart for the sharpest crests.",
        "Leave out shorter waves, or take more columns.";
}

impl Status {
    /// Whether the work was ended from outside, by the caller or by the time limit.
    pub(crate) fn interrupts(self) -> bool {
        matches!(self, Self::Stopped | Self::TimeLimit)
    }
}
