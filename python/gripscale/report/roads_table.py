"""Roads side by side as tables, and in sentences which scale makes the difference."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.figures.palette import MILLI
from gripscale.report.side_by_side_table import Row, difference_words, status, totals_table
from gripscale.report.tables import significant


def roads_rows(data: xr.Dataset, model: str) -> list[Row]:
    """Return the roads that a model was asked of."""
    return [
        Row(name, data.sel(model=model, surface=name), i == 0)
        for i, name in enumerate(data.surface.values.tolist())
        if str(data.prediction_status.sel(model=model, surface=name).item())
    ]


def roads_tables(data: xr.Dataset) -> list[Table]:
    """Return for each model totals of the roads with their ranges, and differences to the first."""
    told = {model: roads_rows(data, model) for model in data.model.values.tolist()}
    return [totals_table("road", rows, model) for model, rows in told.items() if rows]


def roads_failures(data: xr.Dataset) -> list[str]:
    """Return model, road and reason of each prediction without totals."""
    return [
        f"{model}, {row.name}: {status(row.one)}"
        for model in data.model.values.tolist()
        for row in roads_rows(data, model)
        if status(row.one) != "converged"
    ]


def roads_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each road and model, whether it differs from the first and at which scale."""
    first, *others = data.surface.values.tolist()
    for model in data.model.values.tolist():
        for name in others:
            one = data.sel(model=model, surface=name)
            text = difference_words(one, name, first, "the stretches measured")
            if text:
                yield f"{model}: {text}{_scale(one)}."


def _scale(one: xr.Dataset) -> str:
    """Return which octave of wavelength differs most."""
    parts = one.friction_difference.values
    if not np.isfinite(parts).any():
        return ""
    at = int(np.nanargmax(np.abs(parts)))
    end = float(one.octave.values[at]) / MILLI
    return f"; most, {parts[at]:+.3f}, by waves of {significant(end)} to {significant(2 * end)} mm"
