"""Models side by side in text: the ladder, its best estimate, and what the chain is worth by it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.analysis.effects import CHANGES, WITH_AREA_TERM
from gripscale.analysis.ladder import DIRECT
from gripscale.charts.ladder import flawed
from gripscale.charts.style import power_of_ten
from gripscale.charts.view import CONVERGED, PredictionView
from gripscale.core.units import MILLI, significant
from gripscale.experiment.axis import EFFECTS, axis_shown
from gripscale.model import (
    ADHESIVE_FRICTION,
    CUT_OFF_EXPONENTS,
    FRICTION_OUTSIDE_BAND,
    extrapolation_of,
    with_adhesive,
)
from gripscale.report.notices import comparison_sentences, friction_sentence
from gripscale.report.tables_run import printed_table
from gripscale.rubber.extrapolation import WORTH_SAYING

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
            style="bold red" if bad else "bold" if str(one.rung.item()) == DIRECT else None,
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
    judge = comparison.sel(rung=DIRECT)
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


# Predictions side by side: totals with their ranges, differences to the first, in a table.

QUANTITIES = ("total_contact_fraction", "total_friction")


class Row(NamedTuple):
    """One prediction: what it is called, its part of the Dataset, whether it is the first."""

    name: str
    one: xr.Dataset
    first: bool


def totals_table(head: str, rows: Iterable[Row], title: str | None = None) -> Table:
    """Return the totals of predictions with their ranges, and the difference to the first."""
    table = printed_table(title)
    table.add_column(head, no_wrap=True)
    for text in ("A_r/A_0", "range", "μ", "range", "μ less that\nof the first", "range"):
        table.add_column(text, justify="right")
    told = list(rows)
    failed = any(status(row.one) != "converged" for row in told)
    if failed:
        table.add_column("status", overflow="fold")
    for row in told:
        table.add_row(row.name, *totals_cells(row), *([status(row.one)] if failed else []))
    return table


def totals_cells(row: Row) -> list[str]:
    """Return area, friction and its difference to the first, each with its range."""
    cells = [
        cell
        for quantity in QUANTITIES
        for cell in (significant(float(row.one[quantity])), _range(row.one, quantity))
    ]
    return [*cells, *(["-", "-"] if row.first else _difference(row.one))]


def status(one: xr.Dataset) -> str:
    """Return "converged", or why there are no totals."""
    return str(one.prediction_status.item())


def difference_words(one: xr.Dataset, name: str, first: str, measured: str) -> str:
    """Return by how much friction differs from the first, and whether beyond what is `measured`.

    Nothing where one of both has no friction.
    """
    difference = float(one.total_friction_difference)
    if math.isnan(difference):
        return ""
    word = "more" if difference > 0.0 else "less"
    text = f"{name} has {significant(abs(difference))} {word} friction than {first}"
    low, high = (float(one.get(f"total_friction_difference_{end}", math.nan))
                 for end in ("low", "high"))  # fmt: skip
    if math.isnan(low + high):
        return text
    beyond = low > 0.0 or high < 0.0
    return f"{text}, {'' if beyond else 'not '}beyond what {measured} leave open"


def _range(one: xr.Dataset, quantity: str) -> str:
    if f"{quantity}_low" not in one or math.isnan(float(one[f"{quantity}_low"])):
        return "-"
    ends = (significant(float(one[f"{quantity}_{end}"])) for end in ("low", "high"))
    return " to ".join(ends)


def _difference(one: xr.Dataset) -> list[str]:
    name = "total_friction_difference"
    value = float(one[name])
    shown = "-" if math.isnan(value) else f"{value:+.3f}"
    if f"{name}_low" not in one or math.isnan(float(one[f"{name}_low"])):
        return [shown, "-"]
    ends = (f"{float(one[f'{name}_{end}']):+.3f}" for end in ("low", "high"))
    return [shown, " to ".join(ends)]


# What each effect of the conditions is worth, as a table: with all of them, without each.


def effects_table(*results: xr.Dataset) -> Table:
    """Return area and friction with all effects, without each in turn, and without any.

    Beside each number without an effect stands what the effect changes, in per cent of it.

    Parameters
    ----------
    *results : xarray.Dataset
        As `gripscale.analysis.effects` returns them, one for each model.
    """
    table = printed_table()
    table.add_column("model", no_wrap=True)
    table.add_column("effects", no_wrap=True)
    area_term = any(WITH_AREA_TERM in one for one in results)
    heads = ["A_r/A_0", "change", "μ", "change"]
    heads += ["μ area\nterm", "μ with\nit", "change"] if area_term else []
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("status", overflow="fold")
    for result in results:
        for i, effect in enumerate(result.effect.values.tolist()):
            one = result.isel(effect=i)
            status = str(one.prediction_status.item())
            table.add_row(
                str(result.attrs["model"]) if i == 0 else "",
                EFFECTS.get(effect, effect),
                *_changed_percent(one, "total_contact_fraction"),
                *_changed_percent(one, "total_friction"),
                *(_area_term(one) if area_term else ()),
                status,
                style=None if status == "converged" else "bold red",
                end_section=i == result.sizes["effect"] - 1,
            )
    return table


def _area_term(one: xr.Dataset) -> tuple[str, str, str]:
    if WITH_AREA_TERM not in one:
        return "-", "-", "-"
    return significant(float(one[ADHESIVE_FRICTION])), *_changed_percent(one, WITH_AREA_TERM)


def _changed_percent(one: xr.Dataset, name: str) -> tuple[str, str]:
    """Return a number, and what the effect left out makes of it, in per cent."""
    change = float(one[CHANGES[name]])
    return significant(float(one[name])), "" if math.isnan(change) else f"{100.0 * change:+.1f} %"


# Roads side by side as tables, and in sentences which scale makes the difference.


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


# Compounds side by side as a table, and in sentences which wave and relaxation times differ.


def compounds_table(data: xr.Dataset) -> Table:
    """Return totals of each compound with their ranges, and differences to the first."""
    names = data.rubber.values.tolist()
    rows = [Row(name, data.isel(rubber=i), i == 0) for i, name in enumerate(names)]
    return totals_table("compound", rows)


def compounds_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each compound, whether it differs from the first and what makes the difference."""
    first, *others = data.rubber.values.tolist()
    for i, name in enumerate(others, start=1):
        one = data.isel(rubber=i)
        text = difference_words(one, name, first, "the measured moduli")
        if text:
            yield f"{text}; {_reasons(one)}."


def _reasons(one: xr.Dataset) -> str:
    """Return which wave and which decade of relaxation times differ most."""
    reasons = []
    if "friction_difference" in one and np.isfinite(one.friction_difference).any():
        at = int(np.nanargmax(np.abs(one.friction_difference.values)))
        part, wavelength = (
            float(one[name].values[at]) for name in ("friction_difference", "wavelength")
        )
        reasons.append(f"most, {part:+.3f}, at the wave of {significant(wavelength / MILLI)} mm")
    if "friction_by_decade_difference" in one:
        parts = np.nan_to_num(one.friction_by_decade_difference.values)
        at = int(np.argmax(np.abs(parts)))
        power = round(math.log10(float(one.decade.values[at])))
        reasons.append(
            f"{parts[at]:+.3f} by relaxation times of {power_of_ten(power)} to "
            f"{power_of_ten(power + 1)} s"
        )
    return ", and ".join(reasons) or "the model does not tell by which waves"
