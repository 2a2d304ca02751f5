"""How a solution ended: `converged`, or why its numbers are not to be trusted."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """Every member is, and compares equal to, its word."""

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration limit"
    ELEMENT_INVERTED = "element inverted"
    NO_ACTIVE_SET = "no active set"
    NOT_FINITE = "not finite"
    FOLD = "fold in the load path"
    MEAN_SHEAR = "mean shear too large"
    TIME_LIMIT = "time limit"
    TOLERANCE_NOT_MET = "tolerance not met"
    FRICTIONS_DISAGREE = "frictions disagree"
    ACTIVE_SET_NOT_SETTLED = "active set not settled"
    CONTACT_TOO_NARROW = "contact too narrow"
    PROFILE_TOO_ROUGH = "profile too rough"
    CONDITIONS_NOT_SETTLED = "conditions not settled"
