"""Models side by side in text: the ladder, its best estimate, and what the chain is worth by it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from gripscale.figures.rungs import JUDGE, flawed
from gripscale.figures.view import CONVERGED, PredictionView
from gripscale.model import (
    ADHESIVE_FRICTION,
    CUT_OFF_EXPONENTS,
    FRICTION_OUTSIDE_BAND,
    extrapolation_of,
    with_adhesive,
)
from gripscale.report.outside_band import comparison_sentences, friction_sentence
from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant
from gripscale.rubber.extrapolation import WORTH_SAYING
from gripscale.study.display import axis_shown

if TYPE_CHECKING:
    import xarray as xr


SYMBOLS = {"contact_fraction": "A_r/A_0", "friction": "μ"}
LABEL = 20
"""Characters of a label before it is folded where the table would be too wide."""
TINY = 0.05
"""Per cent below which a spread or an error is as good as none."""


def comparison_table(comparison: xr.Dataset) -> Table:
    """Return area and friction of each rung, with spread, error and the factor from the one before.

    `comparison` has no axis but `rung`.
    """
    table = printed_table()
    table.add_column("model", overflow="fold", min_width=LABEL)
    parts = ["spread\n%", "error\n%", "×"]
    for head in ["A_r/A_0", *parts, "μ", "μ\ndiss.", *parts, "n"]:
        table.add_column(head, justify="right", no_wrap=True)
    for at, bad in enumerate(flawed(comparison)):
        one = comparison.isel(rung=at)
        label = str(one.label.item())
        area, friction = (list(_cells(one, name)) for name in SYMBOLS)
        lost = significant(float(one.total_friction_from_dissipation))
        friction.insert(1, lost)
        table.add_row(
            f"{label} *" if float(one[FRICTION_OUTSIDE_BAND]) > WORTH_SAYING else label,
            *area,
            *friction,
            samples_of(one),
            style="bold red" if bad else "bold" if str(one.rung.item()) == JUDGE else None,
        )
    return table


def further_table(comparison: xr.Dataset) -> Table:
    """Return friction with the area term, where there is one, and what the cut-off does."""
    both = with_adhesive(comparison)
    table = printed_table()
    table.add_column("model", overflow="fold", min_width=LABEL)
    heads = [] if both is None else ["μ + area\nterm"]
    for head in [*heads, "d ln A_r/A_0 /\nd ln λ_min", "d ln μ /\nd ln λ_min"]:
        table.add_column(head, justify="right", no_wrap=True)
    for at, label in enumerate(comparison.label.values):
        one = comparison.isel(rung=at)
        total = [] if both is None else [significant(float(both[at]))]
        table.add_row(str(label), *total, *(_exponent(one, name) for name in CUT_OFF_EXPONENTS))
    return table


def axis_table(comparison: xr.Dataset, axis: str, name: str) -> Table:
    """Return `contact_fraction` or `friction` of each rung over the axis that was varied."""
    shown = axis_shown(comparison, axis)
    table = printed_table()
    table.add_column(f"{SYMBOLS[name]}\n{axis.replace('_', ' ')} [{shown.unit}]", no_wrap=True)
    for rung in comparison.rung.values:
        table.add_column(str(rung).replace("_", "\n"), justify="right")
    best = f"best_{name}"
    estimated = bool(np.isfinite(comparison[f"{best}_factor"]).any())
    if estimated:
        table.add_column("best\nestimate", justify="right")
    for at, value in enumerate(shown.of(comparison[axis].values)):
        one = comparison.isel({axis: at})
        marks = [
            ("!" if bad else "") + ("*" if share > WORTH_SAYING else "")
            for bad, share in zip(flawed(one), one[FRICTION_OUTSIDE_BAND].values, strict=True)
        ]
        cells = [
            f"{significant(float(number))}{mark}"
            for number, mark in zip(one[f"total_{name}"].values, marks, strict=True)
        ]
        last = [_with_uncertainty(one, name)] if estimated else []
        table.add_row(f"{value:.3g}", *cells, *last, style="bold red" if any(flawed(one)) else None)
    return table


def remarks(comparison: xr.Dataset) -> Iterator[str]:
    """Yield what a table of one load cannot say: failures, extrapolation, the best estimate."""
    for at, bad in enumerate(flawed(comparison)):
        one = comparison.isel(rung=at)
        if bad:
            yield f"{one.label.item()}: {one.status.item()}."
    yield from beyond_band(comparison)
    yield from temperature_only(comparison)
    if "best_friction" in comparison and np.isfinite(comparison.best_friction):
        yield best_sentence(comparison)


def temperature_only(comparison: xr.Dataset) -> Iterator[str]:
    """Yield what is not in every model, where strain or heat change the rubber."""
    asked = json.loads(comparison.attrs.get("conditions", "null")) or {}
    effects = [name for name in ("softening", "heat") if asked.get(name) is not None]
    if effects:
        yield (
            f"{' and '.join(effects).capitalize()}: in the chains and in the direct contacts; the "
            "theories, and the windows and maps whose ratios make the best estimate's factors, "
            "know the temperature before the contact only."
        )


def beyond_band(comparison: xr.Dataset) -> Iterator[str]:
    """Yield a sentence for each rung with friction beyond the measured frequencies."""
    for label, text in comparison_sentences(comparison):
        yield f"* {label}: {text}"


def best_sentence(comparison: xr.Dataset) -> str:
    """Return the best estimate in words: what it is, what is in it and what is not."""
    numbers = ", ".join(
        f"{symbol} = {_with_uncertainty(comparison, name)}" for name, symbol in SYMBOLS.items()
    )
    parts, missing = ["profile as measured, at once"], []
    for at, label in enumerate(str(one) for one in comparison.factor_label.values):
        factors = [float(comparison[f"best_{name}_factor"][at]) for name in SYMBOLS]
        if all(map(math.isfinite, factors)):
            parts.append(f"{label} ({' and '.join(significant(one) for one in factors)})")
        else:
            missing.append(label)
    text = f"Best estimate: {numbers}, from {' × '.join(parts)}."
    if ADHESIVE_FRICTION in comparison:
        text += (
            f" With the area term, of its contact area, μ = {significant(_best_total(comparison))}."
        )
    if missing:
        text += f" Not included, neither factor nor uncertainty: {'; '.join(missing)}."
    return text


def _best_total(comparison: xr.Dataset) -> float:
    """Return the best estimate with the area term, which goes with the contact area."""
    judge = comparison.sel(rung=JUDGE)
    share = comparison.best_contact_fraction / judge.total_contact_fraction
    return float(comparison.best_friction + judge[ADHESIVE_FRICTION] * share)


def samples_of(one: xr.Dataset) -> str:
    """Return how many samples a rung has, and how many of them converged if not all."""
    whole, good = int(one.samples), int(one.converged_samples)
    return str(whole) if good == whole else f"{good}/{whole}"


def judgement(chain: PredictionView, direct: xr.Dataset) -> Iterator[str]:
    """Yield what the direct contact of the measured profiles says, and the chain beside it."""
    status = str(direct.prediction_status.item())
    if status != CONVERGED:
        yield f"The direct contact of the measured profiles gives no judgement: {status}."
        return
    area, friction = (float(direct[f"total_{name}"]) for name in SYMBOLS)
    words = f"A_r/A_0 = {significant(area)}"
    if chain.moving:
        words += f", mu = {significant(friction)}"
        both = with_adhesive(direct)
        if both is not None:
            words += f", with the area term {significant(float(both))}"
    yield f"Direct contact of the measured profiles, all waves at once at small strain: {words}."
    beyond = friction_sentence(extrapolation_of(direct))
    if beyond:
        yield f"Of it, {beyond}"
    if not chain.complete:
        return
    against = f"{chain.total('contact_fraction') / area:.2g} times its contact area"
    if chain.moving:
        against += f" and {chain.total('friction') / friction:.2g} times its friction"
    yield f"The chain has {against}; `gripscale compare` shows which assumption costs what."


def _cells(one: xr.Dataset, name: str) -> Iterator[str]:
    """Yield number, spread and error in per cent, and the factor from the rung it follows."""
    value = float(one[f"total_{name}"])
    yield significant(value)
    for part in ("spread", "error"):
        share = 100.0 * float(one[f"{name}_{part}"]) / value if value else math.nan
        yield "0" if share < TINY else significant(share, 2)
    yield significant(float(one[f"{name}_factor"]))


def _exponent(one: xr.Dataset, name: str) -> str:
    """Return a change with the smallest wavelength, a dash where that is not known."""
    value = float(one.get(name, math.nan))
    return "-" if math.isnan(value) else f"{value:.2f}"


def _with_uncertainty(one: xr.Dataset, name: str) -> str:
    value, sigma = float(one[f"best_{name}"]), float(one[f"best_{name}_uncertainty"])
    known = f" ± {100.0 * sigma:.2g} %" if math.isfinite(sigma) else ""
    return f"{significant(value)}{known}"
