//! How a solution ended: converged, or why its numbers are not to be trusted.

macro_rules! statuses {
    ($($(#[$doc:meta])* $name:ident = $word:literal,)+) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Status {
            $($(#[$doc])* $name,)+
        }

        impl Status {
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$name => $word,)+
                }
            }
        }
    };
}

statuses! {
    Converged = "converged",
    IterationLimit = "iteration limit",
    ElementInverted = "element inverted",
    NoActiveSet = "no active set",
    NotFinite = "not finite",
    /// The load can be raised no further, in however small steps.
    Fold = "fold in the load path",
    /// Friction shears the bonded block, as soft as it is after the load time, beyond sense.
    MeanShear = "mean shear too large",
    /// Ended early: what was solved by then.
    TimeLimit = "time limit",
    /// Solved, but the finest mesh allowed does not meet the accuracy asked for.
    ToleranceNotMet = "tolerance not met",
    /// Solved, but friction from traction and from dissipation differ on the finest mesh allowed.
    FrictionsDisagree = "frictions disagree",
    /// Too few nodes carry the load on the finest mesh allowed, or would: then nothing is solved.
    ContactTooNarrow = "contact too narrow",
    /// The longer waves of the profile carry the load, all of them find no solution on this mesh.
    ProfileTooRough = "profile too rough",
}
