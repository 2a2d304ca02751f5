"""Predictions side by side: effects left out one by one, roads under one rubber, compounds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from gripscale.chain.chain import Chain
from gripscale.charts.draw import image
from gripscale.charts.style import power_of_ten
from gripscale.core.finding import Finding, sentences
from gripscale.core.units import MILLI, ZERO_CELSIUS, display_unit_of
from gripscale.experiment.design import CHANGES, CONVERGED, WITH_AREA_TERM
from gripscale.io.table import Column, Table, change, fixed, significant
from gripscale.model import ADHESIVE_FRICTION, STATUS, input_doubts_of, status_words
from gripscale.questions.inputs.page import texture_table
from gripscale.questions.vary.axis import EFFECTS, MODELS
from gripscale.questions.vary.charts_side_by_side import compound_pictures, road_pictures
from gripscale.questions.vary.inputs import TEMPERATURE
from gripscale.questions.vary.page_of_study import count_cards, study_findings, study_sections
from gripscale.questions.words import SYMBOLS
from gripscale.report.again import rerun_section
from gripscale.report.elements import Card, Element, Page, Section, Text
from gripscale.report.equations import method_section
from gripscale.report.failures import Failure
from gripscale.rubber import Rubber

_RATIOS = {"friction": "friction", "contact_fraction": "contact area"}
_ROADS = (
    "The same rubber under the same load on each road: in the chain of its sine waves, and in the "
    "direct contact of its whole profile. A range holds 90 % of what other stretches of the same "
    "road might give. A difference is significant if its range does not contain zero."
)
_COMPOUNDS = (
    "Each compound on the same road under the same load. A range is what the measured moduli leave "
    "open. A difference is significant if its range does not contain zero."
)
CHAIN_RANKS_NOTHING = (
    "The chain solves the sine waves of the road one by one and leaves out how they meet in the "
    "contact. It says where a difference may come from; the ranking is that of the direct contact."
)
_QUANTITIES = {f"total_{name}": symbol for name, symbol in SYMBOLS.items()}


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
    for name, symbol in _QUANTITIES.items():
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


def side_by_side_totals(data: xr.Dataset, dim: str, heading: str, model: str = "") -> Table:
    """Return totals along `dim` with their ranges, and the differences to the first.

    Of `model`, the name of the table, only what was asked for: nothing without a status.
    """
    status = [str(value) for value in data.prediction_status.values]
    asked = [i for i, text in enumerate(status) if text]
    data, status = data.isel({dim: asked}), [status[i] for i in asked]

    columns = [Column(dim, [str(name) for name in data[dim].values], heading)]
    for name, symbol in _QUANTITIES.items():
        columns += [
            Column(name, data[name].values, symbol),
            Column(f"{name}_range", _ends(data, name), "range"),
        ]
    name = "total_friction_difference"
    difference, span = data[name].values.copy(), _ends(data, name)
    if 0 in asked:  # the first differs from nothing
        difference[0], span[0] = np.nan, np.nan
    columns += [
        Column(name, difference, "difference of μ from the first", format=fixed(3, "+")),
        Column(f"{name}_range", span, "range", format=fixed(3, "+")),
    ]
    bad = [text != CONVERGED for text in status]
    if any(bad):
        columns.append(Column("status", status))
    caption = f"Totals, {model}" if model else "Totals"
    return Table("-".join(filter(None, [f"{dim}s", model])), columns, caption, bad=bad)


def difference_words(data: xr.Dataset, name: str, first: str, measured: str) -> str:
    """Return by how much friction differs from the first, and whether beyond what is `measured`.

    Not the latter without `measured`; nothing where either has no friction.
    """
    difference = float(data.total_friction_difference)
    if math.isnan(difference):
        return ""
    word = "higher" if difference > 0.0 else "lower"
    text = f"μ of {name} is {significant(abs(difference))} {word} than that of {first}"
    low, high = (
        float(data.get(f"total_friction_difference_{end}", math.nan)) for end in ("low", "high")
    )
    if not measured or math.isnan(low + high):
        return text
    beyond = low > 0.0 or high < 0.0
    return f"{text}, {'' if beyond else 'not '}beyond what {measured} leave open"


def ratio_lines(data: xr.Dataset, dim: str) -> Iterator[str]:
    """Yield which of the roads or compounds grips more, by what ratio, and what that rests on."""
    names = [str(name) for name in data[dim].values]
    friction = data["friction_ratio"].values
    if not np.isfinite(friction[1:]).any():
        yield "Answer: none; no two of them have a friction to be compared."
        return
    ends = [ratio_ends(data, "friction", i) for i in range(1, len(names))]
    level = " (90 % intervals)" if np.isfinite(ends).any() else ", without an interval"
    others = [i for i in range(1, len(names)) if math.isfinite(friction[i])]
    ratios = [", ".join(_ratio_text(data, name, i) for name in reversed(SYMBOLS)) for i in others]
    if len(names) == 2:
        head = f"{_grip_words(data, names[1], names[0])}: {ratios[0]}"
    else:
        texts = [f"{names[i]} {ratio}" for i, ratio in zip(others, ratios, strict=True)]
        top = f"{names[int(np.nanargmax(friction))]} has the most friction"
        head = f"{top}. Over {names[0]}: {'; '.join(texts)}"
    yield f"Answer: {head}{level}."
    if doubts := input_doubts_of(data):
        yield f"  not to be relied on: {sentences(doubts)}"
    if TEMPERATURE in data.attrs:
        pressure, speed = (
            display_unit_of(data.attrs, name).text(float(data.attrs[f"nominal_{name}"]))
            for name in ("pressure", "speed")
        )
        celsius = data.attrs[TEMPERATURE] - ZERO_CELSIUS
        yield f"  for {pressure} and {speed}, all at {celsius:.4g} °C"
    yield f"  by the {_judge(data)}"


def _grip_words(data: xr.Dataset, name: str, first: str) -> str:
    """Return whether the second of two grips more than the first, as far as that is known."""
    low, high = ratio_ends(data, "friction", 1)
    ratio = float(data["friction_ratio"].values[1])
    if math.isnan(low):
        return f"{name} over {first}"
    if low <= 1.0 <= high:
        return f"{name} and {first} have no significant difference in grip"
    return f"{name} grips {'more' if ratio > 1.0 else 'less'} than {first}"


def ratio_ends(data: xr.Dataset, name: str, at: int) -> tuple[float, float]:
    """Return the interval of a ratio to the first; NaN where there is none."""
    low, high = (
        float(data[f"{name}_ratio_{end}"].values[at]) if f"{name}_ratio_{end}" in data else math.nan
        for end in ("low", "high")
    )
    return low, high


def _ratio_text(data: xr.Dataset, name: str, at: int) -> str:
    """Return a ratio with its interval, such as `friction × 1.32 (1.21 to 1.44)`."""
    text = f"{_RATIOS[name]} × {significant(float(data[f'{name}_ratio'].values[at]))}"
    low, high = ratio_ends(data, name, at)
    return text if math.isnan(low) else f"{text} ({significant(low)} to {significant(high)})"


def _judge(data: xr.Dataset) -> str:
    """Return which model the ratios are from, and what their intervals hold."""
    roads = "surface" in data.dims
    if "best_friction" not in data:
        return "chain of sine waves: not all of the surfaces were measured"
    if roads and not np.isfinite(data["friction_ratio_low"].values[1:]).any():
        return (
            "direct contact of the measured surfaces × its factors; no interval: a surface is too "
            "short to tell how well it represents its road"
        )
    if roads:
        return (
            "direct contact of the measured surfaces × its factors; the errors of the roads are "
            "independent"
        )
    of = "direct contact of the measured surface, the same for all"
    if "friction_ratio_low" not in data:
        return f"{of}; no interval: the errors of the measured moduli were not predicted"
    if not np.isfinite(data["friction_ratio_low"].values[1:]).any():
        return (
            f"{of}; no interval: the surface is too short, or the error of a modulus is not stated"
        )
    return f"{of}; the interval is from measured moduli, sampling of the road and grids"


def believed_table(data: xr.Dataset, dim: str, heading: str) -> Table | None:
    """Return the best estimates along `dim` and their ratios to the first; None without any."""
    if "best_friction" not in data:
        return None
    columns = [Column(dim, [str(name) for name in data[dim].values], heading)]
    for name in reversed(SYMBOLS):
        columns.append(Column(f"best_{name}", data[f"best_{name}"].values, SYMBOLS[name]))
        columns += _interval_column(f"best_{name}", _ends(data, f"best_{name}"))
    ratio, span = data["friction_ratio"].values.copy(), _ends(data, "friction_ratio")
    ratio[0], span[0] = np.nan, np.nan
    columns.append(Column("friction_ratio", ratio, "μ over that of the first"))
    columns += _interval_column("friction_ratio", span)
    return Table(f"{dim}s-believed", columns, "Best estimates, from the direct contact")


def _interval_column(name: str, ends: np.ndarray) -> list[Column]:
    """Return the column of intervals; none where there is no interval."""
    return [Column(f"{name}_interval", ends, "90 %")] if np.isfinite(ends).any() else []


def _ends(data: xr.Dataset, name: str) -> np.ndarray:
    """Return both ends of a range along the only dimension, NaN where there are none."""
    missing = np.full(data[name].size, np.nan)
    ends = [
        data[f"{name}_{end}"].values if f"{name}_{end}" in data else missing
        for end in ("low", "high")
    ]
    return np.stack(ends, axis=1).copy()


def roads_tables(data: xr.Dataset) -> list[Table]:
    """Return best estimates, for each model totals and differences to the first, and texture."""
    models = data.model.values.tolist()
    tables = [side_by_side_totals(data.sel(model=name), "surface", "road", name) for name in models]
    if "rms_height" in data:
        tables.append(texture_table(data, "surface", "road"))
    return [
        table
        for table in (believed_table(data, "surface", "road"), *tables)
        if table is not None and len(table)
    ]


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
    ranked = "best_friction" in data
    for model in data.model.values.tolist():
        for name in others:
            part = data.sel(model=model, surface=name)
            measured = "" if ranked and model == Chain.name else "the stretches measured"
            text = difference_words(part, name, first, measured)
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
    if ranked:
        yield CHAIN_RANKS_NOTHING


def compounds_table(data: xr.Dataset) -> Table:
    """Return totals of each compound with their ranges, and differences to the first."""
    table = side_by_side_totals(data, "rubber", "compound")
    return replace(table, caption="Totals, chain") if "best_friction" in data else table


def compounds_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each compound, whether it differs from the first and what makes the difference.

    Where the direct contact ranks them, the chain says only what makes the difference.
    """
    first, *others = data.rubber.values.tolist()
    ranked = "best_friction" in data
    for i, name in enumerate(others, start=1):
        part = data.isel(rubber=i)
        text = difference_words(part, name, first, "" if ranked else "the measured moduli")
        if text:
            reasons = " and ".join(_reasons(part)) or "the model does not tell by which waves"
            yield f"{'chain: ' if ranked else ''}{text}; {reasons}."
    if ranked:
        yield CHAIN_RANKS_NOTHING


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


