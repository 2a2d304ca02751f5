"""What the reader must see first: waves that failed, doubts about inputs and numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gripscale import dataset
from gripscale.html_report.elements import Card, Notice
from gripscale.html_report.numbers import NONE, number, percent
from gripscale.html_report.source import Chain, Run

LARGE_MISMATCH = 0.05
"""Relative difference of the two frictions of a wave above which the page warns."""


def notices(run: Run) -> list[Notice]:
    """Return errors first, then warnings."""
    errors = [Notice("error", text) for chain in run.chains for text in _failures(run, chain)]
    return errors + [Notice("warning", text) for text in _doubts(run)]


def complete(run: Run, chain: Chain) -> bool:
    """Whether every wave there should be was solved and may be used."""
    return bool(chain.converged.all()) and chain.waves >= run.planned


def _failures(run: Run, chain: Chain) -> Iterator[str]:
    for i in np.flatnonzero(~chain.converged):
        yield (
            f"{chain.title}: wave {i + 1} did NOT converge "
            f"({chain.data['status'].values[i]}). Its numbers are not to be used, the waves after "
            "it were not solved, and there are no totals."
        )
    if chain.converged.all() and chain.waves < run.planned:
        yield (
            f"{chain.title}: the run ended after wave {chain.waves} of {run.planned}. The totals "
            "would lack the smaller waves and are not shown; run the case again."
        )


def _doubts(run: Run) -> Iterator[str]:
    inputs = run.inputs
    for chain in run.chains:
        if chain.has("outside_band") and chain.column("outside_band").any():
            waves = ", ".join(str(i + 1) for i in np.flatnonzero(chain.column("outside_band")))
            yield (
                f"{chain.title}: waves {waves} excite the rubber beyond the frequencies that were "
                "measured; there the Prony series is an extrapolation."
            )
        if chain.moving:
            yield from _mismatch(chain)
    if inputs.attrs.get("prony_consistent", 1) == 0:
        yield (
            "No generalized Maxwell solid has both the measured E′ and E″: within their scatter "
            "they are not Kramers-Kronig consistent. See the residuals of the Prony series."
        )
    if "no_self_affine" in inputs.attrs:
        yield f"The surface was not described as self-affine: {inputs.attrs['no_self_affine']}"
    if not inputs.data_vars:
        yield (
            "The result holds no record of its inputs (it was not written by `gripscale run`, or "
            "by an older version): profiles, fits and master curve are missing here."
        )
    if len({str(chain.data.attrs.get("case", "")) for chain in run.chains}) > 1:
        yield "The dynamic and the static result come from different case files."
    solved, here = run.attrs.get("version_gripscale"), dataset.versions()["gripscale"]
    if solved is not None and solved != here:
        yield f"Solved with gripscale {solved}, reported with {here}."


def _mismatch(chain: Chain) -> Iterator[str]:
    mismatch = chain.usable("friction_mismatch")
    large = np.flatnonzero(np.nan_to_num(mismatch) > LARGE_MISMATCH)
    if large.size:
        waves = ", ".join(str(i + 1) for i in large)
        yield (
            f"{chain.title}: the two frictions of waves {waves} are up to "
            f"{percent(np.nanmax(mismatch))} apart, more than {percent(LARGE_MISMATCH)}; a finer "
            "mesh is called for."
        )


def cards(run: Run) -> list[Card]:
    """Return the totals of each chain."""
    return [card for chain in run.chains for card in _cards(chain, complete(run, chain))]


def _cards(chain: Chain, usable: bool) -> Iterator[Card]:
    attrs = chain.data.attrs
    if not usable:
        yield Card("No totals", "not converged", chain.title, bad=True)
        return
    waves = f"{chain.waves} wave{'s' if chain.waves != 1 else ''}"
    area = number(attrs["contact_fraction"])
    yield Card("Real contact area A_r/A_0", area, f"{chain.title}; {waves}")
    if not chain.moving:
        return
    lost = number(attrs["friction_from_dissipation"])
    yield Card(
        "Friction coefficient μ",
        number(attrs["friction"]),
        f"{chain.title}; {lost} from energy lost",
    )
    mismatch = chain.usable("friction_mismatch")
    largest = percent(np.nanmax(mismatch)) if np.isfinite(mismatch).any() else NONE
    bad = bool(np.nanmax(mismatch, initial=0.0) > LARGE_MISMATCH)
    yield Card("Largest mismatch of μ", largest, "traction against energy lost", bad=bad)
