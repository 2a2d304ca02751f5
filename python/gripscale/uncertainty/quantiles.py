"""Quantiles of what the samples answered, and the sentence on them that other reports quote."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
"""The quantiles that are told."""

QUANTITIES = {
    "friction": ("mu", "friction coefficient"),
    "contact_fraction": ("A_r/A_0", "real over nominal contact area"),
}
"""What each sample answers: its letters and its name."""


def quantiles(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the quantiles over the last axis, shape (levels, ...), NaN not counting.

    Median-unbiased (R. J. Hyndman & Y. Fan, Am. Stat. 50 (1996) 361,
    doi:10.1080/00031305.1996.10473566, their number 8): the ends of few samples are not drawn in.
    """
    found = np.full((len(LEVELS), *values.shape[:-1]), np.nan)
    for place in np.ndindex(values.shape[:-1]):
        known = values[place][np.isfinite(values[place])]
        if known.size > 1:
            found[(slice(None), *place)] = np.quantile(known, LEVELS, method="median_unbiased")
    return found


def summary(data: xr.Dataset) -> str:
    """Return friction and contact fraction of each model in a sentence, failures counted.

    Parameters
    ----------
    data : xarray.Dataset
        Of `propagate`, at one load.
    """
    return "; ".join(_of_model(data.sel(model=name)) for name in data.model.values)


def _of_model(one: xr.Dataset) -> str:
    failed, number = int(one.failed), one.sizes["sample"]
    count = f"{number} samples" if not failed else f"{number - failed} of {number} samples"
    told = [
        _interval(letters, one[f"{name}_quantile"].values)
        for name, (letters, _) in QUANTITIES.items()
        if np.isfinite(one[f"{name}_quantile"].values).all()
    ]
    if not told:
        return f"{one.model.item()}: none of {number} samples has an answer"
    text = f"{one.model.item()}: {', '.join(told)} in 90 % of {count}"
    return f"{text}, {failed} failed" if failed else text


def _interval(letters: str, values: NDArray[np.float64]) -> str:
    low, middle, high = (f"{value:#.2g}" for value in values[[0, 2, 4]])
    return f"{letters} = {middle} ({low} to {high})"
