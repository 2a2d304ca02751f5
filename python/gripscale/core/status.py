"""How a solution ended: a word with its sentence, advice and chapter of the documentation."""

from __future__ import annotations

from enum import StrEnum

import gripscale._kernel as _kernel


class Status(StrEnum):
    """How a solution ended: `converged`, or why not to use its numbers; equal to its word."""

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

    @property
    def sentence(self) -> str:
        """What happened."""
        return _TEXTS[self][0]

    @property
    def advice(self) -> str:
        """What to do about it; empty for `converged`."""
        return _TEXTS[self][1]

    @property
    def chapter(self) -> str:
        """Page and heading of the documentation that say more."""
        return _CHAPTERS.get(self, "reading-results.md#statuses-and-what-to-do-about-them")


# Sentence and advice by the word of a status, of the kernel and of the solvers in Python.
_TEXTS = {word: (sentence, advice) for word, sentence, advice in _kernel.statuses()} | {
    Status.FRICTIONS_DISAGREE: (
        "The contact has a solution, but on the last mesh friction from traction and friction from "
        "dissipation differ too much.",
        "Take more columns. For a direct contact, set a tolerance: it refines the grid.",
    ),
    Status.ACTIVE_SET_NOT_SETTLED: (
        "The half-plane model did not converge to a set of points in contact.",
        "Take another number of points.",
    ),
    Status.CONDITIONS_NOT_SETTLED: (
        "Contact, strains and temperatures did not agree after the allowed passes.",
        "Leave out an effect, or take a lower speed or pressure.",
    ),
}

_WAVES, _MESHES = "limits.md#where-waves-converge", "limits.md#discretisation"
# Chapters of statuses that have one of their own.
_CHAPTERS = {
    Status.CONVERGED: "reading-results.md#how-far-to-trust-a-number",
    Status.FOLD: _WAVES,
    Status.MEAN_SHEAR: _WAVES,
    Status.TOLERANCE_NOT_MET: _MESHES,
    Status.FRICTIONS_DISAGREE: _WAVES,
    Status.CONTACT_TOO_NARROW: _WAVES,
    Status.PROFILE_TOO_ROUGH: _MESHES,
    Status.CONDITIONS_NOT_SETTLED: "conditions.md#the-fixed-point",
}
