"""Quantiles of the uncertainty of a case, for the summaries of its other reports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr

from gripscale.report.elements import Card
from gripscale.report.uncertainty_table import HEADS, axis_of
from gripscale.uncertainty.stored import of_same_inputs

OF_ANOTHER = (
    "The uncertainty in this folder is of another case and is left out; run `gripscale "
    "uncertainty` again."
)
TOLD = (0.05, 0.5, 0.95)
"""Quantiles in a summary."""


def uncertainty_lines(
    data: xr.Dataset | None, text: str, digests: Iterable[str] | None = None
) -> list[str]:
    """Return the quantiles of friction and area by model, or that they are of another case.

    `text` and `digests` are of the case of the report, see `gripscale.uncertainty.of_same_inputs`.
    """
    if data is None:
        return []
    if not of_same_inputs(data, text, digests):
        return [OF_ANOTHER]
    axis = axis_of(data)
    if axis:
        return [f"The uncertainty of this case was sampled over {axis}: see uncertainty.txt."]
    return [
        f"Uncertainty, {one.model.item()}, 5, 50 and 95 % of {_samples(one)}: "
        + "; ".join(f"{head} = {', '.join(numbers)}" for head, numbers in _quantiles(one))
        for one in (data.sel(model=name) for name in data.model.values)
    ]


def uncertainty_cards(data: xr.Dataset | None) -> list[Card]:
    """Return a card with 5 and 95 % of each quantity and model, the median below."""
    if data is None or axis_of(data):
        return []
    return [
        Card(f"{head}, 5 to 95 %", f"{low} to {high}", f"{name}: median {median}; {_samples(one)}")
        for name in data.model.values.tolist()
        for one in [data.sel(model=name)]
        for head, (low, median, high) in _quantiles(one)
    ]


def _quantiles(one: xr.Dataset) -> Iterator[tuple[str, list[str]]]:
    """Yield letters and quantiles of each quantity that has them."""
    for name, head in HEADS.items():
        values = one[f"{name}_quantile"].sel(quantile=list(TOLD)).values
        if np.isfinite(values).all():
            yield head, [f"{value:#.2g}" for value in values]


def _samples(one: xr.Dataset) -> str:
    failed, number = int(one.failed), one.sizes["sample"]
    return f"{number} samples" if not failed else f"{number - failed} of {number} samples"