def ratio_cards(data: xr.Dataset, dim: str) -> Iterator[Card]:
    """Yield friction of each over that of the first, with its interval."""
    if "friction_ratio" not in data:
        return
    names = [str(name) for name in data[dim].values]
    for i, name in enumerate(names[1:], start=1):
        ratio = float(data["friction_ratio"].values[i])
        low, high = ratio_ends(data, "friction", i)
        interval = f"{significant(low)} to {significant(high)} (90 %)" if math.isfinite(low) else ""
        label = f"{SYMBOLS['friction']} of {name}"
        yield Card(label, f"× {significant(ratio)}", f"that of {names[0]}; {interval}".rstrip("; "))


def roads_page(data: xr.Dataset, findings: Sequence[Finding]) -> Page:
    """Return the page of roads side by side."""
    statistics, friction = map(image, road_pictures(data))
    sentences = [*roads_sentences(data), *str(data.attrs.get("notes", "")).splitlines()]
    tables: list[Element] = [Text(_ROADS), *roads_tables(data), *map(Text, sentences), friction]
    return Page.of(
        f"Roads side by side: {', '.join(data.surface.values.tolist())}",
        str(data.attrs.get("title", "")),
        findings,
        ratio_cards(data, "surface"),
        [
            Section("roads", "Contact and friction", tables),
            Section("statistics", "The roads", [statistics]),
            rerun_section(data.attrs),
        ],
        _basis(data, "surface"),
    )


def compounds_page(data: xr.Dataset, rubbers: Mapping[str, Rubber]) -> Page:
    """Return the page of compounds side by side: differences, then what a study has."""
    names = [str(name) for name in data.rubber.values]
    best = believed_table(data, "rubber", "compound")
    tables: list[Element] = [*filter(None, [best]), Text(_COMPOUNDS), compounds_table(data)]
    tables += map(Text, compounds_sentences(data))
    tables += map(image, compound_pictures(data, rubbers))
    curves, *inputs = study_sections(data)
    return Page.of(
        f"Compounds side by side: {', '.join(names)}",
        str(data.attrs.get("title", "")),
        study_findings(data),
        [*ratio_cards(data, "rubber"), *count_cards(data)],
        [
            Section("compounds", "Contact and friction", tables),
            *inputs,
            curves,
            method_section(),
            rerun_section(data.attrs),
        ],
        _basis(data, "rubber"),
    )


def _basis(data: xr.Dataset, dim: str) -> list[str]:
    """Return the ratios in words, where there are any."""
    lines = ratio_lines(data, dim) if "friction_ratio" in data else ()
    return [line.strip() for line in lines]
