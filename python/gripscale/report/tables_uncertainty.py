"""The uncertainty of a case as tables and sentences a person can read."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.analysis.calibration_text import interval, written
from gripscale.analysis.profile_likelihood import LEVEL
from gripscale.analysis.propagation import LEVELS, QUANTITIES, of_same_inputs, summary
from gripscale.analysis.variance_shares import SURE
from gripscale.charts.page_elements import Card
from gripscale.core.units import ZERO_CELSIUS, significant
from gripscale.experiment.axis import name_of
from gripscale.report.tables_run import printed_table

if TYPE_CHECKING:
    from gripscale.analysis.calibration import Calibration
    from gripscale.analysis.profile_likelihood import HeldOut


HEADS = {"friction": "μ", "contact_fraction": "A_r/A_0"}


def axis_of(data: xr.Dataset) -> str:
    """Return what is varied beside the samples, or nothing."""
    return next((str(name) for name in data.failed.dims if name != "model"), "")


def places(data: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield what each model and load is called, with its part."""
    axis = axis_of(data)
    for name in data.model.values:
        one = data.sel(model=name)
        if not axis:
            yield str(name), one
            continue
        for i in range(one.sizes[axis]):
            yield f"{name}, {axis} {name_of(one, axis, i)}", one.isel({axis: i})


def parts(data: xr.Dataset) -> list[Any]:
    """Return all there is to be told: tables, and sentences as texts."""
    told: list[Any] = [quantile_table(data)]
    untold = []
    for title, one in places(data):
        if np.isfinite(one.friction_share).any():
            told += [share_table(one, f"what matters most ({title})"), *order_sentences(one)]
        elif int(one.failed) < one.sizes["sample"]:
            untold.append(title)
    if untold:
        where = "; ".join(untold)
        told.append(f"too few samples, or no friction, to tell what matters most: {where}")
    told += grid_sentences(data)
    told += [f"not sampled: {why}" for why in json.loads(data.attrs["left_out"])]
    if not axis_of(data):
        told.append(summary(data))
    sentence = failures(data)
    return [*told, sentence] if sentence else told


def quantile_table(data: xr.Dataset) -> Table:
    """Return the quantiles of friction and contact fraction of each model and load."""
    table = printed_table()
    heads = ["", "", "case", *(f"{level:.0%}" for level in LEVELS), "samples", "failed"]
    for number, head in enumerate(heads):
        table.add_column(head, justify="left" if number < 2 else "right", no_wrap=True)
    for title, one in places(data):
        for name in QUANTITIES:
            numbers = [float(one[f"{name}_case"]), *one[f"{name}_quantile"].values]
            counts = [str(one.sizes["sample"]), str(int(one.failed))]
            table.add_row(title, HEADS[name], *map(significant, numbers), *counts)
    return table


def share_table(one: xr.Dataset, title: str) -> Table:
    """Return what each source does to friction and contact fraction at one load, most first.

    From and to: 5 and 95 % of what it does alone.
    """
    table = printed_table(title)
    table.add_column("source")
    for head in HEADS.values():
        table.add_column(f"{head}\nfrom", justify="right", no_wrap=True)
        table.add_column("to", justify="right", no_wrap=True)
        table.add_column("share of\nvariance", justify="right", no_wrap=True)
    for k in order(one, "friction"):
        cells = []
        for name in HEADS:
            low, high = one[f"{name}_end"].values[k]
            share, error = one[f"{name}_share"].values[k], one[f"{name}_share_error"].values[k]
            cells += [significant(low), significant(high), f"{max(share, 0.0):.0%} ± {error:.0%}"]
        table.add_row(str(one.label.values[k]), *cells)
    rest = [f"{max(float(one[f'{name}_unexplained']), 0.0):.0%}" for name in HEADS]
    table.add_row("none of them alone", "", "", rest[0], "", "", rest[1])
    return table


def order(one: xr.Dataset, name: str) -> list[int]:
    """Return the places of the sources, the largest share first."""
    return [int(k) for k in np.argsort(-one[f"{name}_share"].values, kind="stable")]


