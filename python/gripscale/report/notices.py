"""What the reader must see first: waves that failed, doubts about inputs and numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.figures.view import CONVERGED, PredictionView
from gripscale.model import with_adhesive
from gripscale.report.chapters import pointer
from gripscale.report.conditions_notes import conditions_sentences
from gripscale.report.elements import Card, Notice
from gripscale.report.numbers import NONE, number, percent
from gripscale.report.outside_band import prediction_sentence
from gripscale.report.source import Run
from gripscale.rubber.compressibility import LEAST_POISSON_RATIO
from gripscale.versions import versions
from gripscale.wave.result import LARGE_MISMATCH


def notices(run: Run) -> list[Notice]:
    """Return errors first, then warnings."""
    errors = [Notice("error", text) for one in run.predictions for text in _failures(one)]
    return errors + [Notice("warning", text) for text in _doubts(run)]


def _failures(one: PredictionView) -> Iterator[str]:
    for i in np.flatnonzero(~one.converged):
        yield (
            f"{one.title}: wave {i + 1} did NOT converge ({one.why(int(i))}). Its numbers are not "
            "to be used, the waves after it were not solved, and there are no totals"
            f"{pointer(one.why(int(i)))}."
        )
    if one.complete or not one.converged.all():
        return
    if one.status != CONVERGED:
        yield f"{one.title}: {one.status}. There are no totals{pointer(one.status)}."
    else:
        yield (
            f"{one.title}: the run ended after wave {one.waves} of {one.planned}. The totals "
            "would lack the smaller waves and are not shown; run the case again."
        )


def _doubts(run: Run) -> Iterator[str]:
    inputs = run.inputs
    for one in run.predictions:
        beyond = prediction_sentence(one)
        if beyond:
            yield f"{one.title}: {beyond} There the Prony series is an extrapolation."
    for one in run.by_wave:
        if one.moving:
            yield from _mismatch(one)
        yield from (f"{one.title}: {text}" for text in conditions_sentences(one))
        yield from _compressible(one, float(inputs.attrs.get("bulk_modulus_Pa", np.nan)))
    yield from str(inputs.attrs.get("conditions_notes", "")).splitlines()
    for finding in str(inputs.attrs.get("prony_findings", "")).splitlines():
        yield f"Rubber: {finding}."
    for note in str(inputs.attrs.get("surface_notes", "")).splitlines():
        yield f"Surface: {note.removesuffix('.')}."
    if "no_self_affine" in inputs.attrs:
        yield f"The surface was not described as self-affine: {inputs.attrs['no_self_affine']}"
    if not inputs.data_vars:
        yield (
            "The result holds no record of its inputs (it was not written by `gripscale run`, or "
            "by an older version): profiles, fits and master curve are missing here."
        )
    if len({str(one.data.attrs.get("case", "")) for one in run.predictions}) > 1:
        yield "The dynamic and the static result come from different case files."
    solved, here = run.attrs.get("version_gripscale"), versions()["gripscale"]
    if solved is not None and solved != here:
        yield f"Solved with gripscale {solved}, reported with {here}."


def _compressible(one: PredictionView, bulk: float) -> Iterator[str]:
    """Warn where the bulk modulus is too small for the modulus of a wave."""
    if not one.has("modulus"):
        return
    shear = one.column("modulus") / 3.0
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    low = np.flatnonzero(np.nan_to_num(ratio, nan=0.5) < LEAST_POISSON_RATIO)
    if low.size:
        waves = ", ".join(str(i + 1) for i in low)
        yield (
            f"{one.title}: Poisson's ratio of waves {waves} is down to {number(ratio[low].min())}, "
            f"less than {LEAST_POISSON_RATIO:g}: the bulk modulus is too small for their moduli."
        )


def _mismatch(one: PredictionView) -> Iterator[str]:
    mismatch = one.usable("friction_mismatch")
    large = np.flatnonzero(np.nan_to_num(mismatch) > LARGE_MISMATCH)
    if large.size:
        waves = ", ".join(str(i + 1) for i in large)
        yield (
            f"{one.title}: the two frictions of waves {waves} are up to "
            f"{percent(np.nanmax(mismatch))} apart, more than {percent(LARGE_MISMATCH)}; a finer "
            "mesh is called for."
        )


def cards(run: Run) -> list[Card]:
    """Return the totals of each prediction, and of the direct contact that judges them."""
    return [*(card for one in run.predictions for card in _cards(one)), *_judge(run.direct)]


def _judge(direct: xr.Dataset | None) -> Iterator[Card]:
    if direct is None:
        return
    one = PredictionView(direct)
    area, friction = number(one.total("contact_fraction")), number(one.total("friction"))
    if one.moving:
        yield Card("Direct contact, μ", friction, f"of the profiles; A_r/A_0 {area}")
    else:
        yield Card("Direct contact, A_r/A_0", area, "of the profiles")


def _cards(one: PredictionView) -> Iterator[Card]:
    if not one.complete:
        yield Card("No totals", "not converged", one.title, bad=True)
        return
    waves = f"; {one.waves} wave{'s' if one.waves != 1 else ''}" if one.waves else ""
    area = number(one.total("contact_fraction"))
    yield Card("Real contact area A_r/A_0", area, f"{one.title}{waves}")
    if not one.moving:
        return
    lost = number(one.total("friction_from_dissipation"))
    friction = number(one.total("friction"))
    yield Card("Friction coefficient μ", friction, f"{one.title}; {lost} from energy lost")
    both = with_adhesive(one.data)
    if both is not None:
        yield Card("With the area term, μ", number(float(both)), f"{one.title}; as stated")
    if not one.has("friction_mismatch"):
        return
    mismatch = one.usable("friction_mismatch")
    largest = percent(np.nanmax(mismatch)) if np.isfinite(mismatch).any() else NONE
    bad = bool(np.nanmax(mismatch, initial=0.0) > LARGE_MISMATCH)
    yield Card("Largest mismatch of μ", largest, "traction against energy lost", bad=bad)
