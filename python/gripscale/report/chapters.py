"""Which chapter of the documentation says more about a failure: the one table of it."""

from __future__ import annotations

from gripscale.wave.status import Status

_STATUSES = "reading-results.md#statuses-and-what-to-do-about-them"
_WAVES = "limits.md#where-waves-converge"
_MESHES = "limits.md#discretisation"

STATUS_CHAPTERS = {
    Status.CONVERGED: "reading-results.md#how-far-to-trust-a-number",
    Status.ITERATION_LIMIT: _STATUSES,
    Status.ELEMENT_INVERTED: _STATUSES,
    Status.NO_ACTIVE_SET: _STATUSES,
    Status.NOT_FINITE: _STATUSES,
    Status.FOLD: _WAVES,
    Status.MEAN_SHEAR: _WAVES,
    Status.TIME_LIMIT: _STATUSES,
    Status.TOLERANCE_NOT_MET: _MESHES,
    Status.FRICTIONS_DISAGREE: _WAVES,
    Status.ACTIVE_SET_NOT_SETTLED: _STATUSES,
    Status.CONTACT_TOO_NARROW: _WAVES,
    Status.PROFILE_TOO_ROUGH: _MESHES,
    Status.CONDITIONS_NOT_SETTLED: "conditions.md#how-they-settle",
}
"""Chapters in `docs` by status."""


def pointer(failure: object) -> str:
    """Return "; see ..." of an error that something explains, or of a text that names a status."""
    text = str(failure)
    see = " See" if text.endswith("?") else "; see"
    named = [one for one in Status if one is not Status.CONVERGED and one in text]
    places = [getattr(failure, "see", ""), *(f"docs/{STATUS_CHAPTERS[one]}" for one in named)]
    return next((f"{see} {place}" for place in places if place), "")