def order_sentences(one: xr.Dataset) -> list[str]:
    """Return what so many samples cannot tell of the shares in friction."""
    shares, labels = one.friction_share.values, one.label.values
    apart, ranked = one.friction_share_difference_error.values, order(one, "friction")
    seen = [k for k in ranked if shares[k] > SURE * one.friction_share_error.values[k]]
    unseen = [str(labels[k]) for k in ranked if k not in seen]
    close = [
        f"{labels[a]} and {labels[b]}"
        for a, b in pairwise(seen)
        if shares[a] - shares[b] < SURE * apart[a, b]
    ]
    number = int(np.isfinite(one.friction).sum())
    told = []
    if close:
        told.append(f"{number} samples cannot tell the order of {'; '.join(close)}")
    if unseen:
        told.append(f"{number} samples cannot tell from nothing: {', '.join(unseen)}")
    return told


def grid_sentences(data: xr.Dataset) -> list[str]:
    """Return how far the grids of the direct contact are estimated to be off, if it was asked."""
    told = []
    for name in data.model.values:
        one = data.sel(model=name)
        errors = {head: one[f"{key}_grid_error"].values for key, head in HEADS.items()}
        shown = [
            f"{100.0 * np.nanmedian(error):.2g} % in {head}"
            for head, error in errors.items()
            if np.isfinite(error).any()
        ]
        if shown:
            told.append(
                f"{name}: estimated error of the grid of a sample {' and '.join(shown)} (median), "
                "in no quantile; a tolerance asks for less"
            )
    return told


def failures(data: xr.Dataset) -> str:
    """Return how many samples have no answer, and why most of them; nothing if all have one."""
    status = data.status.values.ravel()
    bad = Counter(str(one) for one in status if one != "converged")
    own = [str(one) for one in data.status_case.values.ravel() if one != "converged"]
    told = []
    if bad:
        why, count = bad.most_common(1)[0]
        told.append(
            f"{bad.total()} of {status.size} samples have no answer and count in no quantile; "
            f"{count} of them: {why}"
        )
    if own:
        told.append(f"the case itself has no answer: {own[0]}")
    return "; ".join(told)


# Quantiles of the uncertainty of a case, for the summaries of its other reports.

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

    `text` and `digests` are of the case of the report, see `gripscale.analysis.of_same_inputs`.
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


# A calibrated area term in text: its parameters, and what it says of points left out.


def parameter_table(calibration: Calibration) -> Table:
    """Return value, standard error and interval of each parameter, and what was held."""
    table = printed_table()
    table.add_column("parameter")
    for head in ("value", "standard error"):
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column(f"{100 * LEVEL:.0f} % by profile likelihood")
    for one in calibration.estimates:
        error = written(one.standard_error, one.unit, 2) if one.determined else "-"
        style = None if one.determined else "yellow"
        table.add_row(one.name, written(one.value, one.unit, 4), error, interval(one), style=style)
    return table


def correlations(calibration: Calibration) -> str:
    """Return the correlations of the estimates in a sentence, empty for a single one."""
    names = [one.name for one in calibration.estimates]
    pairs = [
        f"{name} and {names[b]} {calibration.correlation[a, b]:+.2f}"
        for a, name in enumerate(names)
        for b in range(a + 1, len(names))
    ]
    return f"Correlations: {', '.join(pairs)}." if pairs else ""


def held_out_table(calibration: Calibration) -> Table:
    """Return the errors of the law at each group of points, fitted to the others."""
    groups = calibration.held_out
    spread = any(np.isfinite(one.rms_outside_in_spread) for one in groups)
    table = printed_table()
    table.add_column("left out")
    heads = ["points", "rms\ninside", "rms\noutside", *["outside/\nspread"] * spread]
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("")
    for one in groups:
        numbers = [one.rms_inside, one.rms_outside, *[one.rms_outside_in_spread] * spread]
        cells = (significant(number, 2) for number in numbers)
        table.add_row(group_name(calibration, one), str(one.points), *cells, one.why_not)
    return table


def group_name(calibration: Calibration, one: HeldOut) -> str:
    """Return a group in words: its temperature, or its decade of speed."""
    if calibration.held_out_by == "temperature":
        return f"{one.value - ZERO_CELSIUS:.0f} °C"
    return f"{one.value:g} to {10.0 * one.value:g} m/s"
