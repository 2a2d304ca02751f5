"""Samples of a model: what is kept of each answer, their means, scatter and errors.

Samples (profiles, seeds of random phases, windows, maps) are the dimension `sample` of a Dataset;
only those whose `prediction_status` is "converged" count. Relative uncertainties are standard
deviations of logarithms, which add in squares in products of independent log-normal numbers (J.
Aitchison & J. A. C. Brown, The Lognormal Distribution (1957), sec. 2.3).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.conditions.conditions import Conditions
from gripscale.core.arrays import Array, Mask
from gripscale.cut_off_exponents import NOT_TOLD
from gripscale.experiment.design import CONVERGED, error_of_total
from gripscale.experiment.task import Task
from gripscale.half_space.model import CONDITION_ERRORS, OTHER_CHANGES, WARMING
from gripscale.half_space.result import SHARES_BY_SLOPE, TRAPPED_WATER
from gripscale.questions.answer.intervals import LogError

# Totals every sample has, as `gripscale.model.TOTALS` without `total_`.
SAMPLED_QUANTITIES = ("contact_fraction", "friction", "friction_from_dissipation")
_ROUNDING = 1e-6  # relative difference below which two wavelengths are the same
# Contact fraction and friction of a smooth surface.
SMOOTH = {"contact_fraction": 1.0, "friction": 0.0}


def sample_numbers(
    answer: xr.Dataset, task: Task, conditions: Conditions | None = None
) -> xr.Dataset:
    """Return totals, named without `total_`, their estimated errors, and curves by wavelength.

    The curves count all waves not shorter than `curve_wavelength`. An area term of `conditions`
    that the model does not know is that of its contact area at the temperature before the contact.
    """
    numbers: dict[str, Any] = {name: float(answer[f"total_{name}"]) for name in SAMPLED_QUANTITIES}
    numbers |= {f"{name}_error": error_of_total(answer, name) for name in SMOOTH}
    for name in model.BASIS:
        numbers[name.removeprefix("total_")] = float(answer.get(name, math.nan))
    numbers |= {name: float(answer[name].item()) for name in TRAPPED_WATER if name in answer}
    names = (*CONDITION_ERRORS, *OTHER_CHANGES, WARMING)
    numbers |= {name: answer[name] for name in names if name in answer}
    numbers |= {s: answer[f"total_{s}"] for s in SHARES_BY_SLOPE if f"total_{s}" in answer}
    lines = () if task.surface.measured is None else task.surface.measured.cleaned
    numbers["length"] = sum(line.length for line in lines) or math.nan
    if float(answer["nominal_speed"]) == 0.0:
        numbers["friction_error"] = math.nan
    area_term = float(answer.get(model.ADHESIVE_FRICTION, math.nan))
    if conditions is not None and model.ADHESIVE_FRICTION not in answer:
        load, kelvin = task.load, task.rubber.reference_temperature
        state = numbers["contact_fraction"], load.pressure, load.speed, kelvin
        area_term = conditions.adhesive_friction(*state)
    numbers["adhesive_friction"] = area_term
    beyond, exponents = model.extrapolation_of(answer), model.cut_off_exponents_of(answer)
    for whole, parts in ((beyond, model.OUTSIDE_BAND), (exponents, model.CUT_OFF_EXPONENTS)):
        numbers |= {name: getattr(whole, part) for name, (part, _) in parts.items()}
    numbers[model.WHY_NO_EXPONENT] = exponents.why_not
    numbers[model.STATUS] = str(answer[model.STATUS].item())
    numbers[model.STATUS_WORD] = str(model.status_words(answer).item())
    return xr.Dataset(numbers | _curve(answer))


def _curve(answer: xr.Dataset) -> dict[str, Any]:
    """Return area and friction down to each wavelength; nothing where the model has none.

    The chain adds waves in steps; the direct contact, by octave, and the theories are interpolated
    in the logarithm of the wavelength.
    """
    by_octave = "octave_running_friction" in answer
    if by_octave:
        names = ("contact_fraction_without_shorter", "octave_running_friction")
        weight = answer["weight"].values
        area, friction = (weight @ answer[n].transpose("profile", ...).values for n in names)
    elif "running_friction" in answer:
        friction = answer["running_friction"].values
        area = answer.get("running_contact_fraction", friction * math.nan)
    else:
        return {}
    return {
        "curve_wavelength": ("curve", answer["wavelength"].values),
        "curve_contact_fraction": ("curve", np.asarray(area)),
        "curve_friction": ("curve", friction),
        "curve_stepped": float("amplitude" in answer and not by_octave),
    }


def curve_at(
    name: str, at: Array, wavelength: Array, values: Array, *, stepped: bool = False
) -> Array:
    """Return `contact_fraction` or `friction` of all waves not shorter than `at` [m].

    The curve has falling `wavelength` [m], NaN beyond its end, and `values` [-], NaN where unknown;
    if `stepped`, nothing lies between its waves.
    """
    finite = np.isfinite(values) & np.isfinite(wavelength)
    if not finite.any():
        return np.full(at.size, np.nan)
    first = wavelength[0] * (1.0 + _ROUNDING)
    waves, values = wavelength[finite], values[finite]
    if stepped:
        count = (waves[None, :] >= at[:, None] * (1.0 - _ROUNDING)).sum(axis=1)
        return np.asarray(np.append(SMOOTH[name], values)[count])
    between = np.interp(-np.log(at), -np.log(waves), values)
    between = np.where(at > waves[0] * (1.0 + _ROUNDING), np.nan, between)
    return np.where(at > first, SMOOTH[name], between)


def octaves(longest: float, shortest: float, end: float) -> Array:
    """Return the lower ends of octaves [m], falling, that hold both waves; empty for NaN."""
    if math.isnan(longest):
        return np.empty(0)
    first, last = np.floor(np.log2(np.array([longest, shortest]) / end) + _ROUNDING)
    return np.asarray(end * 2.0 ** np.arange(first, last - 1.0, -1.0))


def running(samples: xr.Dataset, name: str, wavelength: Array) -> xr.DataArray:
    """Return the mean down to each wavelength [m]; NaN where a sample's curve is not known."""
    dims = samples["prediction_status"].dims
    values = np.full((*samples["prediction_status"].shape, wavelength.size), np.nan)
    there = converged(samples)
    if "curve_wavelength" in samples:
        there = there & samples["curve_wavelength"].notnull().any("curve")
        parts = samples[["curve_wavelength", f"curve_{name}"]].transpose(*dims, "curve")
        for at in zip(*np.nonzero(there.values), strict=True):
            curve = (parts[part].values[at] for part in ("curve_wavelength", f"curve_{name}"))
            stepped = bool(samples["curve_stepped"].values[at])
            values[at] = curve_at(name, wavelength, *curve, stepped=stepped)
    curves = xr.DataArray(values, dims=(*dims, "wavelength"))
    unknown = (curves.isnull() & there).any("sample")
    return curves.where(there).mean("sample").where(~unknown)


