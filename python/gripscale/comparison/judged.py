"""What a run can afford to know of its chain: the direct contact of the measured profiles."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale import netcdf
from gripscale.case.results import CaseResults
from gripscale.comparison.ladder import DIRECT, LADDER, each_measured
from gripscale.comparison.sample import Sample, sample_of
from gripscale.comparison.solved import SolvedRung
from gripscale.model import TOTALS, answer, with_area_term
from gripscale.rough.model import DirectContact

if TYPE_CHECKING:
    import xarray as xr

JUDGED_TO = 0.1
"""Estimated relative error of the contact that every run judges its chain by."""
FILE = "direct.nc"
"""What it is kept in, beside the result."""


def judged(results: CaseResults) -> SolvedRung | None:
    """Return the direct contact of the measured profiles, at the speed of the case.

    Parameters
    ----------
    results : CaseResults
        The prepared case; its conditions change the rubber of the direct contact, too.

    Returns
    -------
    SolvedRung or None
        A sample for each profile, solved to an estimated relative error of `JUDGED_TO`, 10 %; None
        if no profile was measured.

    Raises
    ------
    InputError
        If the direct contact cannot use the rubber or a profile.
    """
    rung = next(one for one in LADDER if one.name == DIRECT)
    model = DirectContact(tolerance=JUDGED_TO, conditions=results.conditions)
    rubber, load = results.rubber.rubber, results.load
    samples: list[Sample] = []
    for name, surface in each_measured(results.surface):
        clock = time.perf_counter()
        answer = model.predict(rubber, surface, load)
        answer.attrs["seconds"] = time.perf_counter() - clock
        samples.append(sample_of(answer, name))
    return SolvedRung(rung, samples) if samples else None


def judge_run(results: CaseResults, folder: str | Path) -> xr.Dataset | None:
    """Return what `judged` finds as totals of a model; keep it in `results` and in `folder`.

    Raises `FileError` if it cannot be written.
    """
    direct = judged(results)
    if direct is None:
        return None
    data = judged_totals(direct, results)
    netcdf.save(data, Path(folder) / FILE)
    results.direct = data
    return data


def judged_totals(direct: SolvedRung, results: CaseResults) -> xr.Dataset:
    """Return the means of `direct` over the profiles as a model answers with its totals."""
    import xarray as xr

    totals = {name: direct.mean(name.removeprefix("total_")) for name in TOTALS}
    found = answer(
        xr.Dataset(), totals, direct.status, direct.name, results.load, direct.extrapolation,
        direct.cut_off_exponents,
    )  # fmt: skip
    named = found.assign_attrs(case=results.file.text, tolerance=JUDGED_TO)
    return with_area_term(named, direct.mean("adhesive_friction"))
