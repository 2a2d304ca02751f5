"""The calibrated area term: its parameters, its misfit, and what it predicts of points left out.

Everything is read from the result, for the terminal and for the page alike.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import xarray as xr

from gripscale.charts.draw import image
from gripscale.core.finding import Finding, Severity, sentences
from gripscale.core.units import ZERO_CELSIUS, display_unit_of
from gripscale.experiment import measured_friction
from gripscale.io.table import Column, Table, digits, fixed, least_to_most, percent, significant
from gripscale.model import input_doubts_of
from gripscale.questions.calibration.area_term_fit import Estimate
from gripscale.questions.calibration.calibration_text import PARAMETERS, estimate_interval, written
from gripscale.questions.calibration.charts import calibration_pictures
from gripscale.questions.uncertainty.page import as_elements
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Facts, Page, Section, Text
from gripscale.report.failures import Failure, explained, failures_in

_CALIBRATION = (
    "A law of the shear stress in the real contact area, fitted so that the predicted hysteresis "
    "and this area term together give the measured friction. The hysteresis is not fitted."
)


def calibration_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the fitted area term with its intervals, and what it does to friction."""
    values = [
        f"{PARAMETERS[e.name].words} = {written(e.value, e.unit, 3)} ({estimate_interval(e)})"
        if e.determined
        else f"{PARAMETERS[e.name].words} not determined by the data"
        for e in estimates(data)
    ]
    level = round(100 * data.attrs["level"])
    doubts = sentences(input_doubts_of(data))
    lead = f"none to rely on. {doubts} It would be an area term" if doubts else "area term"
    yield f"Answer: {lead} with {', '.join(values)} ({level} % intervals)."
    if not bool(data["area_term"].notnull().any()):
        return
    term, hysteresis = (least_to_most(data[name]) for name in ("area_term", "hysteresis"))
    share = float((data["area_term"] / data["friction"]).mean())
    yield (
        f"  It adds {term} to a hysteresis friction of {hysteresis}: {percent(share)} of the "
        "friction in the mean of the points."
    )
    missed, without = (
        float(np.sqrt((part**2).mean()))
        for part in (data["difference"], data["difference"] - data["area_term"])
    )
    yield (
        f"  Friction with it misses the measured friction by {significant(missed, 2)} (rms), "
        f"without it by {significant(without, 2)}."
    )


def misfit_table(data: xr.Dataset) -> Table:
    """Return the fitted friction beside the measured one, point by point."""
    names = ["hysteresis", "area_term", "friction", "difference", "difference_in_spread"]
    model = str(data.attrs.get("model", "fit"))
    table = data[[*names, *(f"measured_{name}" for name in measured_friction.MEASURED)]]
    table = table.assign({name: data[name].expand_dims(model=[model]) for name in names})
    rms = {f"rms_{n}": np.sqrt((table[n] ** 2).mean("measurement")) for n in names[3:]}
    return residual_table(table.assign(rms))


def estimates(data: xr.Dataset) -> Iterator[Estimate]:
    """Yield the fitted parameters, in the units of the law."""
    for name in data.parameter.values:
        part = data.sel(parameter=name)
        unit = str(part.unit.item())
        numbers = (float(part[key]) for key in ("estimate", "standard_error", "low", "high"))
        yield Estimate(str(name), "" if unit == "1" else unit, *numbers)


def parameter_table(data: xr.Dataset) -> Table:
    """Return value, standard error and interval of each fitted parameter."""
    fitted, level = list(estimates(data)), round(100 * data.attrs["level"])
    errors = [written(e.standard_error, e.unit, 2) if e.determined else "" for e in fitted]
    columns = [
        Column("parameter", [e.name for e in fitted]),
        Column("value", [written(e.value, e.unit, 4) for e in fitted], words=False),
        Column("standard_error", errors, "standard error", words=False),
        Column(
            "interval", [estimate_interval(e) for e in fitted], f"{level} % by profile likelihood"
        ),
    ]
    bad = [not e.determined for e in fitted]
    return Table("parameters", columns, "Parameters of the law", bad=bad)


def correlations(data: xr.Dataset) -> str:
    """Return the correlations of the estimates in a sentence, empty for a single one."""
    names = data.parameter.values.tolist()
    pairs = [
        f"{name} and {names[b]} {float(data.correlation[a, b]):+z.2f}"
        for a, name in enumerate(names)
        for b in range(a + 1, len(names))
    ]
    return f"Correlations: {', '.join(pairs)}." if pairs else ""


def held_out_table(data: xr.Dataset) -> Table:
    """Return the errors of the law at each group of points, fitted to the others."""
    by_temperature = data.attrs["held_out_by"] == "temperature"
    names = [
        f"{value - ZERO_CELSIUS:.0f} °C" if by_temperature else f"{value:g} to {10.0 * value:g} m/s"
        for value in data.left_out.values
    ]
    columns = [
        Column("left_out", names, "left out"),
        Column("points", data.points.values, format="{:.0f}".format),
        Column("rms_inside", data.rms_inside.values, "rms inside", format=digits(2)),
        Column("rms_outside", data.rms_outside.values, "rms outside", format=digits(2)),
    ]
    if np.isfinite(data.rms_outside_in_spread).any():
        relative = data.rms_outside_in_spread.values
        columns.append(
            Column("rms_outside_in_spread", relative, "outside / spread", format=digits(2))
        )
    if any(data.why_not.values):
        columns.append(Column("why_not", data.why_not.values, "why not"))
    return Table("held-out", columns, "The law at points that were left out")