def converged(samples: xr.Dataset) -> xr.DataArray:
    """Return which samples may be used."""
    return samples["prediction_status"] == CONVERGED


def usable(samples: xr.Dataset, name: str) -> xr.DataArray:
    """Return a number of the samples, NaN where they may not be used."""
    return samples[name].where(converged(samples))


def mean(samples: xr.Dataset, name: str) -> xr.DataArray:
    """Return the mean of a number over the samples that may be used, by their length."""
    values = usable(samples, name)
    if "length" not in samples:
        return values.mean("sample")

    def weighted(x: Array, length: Array) -> Array:  # a third of the time of `xr.weighted`
        total = np.einsum("...i,...i", ~np.isnan(x), length)
        weighed = np.einsum("...i,...i", np.where(np.isnan(x), 0.0, x), length)
        return np.asarray(weighed / np.where(total != 0.0, total, math.nan))

    lengths, dims = samples["length"].fillna(1.0), [["sample"], ["sample"]]
    return cast(xr.DataArray, xr.apply_ufunc(weighted, values, lengths, input_core_dims=dims))


def spread(values: xr.DataArray) -> xr.DataArray:
    """Return the standard deviation over the samples; NaN for fewer than two."""
    count = values.count("sample")
    squares = ((values - values.mean("sample")) ** 2).sum("sample")
    return (squares / (count - 1).where(count > 1)) ** 0.5


