"""What decides the friction in sentences and tables: how much of what gives how much more."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from gripscale.core.finding import Finding, Severity
from gripscale.core.units import display_unit_of
from gripscale.io.table import Column, Table, digits, fixed, least_to_most, on_page, percent
from gripscale.model import STATUS
from gripscale.questions.chain.view import CONVERGED_WORD, SYMBOLS
from gripscale.questions.sensitivity.charts import height_charts, sensitivity_charts
from gripscale.questions.sensitivity.friction_sensitivity import (
    CARRIED,
    FEEDBACK,
    LOSS,
    RULE_FREQUENCY,
    STORAGE,
)
from gripscale.questions.uncertainty.first_order import CARRIED_QUANTITIES
from gripscale.questions.uncertainty.page import as_elements, not_stated
from gripscale.questions.vary.axis import points
from gripscale.report.again import case_name, rerun_section
from gripscale.report.elements import Card, Page, Section, Text
from gripscale.report.failures import Failure, explained, first_of

SCALARS = {
    "ln_pressure": ("pressure", "1"),
    "ln_speed": ("speed", "1"),
    "ln_cut_off": ("cut-off", "1"),
    "ln_bulk_modulus": ("bulk modulus", "1"),
    "temperature": ("temperature", "1/K"),
}
"""Ends of the names of derivatives by one number, with their headings and units."""
_MOST_POINTS = 6
"""Points that the table by decade has columns for."""
_CURVES = (
    "Per cent of friction for a per cent of a modulus, by frequency. The direct contact of the "
    "measured surface is solved once; one adjoint solution gives all derivatives. Factors on the "
    "friction, such as that from lines to a surface, do not change them."
)
signed = fixed(2, "+")


def sensitivity_parts(data: xr.Dataset) -> Iterator[str | Table]:
    """Yield the sums, what each decade is worth, and the rules of thumb; nothing if none."""
    if STORAGE not in data:
        return
    yield sums_table(data)
    if _has_feedback(data):
        yield feedback_table(data)
    yield decades_table(data)
    if CARRIED.format("friction") in data:
        yield carried_table(data)
    yield from rule_lines(data)


def sensitivity_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what more loss and less stiffness give, and where on the master curve that is."""
    if STORAGE not in data:
        reasons = sorted({each.sentence for each in sensitivity_failures(data)})
        yield f"Answer: none. No contact was solved: {'; '.join(reasons)}"
        return
    loss, storage = (data[name].sum("frequency") for name in (LOSS, STORAGE))
    load = [
        display_unit_of(data.attrs, name).text(float(data[f"nominal_{name}"].values.flat[0]))
        for name in ("pressure", "speed")
        if f"nominal_{name}" in data and np.ptp(data[f"nominal_{name}"].values) == 0.0
    ]
    where = f", at {' and '.join(load)}" if load else ""
    yield (
        f"Answer: 1 % more E'' at all frequencies gives {least_to_most(loss, digits(2))} % more "
        f"friction, 1 % less E' {least_to_most(-storage, digits(2))} %{where}"
    )
    for text, each in points(data):
        if np.isfinite(each[LOSS].values).all():
            low, high = _middle_half(each)
            where = f" at {text}" if data[LOSS].size > data.sizes["frequency"] else ""
            yield f"  half of the effect of E''{where} is between {low:.2g} and {high:.2g} rad/s"


def sensitivity_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield what E'' and E' at all frequencies are worth."""
    for name, symbol in ((LOSS, "E''"), (STORAGE, "E'")):
        if name in data:
            value = least_to_most(data[name].sum("frequency"), digits(2))
            yield Card(
                f"1 % more {symbol}", on_page(f"{value} %"), "of friction, at all frequencies"
            )


def _middle_half(point: xr.Dataset) -> tuple[float, float]:
    """Return the frequencies between which the middle half of the effect of E'' lies [rad/s]."""
    effect = np.maximum(point[LOSS].values, 0.0)
    within = (np.cumsum(effect) - 0.5 * effect) / effect.sum()
    log = np.interp([0.25, 0.75], within, np.log(point.frequency.values))
    return float(np.exp(log[0])), float(np.exp(log[1]))


def sums_table(data: xr.Dataset) -> Table:
    """Return the derivatives by each input at each point, the moduli summed over frequency."""
    listed = list(points(data))
    moduli = [
        Column(key, [float(each[name].sum()) for _, each in listed], symbol, format=signed)
        for key, name, symbol in (("loss", LOSS, "E''"), ("storage", STORAGE, "E'"))
    ]
    columns = [_points_column(listed), *moduli, *_scalar_columns(data, "")]
    notes = ["Per cent of friction for a per cent of the input; of temperature, for a kelvin."]
    if data.attrs["iterated"] and not _has_feedback(data):
        notes.append(
            "Strain and temperature of the rubber are kept; --with-feedback also lets them follow."
        )
    return Table("sums", columns, "What the friction depends on", notes, keys=1)


def feedback_table(data: xr.Dataset) -> Table:
    """Return the derivatives with the answer of softening and heat."""
    columns = [_points_column(list(points(data))), *_scalar_columns(data, FEEDBACK)]
    title = "The same where strain and temperature of the rubber follow the change"
    return Table("feedback", columns, title, keys=1)