def law_facts(data: xr.Dataset) -> Facts:
    """Return the law, what was held and how well it fits."""
    attrs = data.attrs
    law, values = json.loads(attrs["law"]), json.loads(attrs["held"])
    held = [f"{name} = {written(x, PARAMETERS[name].unit)}" for name, x in values.items()]
    pairs = [
        ("Law", str(law.get("kind", "")).replace("_", " ")),
        ("Held", ", ".join(held).replace("_", " ") or "nothing"),
        ("Measurement", str(attrs["measured_source"]).replace("\\", "/").rpartition("/")[2]),
        ("Points", str(data.sizes["measurement"])),
        ("Sum of squares", f"{float(attrs['sum_of_squares']):.3g}"),
        ("Degrees of freedom", str(attrs["degrees_of_freedom"])),
        ("Residuals over the spread", f"{float(attrs['scatter']):.3g}"),
    ]
    if not attrs["spread_known"]:
        pairs[-1] = ("Scatter of the residuals", f"{float(attrs['scatter']):.3g}")
    return Facts("The fit", pairs)


def calibration_failure(data: xr.Dataset) -> Failure | None:
    """Return how many measured points have no prediction and why the first; None if none."""
    failed = failures_in(data)
    if not failed:
        return None
    return Failure(
        f"{len(failed)} of {data.sizes['measurement']} measured points have no prediction; "
        f"the first: {failed[0]}",
        failed[0].word,
    )


def calibration_page(
    data: xr.Dataset, findings: Sequence[Finding], parts: Iterable[str | Table]
) -> Page:
    """Return the page of a calibration: the law, the points, and the profiles of parameters."""
    case, failed = case_title(data.attrs), calibration_failure(data)
    points, *tables = as_elements(parts)
    fit, residuals, profiles = map(image, calibration_pictures(data))
    cards = []
    for e in estimates(data):
        value, words = written(e.value, e.unit, 3), PARAMETERS[e.name].words
        cards.append(Card(words, value, "", not e.determined, f"{estimate_interval(e)} (90 %)"))
    errors = [] if failed is None else [Finding(Severity.ERROR, f"{explained(failed)}.")]
    return Page.of(
        f"{data.attrs.get('title', 'Calibration')}{f': {case}' if case else ''}",
        str(data.attrs.get("model", "")).replace("_", " "),
        [*errors, *findings],
        cards,
        [
            Section("law", "The law", [fit, law_facts(data), Text(_CALIBRATION), *tables]),
            Section("points", "Point by point", [residuals, points]),
            Section("profiles", "How well the data determine the law", [profiles]),
            rerun_section(data.attrs),
        ],
        (line.strip() for line in calibration_lines(data)),
    )


def residual_table(data: xr.Dataset) -> Table:
    """Return measured and predicted friction, their difference, and it over the spread.

    `data` is what `gripscale.questions.residuals` answers; its root mean squares stand below.
    """
    speeds, pressures = (display_unit_of(data.attrs, name) for name in ("speed", "pressure"))
    spread = bool(np.isfinite(data.measured_spread).any())
    points = [
        Column("speed", data.measured_speed.values, "v", speeds.unit, speeds.divisor),
        Column(
            "temperature",
            data.measured_temperature.values,
            "T",
            "°C",
            zero=ZERO_CELSIUS,
            format=fixed(1),
        ),
        Column("pressure", data.measured_pressure.values, "p", pressures.unit, pressures.divisor),
        Column("measured_friction", data.measured_friction.values, "μ", format=fixed(3)),
        Column("measured_spread", data.measured_spread.values, "spread", format=fixed(3)),
    ]
    points = [column for column in points if np.isfinite(column.values).any()]
    columns, notes = [column.of(column.values, group="measured") for column in points], []
    for name in data.model.values.tolist():
        model = data.sel(model=name).transpose("measurement", ...)
        group = str(name).replace("_", " ")
        parts = [
            Column("hysteresis", heading="μ hyst.", format=fixed(3)),
            Column("friction", heading="μ", format=fixed(3)),
            Column("difference", heading="Δμ", format=fixed(3, "+")),
            Column("difference_in_spread", heading="Δμ / spread", format=fixed(1, "+")),
        ]
        wanted = {"hysteresis": "area_term" in data, "difference_in_spread": spread}
        columns += [
            part.of(model[part.name].values, name=f"{name}_{part.name}", group=group)
            for part in parts
            if wanted.get(part.name, True)
        ]
        rms = f"{float(model.rms_difference):.3f}"
        if spread:
            rms += f", {float(model.rms_difference_in_spread):.1f} times the spread"
        notes.append(f"Root mean square of Δμ, {group}: {rms}.")
    return Table("residuals", columns, "Measured and predicted friction", notes, keys=len(points))
