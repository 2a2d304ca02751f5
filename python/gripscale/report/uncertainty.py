"""The uncertainty of a case: quantiles, what matters most, and what the samples cannot show."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import pairwise

import numpy as np
import xarray as xr

from gripscale.analysis.propagation import LEVELS, QUANTITIES, of_same_inputs, summary
from gripscale.analysis.variance_shares import SIGNIFICANCE
from gripscale.charts.uncertainty import axis_of
from gripscale.charts.view import CONVERGED, SYMBOLS
from gripscale.experiment.axis import name_of
from gripscale.io.table import Column, Table
from gripscale.model import status_words
from gripscale.report.elements import Card
from gripscale.report.notices import Failure

HEADS = {name: SYMBOLS[name] for name in QUANTITIES}
"""Symbols of the quantities, in their order."""
OF_ANOTHER = (
    "The uncertainty in this folder is of another case and is left out; run `gripscale "
    "uncertainty` again."
)
SUMMARY = (0.05, 0.5, 0.95)
"""Quantiles in the summaries of other reports."""


def places(data: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield what each model and load is called, with its part."""
    axis = axis_of(data)
    for name in data.model.values:
        model = data.sel(model=name)
        if not axis:
            yield str(name), model
        else:
            for i in range(model.sizes[axis]):
                yield f"{name}, {axis} {name_of(model, axis, i)}", model.isel({axis: i})


def uncertainty_parts(data: xr.Dataset) -> Iterator[str | Table]:
    """Yield tables and sentences of an uncertainty."""
    yield quantile_table(data)
    without_shares = []
    for title, part in places(data):
        if np.isfinite(part.friction_share).any():
            yield share_table(part, title)
        elif int(part.failed) < part.sizes["sample"]:
            without_shares.append(title)
    if without_shares:
        where = "; ".join(without_shares)
        yield f"Too few samples, or no friction, to find what matters most: {where}."
    yield from grid_sentences(data)
    yield from (f"Not sampled: {why}." for why in json.loads(data.attrs["left_out"]))
    if not axis_of(data):
        yield f"{summary(data)}."
    yield from map(str, filter(None, [failures(data)]))


def quantile_table(data: xr.Dataset) -> Table:
    """Return the quantiles of friction and contact fraction of each model and load."""
    rows = [(title, part, name) for title, part in places(data) for name in QUANTITIES]
    quantiles = np.array([part[f"{name}_quantile"].values for _, part, name in rows])
    columns = [
        Column("model", [title for title, _, _ in rows]),
        Column("quantity", [HEADS[name] for _, _, name in rows]),
        Column("case", [float(part[f"{name}_case"]) for _, part, name in rows], "the case"),
        *(
            Column(f"quantile_{level:g}", quantiles[:, at], f"{level:.0%}")
            for at, level in enumerate(LEVELS)
        ),
        Column("samples", [part.sizes["sample"] for _, part, _ in rows], format="{:.0f}".format),
        Column("failed", [int(part.failed) for _, part, _ in rows], format="{:.0f}".format),
    ]
    return Table("quantiles", columns, "Quantiles of the samples", keys=2)


def share_table(part: xr.Dataset, title: str) -> Table:
    """Return what each source does to friction and contact fraction at one load, most first.

    From and to: 5 and 95 % of what it does alone.
    """
    ranked = _ranked(part)
    columns = [Column("source", [*part.label.values[ranked], "none of them alone"])]
    for name, symbol in HEADS.items():
        missing = np.full((1, 2), np.nan)
        share, error = (part[f"{name}_{end}"].values[ranked] for end in ("share", "share_error"))
        rest = float(part[f"{name}_unexplained"])
        columns += [
            Column(
                f"{name}_end",
                np.concatenate([part[f"{name}_end"].values[ranked], missing]),
                "from to",
                group=symbol,
            ),
            Column(
                f"{name}_share",
                [max(value, 0.0) for value in (*share, rest)],
                "share of variance",
                group=symbol,
                format="{:.0%}".format,
            ),
            Column(
                f"{name}_share_error", [*error, np.nan], "±", group=symbol, format="{:.0%}".format
            ),
        ]
    notes = order_sentences(part)
    return Table("shares", columns, f"What matters most ({title})", notes)


