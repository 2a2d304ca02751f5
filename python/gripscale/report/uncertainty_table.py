"""The uncertainty of a case as tables and sentences a person can read."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant
from gripscale.study.display import name_of
from gripscale.uncertainty import summary
from gripscale.uncertainty.quantiles import LEVELS, QUANTITIES
from gripscale.uncertainty.shares import SURE

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
