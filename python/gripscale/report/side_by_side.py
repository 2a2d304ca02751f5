"""Predictions side by side: effects left out one by one, roads under one rubber, compounds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from gripscale.charts.style import power_of_ten
from gripscale.charts.view import CONVERGED, SYMBOLS
from gripscale.core.units import MILLI
from gripscale.experiment.axis import EFFECTS, MODELS
from gripscale.experiment.design import CHANGES, WITH_AREA_TERM
from gripscale.io.table import Column, Table, change, fixed, significant
from gripscale.model import ADHESIVE_FRICTION, STATUS, status_words
from gripscale.report.notices import Failure

QUANTITIES = {f"total_{name}": symbol for name, symbol in SYMBOLS.items()}


def effects_table(*results: xr.Dataset) -> Table:
    """Return area and friction with all effects, without each in turn, and without any.

    Beside each number stands what the effects left out change, relative to it. `results` are of
    `gripscale.analysis.effects`, one for each model.
    """

    def every(name: str) -> list[object]:
        missing = np.full(1, np.nan)
        parts = [
            result[name].values if name in result else np.repeat(missing, result.sizes["effect"])
            for result in results
        ]
        return [value for part in parts for value in part]

    models = [str(result.attrs["model"]) for result in results for _ in result.effect]
    columns = [
        Column("model", [MODELS.get(name, name) for name in models]),
        Column("effects", [EFFECTS.get(str(name), str(name)) for name in every("effect")]),
    ]
    for name, symbol in QUANTITIES.items():
        columns += [
            Column(name, every(name), symbol),
            Column(CHANGES[name], every(CHANGES[name]), "change", format=change),
        ]
    if any(WITH_AREA_TERM in result for result in results):
        columns += [
            Column("area_term", every(ADHESIVE_FRICTION), "μ", "area term"),
            Column(WITH_AREA_TERM, every(WITH_AREA_TERM), "μ", "with it"),
            Column(
                CHANGES[WITH_AREA_TERM], every(CHANGES[WITH_AREA_TERM]), "change", format=change
            ),
        ]
    status = [str(value) for value in every("prediction_status")]
    columns.append(Column("status", status))
    bad = [value != CONVERGED for value in status]
    rules = np.cumsum([result.sizes["effect"] for result in results])[:-1] - 1
    return Table("effects", columns, "What each effect is worth", keys=2, bad=bad, rules=set(rules))


def totals_table(data: xr.Dataset, dim: str, heading: str, model: str = "") -> Table:
    """Return totals along `dim` with their ranges, and the differences to the first.

    Of `model`, the name of the table, only what was asked for: nothing without a status.
    """
    status = [str(value) for value in data.prediction_status.values]
    asked = [i for i, text in enumerate(status) if text]
    data, status = data.isel({dim: asked}), [status[i] for i in asked]

    def ends(name: str) -> np.ndarray:
        missing = np.full(len(asked), np.nan)
        low, high = (
            data[f"{name}_{end}"].values if f"{name}_{end}" in data else missing
            for end in ("low", "high")
        )
        return np.stack([low, high], axis=1)

    columns = [Column(dim, [str(name) for name in data[dim].values], heading)]
    for name, symbol in QUANTITIES.items():
        columns += [
            Column(name, data[name].values, symbol),
            Column(f"{name}_range", ends(name), "range"),
        ]
    name = "total_friction_difference"
    difference, span = data[name].values.copy(), ends(name)
    if 0 in asked:  # the first differs from nothing
        difference[0], span[0] = np.nan, np.nan
    columns += [
        Column(name, difference, "μ less that of the first", format=fixed(3, "+")),
        Column(f"{name}_range", span, "range", format=fixed(3, "+")),
    ]
    bad = [text != CONVERGED for text in status]
    if any(bad):
        columns.append(Column("status", status))
    caption = f"Totals, {model}" if model else "Totals"
    return Table("-".join(filter(None, [f"{dim}s", model])), columns, caption, bad=bad)


def difference_words(data: xr.Dataset, name: str, first: str, measured: str) -> str:
    """Return by how much friction differs from the first, and whether beyond what is `measured`.

    Nothing where one of both has no friction.
    """
    difference = float(data.total_friction_difference)
    if math.isnan(difference):
        return ""
    word = "more" if difference > 0.0 else "less"
    text = f"{name} has {significant(abs(difference))} {word} friction than {first}"
    low, high = (
        float(data.get(f"total_friction_difference_{end}", math.nan)) for end in ("low", "high")
    )
    if math.isnan(low + high):
        return text
    beyond = low > 0.0 or high < 0.0
    return f"{text}, {'' if beyond else 'not '}beyond what {measured} leave open"


def roads_tables(data: xr.Dataset) -> list[Table]:
    """Return for each model the totals of the roads and the differences to the first."""
    models = data.model.values.tolist()
    tables = [totals_table(data.sel(model=name), "surface", "road", name) for name in models]
    return [table for table in tables if len(table)]


def failed_totals(data: xr.Dataset) -> list[Failure]:
    """Return what has no totals, and why."""
    status, words = data[STATUS], status_words(data)
    where = [dim for dim in ("model", "surface", "rubber") if dim in status.dims]
    stacked, words = (texts.transpose(*where) for texts in (status, words))
    return [
        Failure(
            f"{', '.join(str(data[d].values[i]) for d, i in zip(where, at, strict=True))}: {text}",
            str(words.values[at]),
        )
        for at, text in np.ndenumerate(stacked.values)
        if str(text) not in ("", CONVERGED)
    ]


def roads_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each road and model, whether it differs from the first and at which scale."""
    first, *others = data.surface.values.tolist()
    for model in data.model.values.tolist():
        for name in others:
            part = data.sel(model=model, surface=name)
            text = difference_words(part, name, first, "the stretches measured")
            if not text:
                continue
            octaves = part.friction_difference.values
            if np.isfinite(octaves).any():
                at = int(np.nanargmax(np.abs(octaves)))
                end = float(part.octave.values[at]) / MILLI
                text += (
                    f"; most, {octaves[at]:+.3f}, by waves of {significant(end)} to "
                    f"{significant(2 * end)} mm"
                )
            yield f"{model}: {text}."


def compounds_table(data: xr.Dataset) -> Table:
    """Return totals of each compound with their ranges, and differences to the first."""
    return totals_table(data, "rubber", "compound")


def compounds_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each compound, whether it differs from the first and what makes the difference."""
    first, *others = data.rubber.values.tolist()
    for i, name in enumerate(others, start=1):
        part = data.isel(rubber=i)
        text = difference_words(part, name, first, "the measured moduli")
        if text:
            reasons = " and ".join(_reasons(part)) or "the model does not tell by which waves"
            yield f"{text}; {reasons}."


def _reasons(data: xr.Dataset) -> Sequence[str]:
    """Return which wave and which decade of relaxation times differ most."""
    reasons = []
    if "friction_difference" in data and np.isfinite(data.friction_difference).any():
        parts = data.friction_difference.values
        at = int(np.nanargmax(np.abs(parts)))
        length = significant(float(data.wavelength.values[at]) / MILLI)
        reasons.append(f"most, {parts[at]:+.3f}, at the wave of {length} mm,")
    if "friction_by_decade_difference" in data:
        parts = np.nan_to_num(data.friction_by_decade_difference.values)
        at = int(np.argmax(np.abs(parts)))
        power = round(math.log10(float(data.decade.values[at])))
        reasons.append(
            f"{parts[at]:+.3f} by relaxation times of {power_of_ten(power)} to "
            f"{power_of_ten(power + 1)} s"
        )
    return reasons
