"""Braking force over slip: the friction of a case in the contact patch of a tread.

result = slip_curve(case, speed="80 km/h", temperature=["0 C", "20 C"])
result.data.force

The tread is a brush (`examples.slip_curve.brush`) on the footprint and under the pressure of the
case. It has no carcass, no pattern and no water: a slip curve shows what friction over speed,
pressure and temperature does to braking, and is no prediction of a tyre.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from examples.slip_curve.brush import Brush, brush_force
from examples.slip_curve.friction_table import (
    BOUNDS,
    FORMULAS,
    MISFIT,
    TABLE,
    TableFriction,
    fitted_formulas,
    friction_table,
)
from gripscale.case import Case
from gripscale.charts import style
from gripscale.charts.chart import Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import WIDE
from gripscale.core import Array, Finding, InputError, Severity, Topic, checks
from gripscale.core.units import ZERO_CELSIUS, celsius, in_mm, si_value
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Column, Table, significant
from gripscale.questions.answer.variables import AnswerNumber
from gripscale.questions.inputs import record
from gripscale.questions.registry import QUESTIONS
from gripscale.questions.result import Result
from gripscale.questions.vary.axis import axes_of

KINDS = {"slip": ":SlipCurve"}
QUESTIONS.append(__name__)  # `gripscale.load` knows its results
# Of a bristle [Pa/m]: on 100 mm under 3 bar a slip stiffness of 25 loads; tyres have 15 to 30.
STIFFNESS = 1.5e8
_SLIPS = np.geomspace(0.003, 1.0, 30)
_BRAKING = "80 km/h", "20 km/h"  # speeds of wet braking tests of tyres (UN Regulation 117)
_BRAKING_SPEEDS = 5  # points of Gauss's quadrature over the speeds of braking
_GRAVITY = 9.80665
_FINE = 1000  # slips at which a peak is sought
BRAKES = ("peak", "locked")  # an ideal control that holds the peak, and locked wheels
_NO_TYRE = (
    "A brush of bristles is no tyre: it has no carcass, pattern, wear or water. Compare compounds, "
    "roads and temperatures with it, not tyres."
)


class SlipCurve(Result):
    """Braking force over slip of a case, with its peak, its locked value and braking distances."""

    kind = "slip"

    @property
    def lines(self) -> Sequence[str]:
        data, kind = self.data, self.data.kind.values[-1]
        first = data.sel(kind=kind).isel(temperature=0, speed=0)
        peak = _number(first.peak)
        at = float(first.peak_slip.sel(bound="value"))
        locked = float(first.locked.sel(bound="value"))
        speed = f"{3.6 * float(first.speed):.3g} km/h"
        warm = float(first.temperature)
        where = f"{speed} and {celsius(warm)}" if math.isfinite(warm) else speed
        distance = _number(first.braking_distance.sel(brake="peak"))
        level = " (90 % intervals)" if peak.interval else "; no interval: the surface is too short"
        return [
            f"Answer: peak braking force {peak} of the load at {100.0 * at:.3g} % slip, locked "
            f"{significant(locked)}, at {where}{level}.",
            f"  Friction: {kind}; contact patch {in_mm(data.attrs['length'], 3)}, bristles "
            f"{data.attrs['stiffness']:.3g} Pa/m.",
            f"  Braking from {self._braking} at the peak: {distance} m.",
        ]

    @property
    def findings(self) -> Sequence[Finding]:
        room = float(self.data.rubber_temperature.max() - self.data.temperature.max())
        warm = self.data.slip.where(self.data.warming > room)
        text = ""
        if "effusivity" not in self.data.attrs:
            text = (
                "The rubber does not warm in the patch: the case states no thermal properties in "
                "[conditions.heat]."
            )
        elif bool(warm.notnull().any()):
            text = (
                f"From {float(warm.min()):.1%} slip on sliding rubber warms by more than the "
                f"{room:.0f} K for which friction was solved; it then has the last friction."
            )
        findings = [Finding(Severity.WARNING, _NO_TYRE, topic=Topic.LOAD)]
        findings += [Finding(Severity.WARNING, text, topic=Topic.RUBBER)] if text else []
        return (*findings, *super().findings)

    def parts(self) -> Iterator[str | Table]:
        yield self.table()

    def table(self) -> Table:
        """Return peak, braking distances and formulas of vehicle models of each curve."""
        temperature = self.data.temperature.fillna(0.0)
        data = self.data.drop_vars(TABLE).assign_coords(temperature=temperature)
        rows = data.stack(row=("kind", "temperature", "speed"))
        kelvin = np.where(rows.temperature > 0.0, rows.temperature, np.nan)
        value, ends = rows.sel(bound="value"), rows.peak.sel(bound=["low", "high"])
        columns = [
            Column("friction", rows.kind.values.tolist()),
            Column("temperature", kelvin - ZERO_CELSIUS, "T", "°C"),
            Column("speed", rows.speed.values, "v", "km/h", 1.0 / 3.6),
            Column("peak", value.peak.values, "peak"),
            Column("peak_interval", ends.transpose("row", ...).values, "90 %"),
            Column("peak_slip", value.peak_slip.values, "at slip", "%", 0.01),
            Column("locked", value.locked.values, "locked"),
        ]
        for brake in BRAKES:
            distance = value.braking_distance.sel(brake=brake).values
            columns.append(Column(f"distance_{brake}", distance, brake, "m"))
        notes = [f"Forces over the load; distances from {self._braking}, at the peak or locked."]
        for name, formula in FORMULAS.items():
            words = name.replace("_", " ").capitalize()
            notes.append(f"{words}: {formula.text}; rms over the peak.")
            for parameter in self.data[f"{name}_parameter"].values:
                values = rows[name].sel({f"{name}_parameter": parameter}).values
                as_percent = ("%", 0.01) if parameter == MISFIT else ()
                column = Column(f"{name}_{parameter}", values, parameter, *as_percent)
                columns.append(column.of(values, group=words))
        return Table("slip", columns, "Braking", notes, keys=3)

    @property
    def _braking(self) -> str:
        """From which speed to which the distances go."""
        fast, slow = (f"{3.6 * v:.3g}" for v in self.data.attrs["braking"])
        return f"{fast} to {slow} km/h"

    def pictures(self) -> Iterator[Picture]:
        yield Picture(
            "slip",
            slip_sheet(self.data).on_paper(),
            "Braking force over slip. Bands: 90 % interval of the friction.",
            "Braking force over load against slip.",
        )


def _number(values: xr.DataArray) -> AnswerNumber:
    """Return a number over `bound` with the ends of its interval."""
    low, value, high = (float(values.sel(bound=bound)) for bound in BOUNDS)
    return AnswerNumber(value, low, high)


def slip_sheet(data: xr.Dataset) -> Sheet:
    """Describe the braking force over slip, a panel for each kind of friction."""
    highest = 1.08 * float(data.force.max())
    each = [*product(range(data.sizes["temperature"]), range(data.sizes["speed"]))]
    colours = style.colours(len(each), ordered=len(each) > 1)
    slip = np.concatenate([[0.0], 100.0 * data.slip.values])
    panels = []
    for kind in data.kind.values:
        bands: list[Mark] = []
        curves: list[Mark] = []
        for (i, j), colour in zip(each, colours, strict=True):
            curve = data.sel(kind=kind).isel(temperature=i, speed=j)
            low, value, high = (np.concatenate([[0.0], row]) for row in curve.force.values)
            kelvin = float(curve.temperature)
            words = [celsius(kelvin)] if math.isfinite(kelvin) else []
            if data.sizes["speed"] > 1 or not words:
                words.append(f"{3.6 * float(curve.speed):.3g} km/h")
            bands.append(ShadedBand(slip, low, high, colour))
            curves.append(Series(slip, value, colour, ", ".join(words)))
        x = PlotAxis("slip [%]", low=0.0, high=100.0)
        y = PlotAxis("braking force over load [-]", low=0.0, high=highest)
        panels.append(Panel(x, y, [*bands, *curves], title=str(kind)))
    return Sheet(panels, len(panels), WIDE, 3.6, legend_columns=4, layout={"sharey": True})


def slip_curve(
    case: Case,
    *,
    slip: ArrayLike | None = None,
    speed: Any = "80 km/h",
    temperature: Any = None,
    braking: Sequence[float | str] = _BRAKING,
    stiffness: float = STIFFNESS,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> SlipCurve:
    """Return the braking force of a tread over slip.

    Parameters
    ----------
    case : Case
        Its footprint is the length of the contact patch, its pressure the mean one there. Its
        surface must be measured. With an area term there are curves with and without it.
    slip : array_like, optional
        s = 1 - (speed of the tread)/(speed of the road), above 0 and up to 1; 30 by default.
    speed : float, str or list
        Speeds of the road [m/s], or texts such as "80 km/h".
    temperature : str, float or list, optional
        Temperatures of the rubber before the patch [K], or texts such as "20 C"; that of the case
        by default. Others need a rubber with a shift.
    braking : pair
        Speeds [m/s] from which and to which the braking distance goes.
    stiffness : float
        Shear stress of a bristle over its deflection [Pa/m].
    folder : path, optional
        Keeps the friction as soon as it is there: what was interrupted resumes.
    workers, on_task
        As for `gripscale.experiment.Bench`.

    Returns
    -------
    SlipCurve
        `force` over `kind` of friction, `bound` of the 90 % interval, `temperature`, `speed` and
        `slip`; `peak`, `peak_slip`, `locked` and `braking_distance` [m]; the largest temperature
        rise `warming` [K]; the parameters `burckhardt` and `magic_formula`, and the friction they
        rest on, `table_friction`.

    Raises
    ------
    InputError, FileError
        For what cannot be used; if a contact has no result.
    """
    slips = _SLIPS if slip is None else checks.increasing_vector("slip", slip)
    if slips.size < 5 or slips[-1] > 1.0:
        raise InputError(
            f"slip must have at least 5 rising values up to 1; got {checks.short_repr(slip)}"
        )
    speeds = _values("speed", speed)
    fast, slow = (si_value("braking", value, "m/s") for value in braking)
    if not fast > slow >= 0.0 or min(speeds) <= 0.0:
        raise InputError(
            "speed must be above zero and braking from a higher to a lower speed; got "
            f"{min(speeds):g} m/s and {fast:g} to {slow:g} m/s"
        )
    heat = None if case.conditions is None else case.conditions.heat
    effusivity = None if heat is None else heat.effusivity
    brush = Brush(case.load.footprint, case.load.pressure, stiffness, effusivity)
    kelvins = [] if temperature is None else _values("temperature", temperature)
    if temperature is None and case.rubber.shift is not None:
        kelvins = [case.rubber_before.reference_temperature or math.nan]
    with bench_in(folder, workers, None, on_task) as bench:
        table = friction_table(case, kelvins, max(*speeds, fast), bench)
    data = _curves(brush, table, np.array(kelvins or [math.nan]), speeds, slips, (fast, slow))
    attrs: dict[str, Any] = {
        "title": "Braking force over slip",
        "length": brush.length,
        "mean_pressure": brush.pressure,
        "stiffness": brush.stiffness,
        "braking": [fast, slow],
        **({} if effusivity is None else {"effusivity": effusivity}),
    }
    return SlipCurve(data.assign_attrs(case.attributes, **attrs), record.inputs(case))


def _values(name: str, value: Any) -> list[float]:
    return [float(number) for number in axes_of({name: value})[0].values]


def _curves(
    brush: Brush,
    table: xr.Dataset,
    kelvins: Array,
    speeds: Sequence[float],
    slips: Array,
    braking: tuple[float, float],
) -> xr.Dataset:
    """Return the curves of a table of friction, their peaks, distances and formulas."""
    friction = TableFriction(table[TABLE], np.nan_to_num(kelvins))
    nodes, weights = np.polynomial.legendre.leggauss(_BRAKING_SPEEDS)
    fast, slow = braking
    on_the_way = 0.5 * (fast + slow) + 0.5 * (fast - slow) * nodes
    every = np.concatenate([np.array(speeds), on_the_way])
    solved = brush_force(brush, friction, slips, every[:, None])
    force = solved.force.reshape(*friction.rows, every.size, slips.size)
    peak, peak_slip = peaks(slips, force)
    dims = ("kind", "bound", "temperature", "speed")
    count = len(speeds)
    held = np.stack([peak, force[..., -1]])[..., count:]
    distance = (weights * on_the_way / held).sum(-1) * 0.5 * (fast - slow) / _GRAVITY
    warming = np.broadcast_to(solved.warming, solved.force.shape).reshape(force.shape)
    data = xr.Dataset(
        {
            "force": ((*dims, "slip"), force[..., :count, :], {"units": "1"}),
            "warming": ((*dims, "slip"), warming[..., :count, :], {"units": "K"}),
            "peak": (dims, peak[..., :count], {"units": "1"}),
            "peak_slip": (dims, peak_slip[..., :count], {"units": "1"}),
            "locked": (dims, force[..., :count, -1], {"units": "1"}),
            # the higher the friction, the shorter
            "braking_distance": (("brake", *dims[:3]), distance[:, :, ::-1], {"units": "m"}),
        },
        {"temperature": kelvins, "speed": list(speeds), "slip": slips, "brake": list(BRAKES)},
    ).assign_coords(table[["kind", "bound"]].coords)
    formulas = fitted_formulas(data.force.sel(bound="value", drop=True))
    return data.merge(table).assign(formulas)


def peaks(slips: Array, force: Array) -> tuple[Array, Array]:
    """Return the largest forces and their slips, by cubics through the curves over ln s."""
    from scipy.interpolate import CubicSpline  # slow to import

    fine = np.geomspace(slips[0], slips[-1], _FINE)
    curves = CubicSpline(np.log(slips), np.nan_to_num(force), axis=-1)(np.log(fine))
    unknown = np.isnan(force).any(-1)  # an end without an interval
    best = fine[np.argmax(curves, axis=-1)]
    return np.where(unknown, np.nan, curves.max(-1)), np.where(unknown, np.nan, best)
