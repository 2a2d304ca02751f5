"""Compounds on one road, or roads under one rubber, ranked by the friction of the answer.

Every pair has the ratio of their frictions with its interval, and the confidence that one lies over
the other (`gripscale.questions.vary.friction_ratio`). Where a surface was not measured all answers
are those of the chain, whose errors nobody knows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core.errors import InputError
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.questions.vary.answer_model import OCTAVE
from gripscale.questions.vary.friction_ratio import FrictionRatio, compound_ratio
from gripscale.questions.vary.study import Study, study_numbers
from gripscale.questions.words import believed

FEWEST, MOST = 2, 6
NORMAL = 1.645
"""Half width of a 90 % interval over a standard error."""
RANKED = {
    "friction_ratio": "friction over that of `over`",
    "friction_ratio_low": "low end of its 90 % interval",
    "friction_ratio_high": "high end of its 90 % interval",
    "confidence": "probability that the friction is larger than that of `over`",
}
"""Names and meanings of what is said of each pair."""


def require_some(name: str, mapping: Mapping[str, Any], what: str) -> None:
    """Raise `InputError` unless there are two to six things to be compared."""
    if not FEWEST <= len(mapping) <= MOST:
        raise InputError(
            f"{name} must be {FEWEST} to {MOST} {what} to be compared; got {len(mapping)}"
        )


def ranked_answers(
    study: Study, folder: str | Path | None, workers: int | None, on_task: OnTask | None
) -> xr.Dataset:
    """Return the answers of a study over `rubber` or `surface`, with `RANKED` of each pair."""
    with bench_in(folder, workers, None, on_task) as bench:
        data = study.assemble(bench.solve(study.design.tasks, study_numbers))
    if "octave_friction" not in data and "scale" in data.dims:
        data = data.assign(_waves_by_octave(data))
    (dim,) = study.design.sizes
    names = data[dim].values
    pairs = [[_ratio(data, dim, i, j) for j in range(names.size)] for i in range(names.size)]
    numbers = [[(r.log_ratio, *r.interval, r.confidence) for r in row] for row in pairs]
    values = np.moveaxis(np.array(numbers), -1, 0)
    values[0] = np.exp(values[0])
    columns = {
        name: ((dim, "over"), part, variable_attributes(text))
        for (name, text), part in zip(RANKED.items(), values, strict=True)
    }
    data = data.assign_coords(over=("over", names)).assign(columns)
    return data.assign_attrs(case_file=study.case.origin.name)


def _ratio(data: xr.Dataset, dim: str, i: int, j: int) -> FrictionRatio:
    """Return the friction of number `i` over that of number `j`."""
    over, under = (data.isel({dim: at}) for at in (i, j))
    friction = believed(data, "friction")
    high, low = (float(each[friction]) for each in (over, under))
    if not (high > 0.0 and low > 0.0):
        return FrictionRatio(math.nan, math.nan)
    if i == j:
        return FrictionRatio(0.0, 0.0)
    if dim == "rubber" and "piece_residual" in data:
        return compound_ratio(over, under)
    widths = [float(each.get(f"{friction}_half_width", math.nan)) for each in (over, under)]
    sigma = math.hypot(*(math.asinh(width) / NORMAL for width in widths))
    return FrictionRatio(math.log(high / low), sigma)


def _waves_by_octave(data: xr.Dataset) -> dict[str, Any]:
    """Return the friction of the waves of a chain by octave of wavelength."""
    friction = data["friction"].transpose(..., "scale").values
    number = np.log2(np.broadcast_to(data["wavelength"].values, friction.shape) / OCTAVE)
    octave = np.floor(number + 1e-9)
    every = np.unique(octave[np.isfinite(octave)])
    parts = [np.where(octave == n, friction, 0.0).sum(axis=-1) for n in every]
    dims = tuple(dim for dim in data["friction"].dims if dim != "scale")
    text = "friction coefficient of the octave"
    return {
        "octave": ("octave", OCTAVE * 2.0**every, variable_attributes("shortest wavelength", "m")),
        "octave_friction": ((*dims, "octave"), np.stack(parts, -1), variable_attributes(text)),
    }


def ranked_order(data: xr.Dataset, dim: str) -> list[int]:
    """Return the numbers of what has friction along `dim`, the largest first."""
    friction = data[believed(data, "friction")].transpose(dim).values
    return [int(i) for i in np.argsort(-friction, kind="stable") if friction[i] > 0.0]