def _points_column(listed: Sequence[tuple[str, xr.Dataset]]) -> Column:
    return Column("point", [text for text, _ in listed], "")


def _scalar_columns(data: xr.Dataset, end: str) -> Iterator[Column]:
    """Yield the derivatives by single numbers that are known, with an end of their names."""
    for name, (heading, unit) in SCALARS.items():
        variable = f"d_ln_friction_d_{name}{end}"
        if variable in data and np.isfinite(data[variable].values).any():
            values = [float(each[variable]) for _, each in points(data)]
            size, unit_text = (0.01, "%/K") if unit == "1/K" else (1.0, "")
            yield Column(f"{name}{end}", values, heading, unit_text, size, format=signed)


def _has_feedback(data: xr.Dataset) -> bool:
    return any(str(name).endswith(FEEDBACK) for name in data)


def decades_table(data: xr.Dataset) -> Table:
    """Return what E'' and E' of each decade of frequency are worth, at the first few points."""
    decade = np.floor(np.log10(data.frequency.values) + 1e-9).astype(int)
    rows = np.arange(decade.min(), decade.max() + 1)
    listed = list(points(data))
    chosen = np.unique(np.linspace(0, len(listed) - 1, min(_MOST_POINTS, len(listed))).astype(int))
    columns = [Column("decade", [f"1e{row} to 1e{row + 1}" for row in rows], "rad/s")]
    for i in chosen:
        text, each = listed[i]
        for name, symbol in ((LOSS, "E''"), (STORAGE, "E'")):
            values = [float(each[name].values[decade == row].sum()) for row in rows]
            columns.append(
                Column(
                    f"{name}_{i}", values, symbol, text if len(listed) > 1 else "", format=signed
                )
            )
    notes = []
    if chosen.size < len(listed):
        notes.append(f"{chosen.size} of {len(listed)} points; the others are in the result file.")
    return Table("decades", columns, "What each decade of the master curve is worth", notes, keys=1)


def carried_table(data: xr.Dataset) -> Table:
    """Return what is not known of the inputs, and what it carries to the results, most first."""
    errors = {name: data[CARRIED.format(name)].values for name in CARRIED_QUANTITIES}
    ranked = np.argsort(-np.nan_to_num(errors["friction"]), kind="stable")
    ranked = ranked[np.isfinite(errors["friction"][ranked])]
    columns = [Column("source", [*data.label.values[ranked].tolist(), "together"], "not known")]
    for name, error in errors.items():
        values = [*error[ranked].tolist(), float(np.sqrt(np.sum(error[ranked] ** 2)))]
        columns.append(Column(f"{name}_error", values, f"± of {SYMBOLS[name]}", format=percent))
    notes = ["Standard errors, to first order; `gripscale uncertainty` samples them."]
    if missing := not_stated(data):
        notes.append(f"Not included, as the case states no standard error: {', '.join(missing)}.")
    return Table("carried", columns, "Effect of the errors of the inputs", notes, keys=1)


def rule_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what the rules of thumb look at, and how much of the effect is there."""
    if "rule" not in data.dims:
        yield (
            "The rubber has no temperature shift: tan δ at 0 °C and 60 °C has no known place on "
            "this axis."
        )
        return
    for i, name in enumerate(data.rule.values):
        share, at = data.rule_share.isel(rule=i), float(data.rule_frequency[i])
        shares = least_to_most(share, percent)
        yield (
            f"The rule of thumb for {name} takes tan δ at {at:.2g} rad/s ({RULE_FREQUENCY:g} Hz, "
            f"shifted); {shares} of the effect of E'' lies within half a decade of it."
        )


def sensitivity_failures(data: xr.Dataset) -> list[Failure]:
    """Return each point without a solution."""
    words = data[f"{STATUS}_word"].values.ravel()
    endings = [
        Failure(str(sentence), str(word))
        for sentence, word in zip(data[STATUS].values.ravel(), words, strict=True)
    ]
    return [ending for ending in endings if ending.sentence != CONVERGED_WORD]


def failure_sentence(data: xr.Dataset) -> str:
    """Return how many points have no solution, with what to do about the first; empty if none."""
    return first_of(sensitivity_failures(data), data[STATUS].size, "points")


def sensitivity_page(data: xr.Dataset, record: xr.Dataset, findings: Sequence[Finding]) -> Page:
    """Return the page of what decides the friction; `record` is that of the inputs."""
    lead, *below = sensitivity_lines(data)
    solved = STORAGE in data
    charts = sensitivity_charts(data) if solved else []
    return Page.of(
        f"What decides the friction of {case_name(data.attrs) or 'a case'}",
        str(lead),
        [
            *(Finding(Severity.ERROR, explained(each)) for each in sensitivity_failures(data)),
            *findings,
        ],
        sensitivity_cards(data),
        [
            Section(
                "effects",
                "What the friction depends on",
                as_elements([*below, *sensitivity_parts(data)]),
            ),
            Section("curves", "Over the master curve", [Text(_CURVES), *charts]),
            Section("heights", "Which heights count", height_charts(data, record)),
            rerun_section(data.attrs),
        ],
    )
