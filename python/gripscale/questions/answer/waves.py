"""The answer of sine waves stated by hand: their chain, which no measured surface judges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.model import Load
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.estimate import ESTIMATED, with_interface, with_interval
from gripscale.questions.answer.intervals import LogError
from gripscale.questions.answer.variables import BASIS_SHARES, described


def estimate_of_waves(
    numbers: xr.Dataset, errors: Mapping[str, LogError] = MappingProxyType({})
) -> xr.Dataset:
    """Return friction and contact fraction of a chain as `answer_of_samples` does, with no factors.

    `numbers` are its `sample_numbers` under one load or several. Without `errors` of what they
    depend on there is no interval.
    """
    unknown = xr.full_like(numbers["friction"], math.nan)
    errors = dict.fromkeys(ESTIMATED, LogError(unknown, unknown)) | dict(errors)
    best = xr.Dataset({"factor_label": ("factor", np.empty(0, dtype=object))})
    for name in ESTIMATED:
        best = best.assign(with_interval(name, numbers[name], errors[name]))
        best[f"answer_{name}_sampling_error"] = best[f"answer_{name}_grid_error"] = unknown
        for part in ("factor", "factor_uncertainty"):
            best[f"answer_{name}_{part}"] = unknown.expand_dims(factor=0)
    best = with_interface(best, numbers["adhesive_friction"], errors)
    return described(best.assign({f"answer_{share}": unknown for share in BASIS_SHARES}))


def answer_of_waves(
    numbers: xr.Dataset,
    case: Case,
    load: Load,
    errors: Mapping[str, LogError] = MappingProxyType({}),
) -> xr.Dataset:
    """Return the numbers of a chain under a load as an answer; see `estimate_of_waves`."""
    best = estimate_of_waves(numbers, errors)
    best["cutoff_wavelength"] = case.surface.cutoff_wavelength
    totals = {name: float(numbers[name.removeprefix("total_")]) for name in model.TOTALS}
    answered = model.predicted_answer(
        best,
        totals,
        str(numbers[model.STATUS].item()),
        Chain.name,
        load,
        model.extrapolation_of(numbers),
        model.cut_off_exponents_of(numbers),
        status_word=str(numbers[model.STATUS_WORD].item()),
    )
    inputs: list[model.Doubtful] = [case.surface, case.measured_rubber]
    doubts = model.input_doubts(inputs, [load], case.units, case.softening_doubts)
    return answered.assign_attrs(case.attributes | doubts)


def waves_answer(case: Case, predicted: xr.Dataset) -> xr.Dataset:
    """Return the answer of a case of waves from the prediction of its chain."""
    return answer_of_waves(reduce.sample_numbers(predicted, case.task()), case, case.load)