def log_error_of_mean(values: xr.DataArray) -> xr.DataArray:
    """Return the standard error of the log of the mean; NaN for one value or values <= 0."""
    positive = ((values > 0.0) | values.isnull()).all("sample")
    error = spread(values) / values.count("sample") ** 0.5 / values.mean("sample")
    return error.where(positive)


def in_quadrature(*parts: xr.DataArray) -> xr.DataArray:
    """Return the root of the sum of squares of what is not NaN; NaN if everything is."""
    squares = xr.concat([part**2 for part in parts], "part")
    return squares.sum("part", min_count=1) ** 0.5


def estimated_error(samples: xr.Dataset, name: str) -> xr.DataArray:
    """Return the mean error of the samples as their models estimate it, relative."""
    error = mean(samples, f"{name.removesuffix('_from_dissipation')}_error")
    value = mean(samples, name)
    return error / abs(value).where(value != 0.0)


def road_error(samples: xr.Dataset, name: str) -> LogError:
    """Return how well the mean of a number over the samples of one model stands for its road.

    From pieces of each surface, where the model knows them (`gripscale.half_space.sampling_error`);
    else from the scatter of the samples, or of the means of several subjects (profiles), because
    samples of one subject say nothing of the others. NaN where neither is known.
    """
    values, there = usable(samples, name), converged(samples)
    of_piece = f"{name.removesuffix('_from_dissipation')}_sampling_error"
    if of_piece in samples and bool((samples[of_piece].notnull() | ~there).all() and there.any()):
        values = values * samples.get("length", 1.0)
        total = values.sum("sample")
        error = ((values * usable(samples, of_piece)) ** 2).sum("sample") ** 0.5
        return LogError(error / total.where(total > 0.0), usable(samples, "freedom").sum("sample"))
    means = [
        values.isel(sample=(samples["subject"] == subject).values).mean("sample")
        for subject in np.unique(samples["subject"].values[_present(samples)])
    ]
    error, count = log_error_of_mean(values), values.count("sample")
    if len(means) > 1:
        by_subject = xr.concat(means, "sample")
        several = by_subject.count("sample") > 1
        error = log_error_of_mean(by_subject).where(several, error)
        count = by_subject.count("sample").where(several, count)
    return LogError(error, count - 1.0)


def relative_uncertainty(samples: xr.Dataset, name: str) -> xr.DataArray:
    """Return the relative standard uncertainty of a mean: `road_error` and estimated errors."""
    return in_quadrature(road_error(samples, name).sigma, estimated_error(samples, name))


def ratio(over: xr.Dataset, under: xr.Dataset, name: str) -> tuple[xr.DataArray, LogError]:
    """Return the ratio of the means of two models, and its relative standard error.

    The error is from the scatter of the ratios of subjects that both have, or else from the scatter
    of both; the truth lies evenly within the errors that the models estimate.
    """
    pair = over, under
    if not paired(over, under):
        upper, lower = (usable(samples, name).mean("sample") for samples in pair)
        sigma = in_quadrature(*(relative_uncertainty(samples, name) for samples in pair))
        first, second = (road_error(samples, name).freedom for samples in pair)
        freedom = first.where(first < second, second)
    else:
        both = converged(over) & converged(under)
        upper, lower = (samples[name].where(both).mean("sample") for samples in pair)
        scatter, freedom = pair_scatter(over, under, name)
        errors = (estimated_error(samples, name).where(both.any("sample")) for samples in pair)
        sigma = in_quadrature(scatter, *(error / math.sqrt(3.0) for error in errors))
    return upper / lower.where(lower != 0.0), LogError(sigma, freedom)


