"""Predictions side by side: effects left out one by one, and roads or compounds by rank."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from gripscale.charts.draw import image
from gripscale.charts.page_elements import Picture
from gripscale.charts.style import power_of_ten
from gripscale.core.arrays import Array
from gripscale.core.finding import Finding, sentences
from gripscale.core.units import MILLI, ZERO_CELSIUS, display_unit_of
from gripscale.experiment.design import CHANGES, CONVERGED, WITH_AREA_TERM
from gripscale.io.table import Column, Table, change, significant
from gripscale.model import ADHESIVE_FRICTION, STATUS, input_doubts_of
from gripscale.questions.inputs.page import input_sections, texture_table
from gripscale.questions.vary.axis import EFFECTS, MODELS
from gripscale.questions.vary.inputs import READING_NOTES, TEMPERATURE
from gripscale.questions.vary.page import answer_columns
from gripscale.questions.words import SYMBOLS, believed, is_estimated
from gripscale.report.again import rerun_section
from gripscale.report.elements import Card, Element, Page, Section, Text
from gripscale.report.equations import method_section
from gripscale.surface.surface import SURFACE_KIND

# Confidence from which one lies over another, as outside of a two-sided 90 % interval.
SIGNIFICANT = 0.95
_CERTAIN = 0.995


def effects_table(*results: xr.Dataset) -> Table:
    """Return area and friction with all effects, without each in turn, and without any.

    Beside each number stands its change by the effects that are left out. `results` are of
    `gripscale.questions.vary.effects`, one for each model.
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
    for name, symbol in SYMBOLS.items():
        total = f"total_{name}"
        columns += [
            Column(total, every(total), symbol),
            Column(CHANGES[total], every(CHANGES[total]), "change", format=change),
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


def ranking_lines(data: xr.Dataset, dim: str) -> Iterator[str]:
    """Yield the ranking with its numbers, the ratio of each to the next, and what it rests on."""
    order, names = ranked_order(data, dim), data[dim].values.tolist()
    if len(order) < 2:
        yield "Answer: none; no two of them have a friction to be compared."
        return
    column = believed(data, "friction")
    texts = [f"{names[at]} {significant(float(data[column][at]))}" for at in order]
    sure = [_confidence(data, dim, *pair) for pair in pairwise(order)]
    steps = [f" over {text}{words}" for text, words in zip(texts[1:], sure, strict=True)]
    yield f"Answer: friction μ ranks {texts[0]}{''.join(steps)}."
    for high, low in pairwise(order):
        ratio, *ends = (
            float(data[f"friction_ratio{end}"].transpose(dim, "over")[high, low])
            for end in ("", "_low", "_high")
        )
        interval = f" ({' to '.join(map(significant, ends))})" if math.isfinite(ends[0]) else ""
        area = data[believed(data, "contact_fraction")].values
        ratios = (
            f"friction × {significant(ratio)}{interval}, contact area × "
            f"{significant(area[high] / area[low])}"
        )
        yield f"  {names[high]} over {names[low]}: {ratios}{_causes(data, dim, high, low)}"
    if doubts := input_doubts_of(data):
        yield f"  not to be relied on: {sentences(doubts)}"
    pressure, speed = (
        display_unit_of(data.attrs, name).text(float(data.attrs[f"nominal_{name}"]))
        for name in ("pressure", "speed")
    )
    kelvin = data.attrs.get(TEMPERATURE)
    at = "" if kelvin is None else f", all at {kelvin - ZERO_CELSIUS:.4g} °C"
    yield f"  for {pressure} and {speed}{at}; {_basis(data, dim)}"


def noun(data: xr.Dataset, dim: str) -> str:
    """Return what stands side by side along a dimension."""
    return "compound" if dim == "rubber" else str(data.attrs.get(SURFACE_KIND, "surface"))


def ranked_order(data: xr.Dataset, dim: str) -> list[int]:
    """Return the numbers of what has friction along `dim`, the largest first."""
    friction = data[believed(data, "friction")].transpose(dim).values
    return [int(i) for i in np.argsort(-friction, kind="stable") if friction[i] > 0.0]


def _confidence(data: xr.Dataset, dim: str, high: int, low: int) -> str:
    """Return how sure it is that one lies over another, in brackets; empty if nobody knows."""
    confidence = float(data["confidence"].transpose(dim, "over")[high, low])
    if math.isnan(confidence):
        return ""
    if confidence < SIGNIFICANT:
        return f" ({percent_sure(confidence)}: no significant difference)"
    return f" ({percent_sure(confidence)} sure)"


def percent_sure(confidence: float) -> str:
    """Return a confidence in per cent."""
    return "> 99 %" if confidence > _CERTAIN else f"{100.0 * confidence:.0f} %"


def _causes(data: xr.Dataset, dim: str, high: int, low: int) -> str:
    """Return at which wavelengths and relaxation times most of a difference arises."""
    texts = []
    if "octave_friction" in data:
        at, part = _largest_difference(data["octave_friction"], high, low)
        end = float(data["octave"][at]) / MILLI
        texts.append(f"{part:+.3f} by waves of {significant(end)} to {significant(2.0 * end)} mm")
    if dim == "rubber" and "friction_by_decade" in data:
        at, part = _largest_difference(data["friction_by_decade"], high, low)
        power = round(math.log10(float(data["decade"][at])))
        ends = f"{power_of_ten(power)} to {power_of_ten(power + 1)} s"
        texts.append(f"{part:+.3f} by relaxation times of {ends}")
    return f"; most of μ: {', '.join(texts)}" if texts else ""


def _largest_difference(parts: xr.DataArray, high: int, low: int) -> tuple[int, float]:
    rows = np.nan_to_num(parts.values)
    differences = rows[high] - rows[low]
    at = int(np.argmax(np.abs(differences)))
    return at, float(differences[at])


def _basis(data: xr.Dataset, dim: str) -> str:
    """Return which model the ranking is from, and what its confidence holds."""
    if not is_estimated(data, "friction"):
        return "chain of sine waves, without an interval: not all of the surfaces were measured"
    answer = "direct contact of the measured surface × its factors"
    if not np.isfinite(data["friction_ratio_low"].values).any():
        return (
            f"{answer}; no interval: a surface is too short to tell whether it stands for the whole"
        )
    if dim == "surface":
        return f"{answer}; the errors of the surfaces are independent"
    has_moduli = "series_change" in data and bool(data["series_change"].notnull().any())
    moduli = "measured moduli, " if has_moduli else ""
    return (
        f"{answer}; what all share of the surface and its factors cancels, what is left comes from "
        f"{moduli}pieces of the surface and grids"
    )


def ranking_table(data: xr.Dataset, dim: str) -> Table:
    """Return the answers by rank, each with its friction over that of the next."""
    every = data[dim].values.tolist()
    order = ranked_order(data, dim)
    order += [at for at in range(len(every)) if at not in order]
    following = [*order[1:], None]
    columns = [Column(dim, [str(every[at]) for at in order], noun(data, dim))]
    columns += answer_columns(data, lambda name: data[name].values[order].tolist())

    def over_next(name: str) -> Array:
        pairs = data[name].transpose(dim, "over").values
        chosen = zip(order, following, strict=True)
        return np.array([math.nan if low is None else pairs[high, low] for high, low in chosen])

    columns.append(Column("friction_ratio", over_next("friction_ratio"), "μ over the next"))
    ends = [over_next(f"friction_ratio_{end}") for end in ("low", "high")]
    if np.isfinite(ends).any():
        columns += [
            Column("friction_ratio_interval", np.stack(ends, axis=1), "90 %"),
            Column("confidence", over_next("confidence"), "confidence", format=percent_sure),
        ]
    status = [str(data[STATUS].values[at]) for at in order]
    bad = [text != CONVERGED for text in status]
    columns += [Column("status", status)] if any(bad) else []
    return Table(f"{dim}s", columns, f"{noun(data, dim).capitalize()}s by friction", bad=bad)


def side_by_side_tables(data: xr.Dataset, dim: str) -> list[Table]:
    """Return the ranking, and the texture of surfaces."""
    tables = [ranking_table(data, dim)]
    if "rms_height" in data:
        tables.append(texture_table(data, dim, noun(data, dim)))
    return tables


def ranking_cards(data: xr.Dataset, dim: str) -> Iterator[Card]:
    """Yield the friction of each by rank, and how sure it is that it lies over the next."""
    order, names = ranked_order(data, dim), data[dim].values.tolist()
    column = believed(data, "friction")
    for high, low in zip(order, [*order[1:], None], strict=True):
        sure = ""
        if low is not None:
            sure = f"over {names[low]}{_confidence(data, dim, high, low)}"
        yield Card(f"μ of {names[high]}", significant(float(data[column][high])), sure)


def side_by_side_page(
    data: xr.Dataset, dim: str, findings: Sequence[Finding], pictures: Sequence[Picture]
) -> Page:
    """Return the page of surfaces or compounds side by side."""
    notes = str(data.attrs.get(READING_NOTES, "")).splitlines()
    elements: list[Element] = [*side_by_side_tables(data, dim), *map(Text, notes)]
    names = ", ".join(map(str, data[dim].values))
    return Page.of(
        f"{noun(data, dim).capitalize()}s side by side: {names}",
        str(data.attrs.get("title", "")),
        findings,
        ranking_cards(data, dim),
        [
            Section(f"{dim}s", "Ranking", [*elements, *map(image, pictures)]),
            *input_sections(data),
            method_section(),
            rerun_section(data.attrs),
        ],
        [line.strip() for line in ranking_lines(data, dim)],
    )
