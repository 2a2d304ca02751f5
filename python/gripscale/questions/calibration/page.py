"""The calibrated area term: its parameters, its misfit, and what it predicts of points left out.

Everything is read from the result, for the terminal and for the page alike.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from gripscale.conditions.area_term import shear_stress_to_dict
from gripscale.core.finding import sentences
from gripscale.core.units import ZERO_CELSIUS, display_unit_of
from gripscale.experiment import measured_friction
from gripscale.io.table import Column, Table, digits, fixed, least_to_most, percent, significant
from gripscale.model import input_doubts_of
from gripscale.questions.calibration.area_term_fit import AreaTermFit, Estimate
from gripscale.questions.calibration.calibration_law import LIKELIHOOD_LEVEL, PARAMETERS, written
from gripscale.report.elements import Facts
from gripscale.rubber.extrapolation import WORTH_SAYING


def calibration_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the fitted area term with its intervals, and what it does to friction."""
    values = [
        f"{e.words} = {e.text(3)} ({e.interval})"
        if e.determined
        else f"{e.words} not determined by the data"
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
        Column("value", [e.text(4) for e in fitted], words=False),
        Column("standard_error", errors, "standard error", words=False),
        Column("interval", [e.interval for e in fitted], f"{level} % by profile likelihood"),
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
    relative = data.rms_outside_in_spread.values
    if np.isfinite(relative).any():
        name = "rms_outside_in_spread"
        columns.append(Column(name, relative, "outside / spread", format=digits(2)))
    if any(data.why_not.values):
        columns.append(Column("why_not", data.why_not.values, "why not"))
    return Table("held-out", columns, "The law at points that were left out")


def law_facts(data: xr.Dataset) -> Facts:
    """Return the law, what was held and how well it fits."""
    attrs = data.attrs
    law, values = json.loads(attrs["law"]), json.loads(attrs["held"])
    held = [f"{name} = {written(x, PARAMETERS[name].unit)}" for name, x in values.items()]
    scatter = "Residuals over the spread" if attrs["spread_known"] else "Scatter of the residuals"
    pairs = [
        ("Law", str(law.get("kind", "")).replace("_", " ")),
        ("Held", ", ".join(held).replace("_", " ") or "nothing"),
        ("Measurement", str(attrs["measured_source"]).replace("\\", "/").rpartition("/")[2]),
        ("Points", str(data.sizes["measurement"])),
        ("Sum of squares", f"{float(attrs['sum_of_squares']):.3g}"),
        ("Degrees of freedom", str(attrs["degrees_of_freedom"])),
        (scatter, f"{float(attrs['scatter']):.3g}"),
    ]
    return Facts("The fit", pairs)


def residual_table(data: xr.Dataset) -> Table:
    """Return measured and predicted friction, their difference, and it over the spread.

    `data` is what `gripscale.questions.residuals` answers; its root mean squares stand below.
    """
    speeds, pressures = (display_unit_of(data.attrs, name) for name in ("speed", "pressure"))
    spread, kelvin = bool(np.isfinite(data.measured_spread).any()), data.measured_temperature.values
    points = [
        Column("speed", data.measured_speed.values, "v", speeds.unit, speeds.divisor),
        Column("temperature", kelvin, "T", "°C", zero=ZERO_CELSIUS, format=fixed(1)),
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


UNLIKELY = 0.01  # chance of the sum of squares below which something must be wrong


def notes(calibration: AreaTermFit) -> Iterator[str]:
    """Yield a sentence on each thing to know before the numbers are used."""
    if not calibration.spread_known:
        yield (
            f"No spread is stated: the scatter of the residuals, {calibration.scatter:.2g}, "
            "takes its place, whatever its cause."
        )
    elif calibration.chance < UNLIKELY:
        yield (
            f"The residuals are {calibration.scatter:.2g} times the stated spread: law, hysteresis "
            "or spread is wrong, and the intervals are too narrow."
        )
    yield (
        "The intervals hold for the spread of the measurement alone: an error of the predicted "
        "contact area is an error of the shear stress."
    )
    held = calibration.problem.held
    if calibration.law.kind == "gaussian" and held.get("activation_energy") == 0.0:
        yield (
            "No activation energy: the temperatures in the contact are only "
            f"{calibration.problem.points.temperature_range:.2g} K apart and do not determine it. "
            "The law holds at the measured temperature."
        )
    for estimate in calibration.estimates:
        ends = {"lower": estimate.low, "upper": estimate.high}
        missing = [word for word, end in ends.items() if not np.isfinite(end)]
        if len(missing) == 2:
            yield f"{estimate.name} is not determined by the data."
        elif missing:
            yield f"The {missing[0]} end of {estimate.name} is not determined by the data."
    predicted = calibration.predicted
    without = int((~predicted.has_answer).sum())
    if without:
        why = next(s for s, k in zip(predicted.status, predicted.has_answer, strict=True) if not k)
        yield f"Measured points without a prediction, which do not count: {without}, as {why}."
    below = int((calibration.problem.points.difference < 0.0).sum())
    if below:
        yield f"Measured points below the hysteresis alone: {below}."
    beyond = int((predicted.outside_band > WORTH_SAYING).sum())
    if beyond:
        yield (
            f"Points where more than {WORTH_SAYING:.0%} of the hysteresis rests on the rubber "
            f"outside its measured frequencies: {beyond}."
        )


def shear_stress_table(calibration: AreaTermFit) -> str:
    """Return the table [conditions.shear_stress] of the fitted law, with its intervals."""
    law = shear_stress_to_dict(calibration.law)
    points = law.pop("fitted_to")
    estimates = {estimate.name: estimate for estimate in calibration.estimates}
    source = Path(calibration.measured.source).name or "a measurement"
    lines = [
        f"# Fitted to {calibration.problem.points.speed.size} points of {source};",
        f"# intervals of {LIKELIHOOD_LEVEL:.0%} by profile likelihood, for this rubber on this "
        "surface.",
        "[conditions.shear_stress]",
        f'kind = "{law.pop("kind")}"',
    ]
    if calibration.law.kind == "gaussian" and law["activation_energy"] == 0.0:
        del law["activation_energy"], law["reference_temperature"]
        lines.insert(2, "# No activation energy: the law holds at the measured temperature.")
    for name, value in law.items():
        unit = PARAMETERS[name].unit
        text = written(float(value), unit)
        text = f'"{text}"' if unit else text
        about = estimates[name].interval if name in estimates else "held"
        lines.append(f"{name} = {text}  # {about}")
    if points is not None:
        if points["temperature"] is not None:
            points["temperature"] = [f"{kelvin!r} K" for kelvin in points["temperature"]]
        rows = ((key, value) for key, value in points.items() if value is not None)
        lines += [
            "# Without this table an answer has the whole error of its contact area.",
            "[conditions.shear_stress.fitted_to]",
            *(f"{key} = {json.dumps(value)}" for key, value in rows),
        ]
    return "\n".join(lines) + "\n"