def pair_scatter(over: xr.Dataset, under: xr.Dataset, name: str) -> LogError:
    """Return the error of a ratio of means by the scatter of the ratios of the same subjects."""
    both = converged(over) & converged(under)
    upper, lower = over[name].where(both), under[name].where(both)
    scatter = log_error_of_mean(upper / lower).where(((lower > 0.0) | ~both).all("sample"))
    return LogError(scatter, both.sum("sample") - 1.0)


def paired(first: xr.Dataset, second: xr.Dataset) -> bool:
    """Return whether two models have one sample each of the same two subjects or more."""
    subjects, others = (s["subject"].values[_present(s)].tolist() for s in (first, second))
    return len(subjects) > 1 and subjects == others and len(set(subjects)) == len(subjects)


def _present(samples: xr.Dataset) -> Mask:
    """Return which places along `sample` hold one, at whatever load."""
    there = samples["prediction_status"] != ""
    return np.asarray(there.any([dim for dim in there.dims if dim != "sample"]).values)


def outside_band(samples: xr.Dataset) -> xr.Dataset:
    """Return what of the mean friction rests on the rubber beyond its measured frequencies."""
    share, below, above = (usable(samples, name) for name in model.OUTSIDE_BAND)
    weight, there = abs(usable(samples, "friction")), converged(samples)
    total = _sum(weight, there)
    # a sample without friction has no share, and adds none
    mean = _sum(weight * share.where(weight > 0.0, 0.0), there) / total.where(total > 0.0)
    mean = mean.where(((share != 0.0) & there).any("sample"), 0.0)
    parts = (mean, below.max("sample"), above.max("sample"))
    return xr.Dataset(dict(zip(model.OUTSIDE_BAND, parts, strict=True))).where(there.any("sample"))


def _sum(values: xr.DataArray, there: xr.DataArray) -> xr.DataArray:
    """Return the sum over the samples that may be used, NaN if one of them is."""
    return values.where(there, 0.0).sum("sample", skipna=False)


def cut_off_exponents(samples: xr.Dataset) -> xr.Dataset:
    """Return how the means change with the cut-off: d ln(sum x_i) = sum x_i d ln x_i / sum x_i."""
    there = converged(samples)
    data: dict[str, Any] = {}
    for name, (quantity, _) in model.CUT_OFF_EXPONENTS.items():
        weight = usable(samples, quantity)
        total = _sum(weight, there)
        mean = _sum(weight * samples[name], there) / total.where(total != 0.0)
        data[name] = mean.where(there.any("sample"))
    texts = samples[model.WHY_NO_EXPONENT].where(there, "")
    why_not = _over_samples(lambda texts: next(filter(None, texts), ""), texts)
    data[model.WHY_NO_EXPONENT] = why_not.where(there.any("sample"), NOT_TOLD.why_not)
    return xr.Dataset(data)


def status(samples: xr.Dataset) -> xr.DataArray:
    """Return "converged", or how many samples did not and what the first of them says."""

    def in_words(texts: Sequence[str]) -> str:
        present = [text for text in texts if text]
        bad = [text for text in present if text != CONVERGED]
        if bad and len(present) > 1:
            return f"{len(bad)} of {len(present)} samples failed: {bad[0]}"
        return next(iter(bad), CONVERGED)

    return _over_samples(in_words, samples[model.STATUS])


def status_word(samples: xr.Dataset) -> xr.DataArray:
    """Return the word of the status of the first sample that did not converge, or "converged"."""

    def first(texts: Sequence[str], words: Sequence[str]) -> str:
        pairs = zip(texts, words, strict=True)
        return next((str(word) for text, word in pairs if text not in ("", CONVERGED)), CONVERGED)

    return _over_samples(first, samples[model.STATUS], model.status_words(samples))


def _over_samples(text: Callable[..., str], *values: xr.DataArray) -> xr.DataArray:
    """Return one text of the values of all samples, for each load."""
    core: dict[str, Any] = {"input_core_dims": [["sample"]] * len(values)}
    words = xr.apply_ufunc(text, *values, vectorize=True, output_dtypes=[object], **core)
    return cast(xr.DataArray, words)