def _ranked(part: xr.Dataset) -> list[int]:
    """Return the places of the sources, the largest share of the friction first."""
    return [int(k) for k in np.argsort(-part.friction_share.values, kind="stable")]


def order_sentences(part: xr.Dataset) -> list[str]:
    """Return which shares in friction are not significant, and which do not differ."""
    shares, labels = part.friction_share.values, part.label.values
    apart, ranked = part.friction_share_difference_error.values, _ranked(part)
    seen = [k for k in ranked if shares[k] > SIGNIFICANCE * part.friction_share_error.values[k]]
    unseen = [str(labels[k]) for k in ranked if k not in seen]
    close = [
        f"{labels[a]} and {labels[b]}"
        for a, b in pairwise(seen)
        if shares[a] - shares[b] < SIGNIFICANCE * apart[a, b]
    ]
    count = int(np.isfinite(part.friction).sum())
    sentences = []
    if close:
        sentences.append(f"Not in a significant order with {count} samples: {'; '.join(close)}.")
    if unseen:
        sentences.append(f"No significant effect with {count} samples: {', '.join(unseen)}.")
    return sentences


def grid_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield the estimated errors of the grids of the direct contact, if it was sampled."""
    for name in data.model.values:
        model = data.sel(model=name)
        errors = {head: model[f"{key}_grid_error"].values for key, head in HEADS.items()}
        texts = [
            f"{100.0 * np.nanmedian(error):.2g} % in {head}"
            for head, error in errors.items()
            if np.isfinite(error).any()
        ]
        if texts:
            yield (
                f"{name}: the estimated error of the grid of a sample is {' and '.join(texts)} "
                "(median). The quantiles do not include it; --tolerance makes it smaller."
            )


def failures(data: xr.Dataset) -> Failure | None:
    """Return how many samples have no answer, and why most of them; None if all have one."""
    bad = Counter(_failed(data, "status"))
    of_case = _failed(data, "status_case")
    sentences, words = [], []
    if bad:
        (why, word), count = bad.most_common(1)[0]
        words.append(word)
        sentences.append(
            f"{bad.total()} of {data.status.size} samples have no answer and count in no quantile; "
            f"{count} of them: {why}"
        )
    if of_case:
        why, word = of_case[0]
        words.append(word)
        sentences.append(f"the case itself has no answer: {why}")
    return Failure("; ".join(sentences), next(filter(None, words), "")) if sentences else None


def _failed(data: xr.Dataset, sentences: str) -> list[tuple[str, str]]:
    """Return sentence and word of what did not converge."""
    words = status_words(data, sentences).values.ravel()
    pairs = zip(data[sentences].values.ravel(), words, strict=True)
    return [(str(text), str(word)) for text, word in pairs if text != CONVERGED]


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
        f"Uncertainty, {part.model.item()}, 5, 50 and 95 % of {_samples(part)}: "
        + "; ".join(f"{head} = {', '.join(numbers)}" for head, numbers in _quantiles(part))
        for part in (data.sel(model=name) for name in data.model.values)
    ]


def uncertainty_cards(data: xr.Dataset | None) -> list[Card]:
    """Return a card with 5 and 95 % of each quantity and model, the median below."""
    if data is None or axis_of(data):
        return []
    return [
        Card(f"{head}, 5 to 95 %", f"{low} to {high}", f"{name}: median {median}; {_samples(part)}")
        for name in data.model.values.tolist()
        for part in [data.sel(model=name)]
        for head, (low, median, high) in _quantiles(part)
    ]


def _quantiles(part: xr.Dataset) -> Iterator[tuple[str, list[str]]]:
    """Yield letters and quantiles of each quantity that has them."""
    for name, head in HEADS.items():
        values = part[f"{name}_quantile"].sel(quantile=list(SUMMARY)).values
        if np.isfinite(values).all():
            yield head, [f"{value:#.2g}" for value in values]


def _samples(part: xr.Dataset) -> str:
    failed, count = int(part.failed), part.sizes["sample"]
    return f"{count} samples" if not failed else f"{count - failed} of {count} samples"
