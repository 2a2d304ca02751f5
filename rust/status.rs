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
        "Residual and contact conditions are met at the full pressure.",
        "";
    IterationLimit = "iteration limit",
        "The Newton iterations allowed were used up before the full pressure.",
        "Raise max_iterations, or start from the solution at a smaller pressure or a slower speed.";
    ElementInverted = "element inverted",
        "A Newton step turned an element inside out, at the smallest step of the pressure, too.",
        "Try another mesh: element_order = 2 at large strain, more rows where the mean shear is strong.";
    NoActiveSet = "no active set",
        "No set of touching nodes satisfies the contact conditions.",
        "Try more columns, or start from the solution at a smaller pressure.";
    NotFinite = "not finite",
        "A number overflowed.",
        "Check the units of modulus, pressure and profile.";
    Fold = "fold in the load path",
        "The pressure can be raised no further, not even by a thousandth: the steady solution ends there, or snaps to another.",
        "Leave out shorter waves, shorten the load time, or use the half-plane model.";
    MeanShear = "mean shear too large",
        "The pressure cannot be raised because friction shears the bonded block by more than 2: friction times pressure over the relaxation modulus after the load time.",
        "Take a shorter load time, or a rubber that is still solid then.";
    TimeLimit = "time limit",
        "The time limit ran out: the numbers are those of the finest mesh solved by then, or at the pressure reached.",
        "Raise time_limit, or take fewer columns.";
    ToleranceNotMet = "tolerance not met",
        "Converged, but the estimated error is above the tolerance on the finest mesh.",
        "Accept the estimated error, or raise the tolerance.";
    FrictionsDisagree = "frictions disagree",
        "Solved, but friction from traction and from dissipation are further apart than friction_bound on the finest mesh.",
        "Take more columns.";
    ContactTooNarrow = "contact too narrow",
        "Contacts of fewer than 4 nodes carry half of the load on the finest mesh allowed, or Hertz's contact on the crest is narrower than half a node spacing of that mesh: then nothing is solved.",
        "Take more columns or a higher pressure, or use the half-plane model.";
    ProfileTooRough = "profile too rough",
        "The long waves of the profile carry the load, but all waves together have no solution on this mesh: its nodes are too far apart for the sharpest crests.",
        "Leave out shorter waves, or take more columns.";
}

impl Status {
    /// Whether the work was ended from outside, by the caller or by the time limit.
    pub(crate) fn interrupts(self) -> bool {
        matches!(self, Self::Stopped | Self::TimeLimit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_a_word_a_sentence_and_advice() {
        for (i, status) in Status::ALL.iter().enumerate() {
            let word = status.word();
            assert!(Status::ALL[..i].iter().all(|other| other.word() != word));
            assert!(status.sentence().ends_with('.'), "{word}");
            let expects_advice = *status != Status::Converged;
            assert_eq!(status.advice().ends_with('.'), expects_advice, "{word}");
        }
        assert!(!Status::ALL.contains(&Status::Stopped));
    }
}
