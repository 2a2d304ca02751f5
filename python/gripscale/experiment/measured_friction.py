"""Friction measured elsewhere, to be drawn over what the models say: a table of speed and friction.

A text or Excel file with columns named speed and friction, and if known spread (of the friction),
temperature and pressure. Units stand in the titles, as in `speed [mm/s]` or `temperature (C)`;
without one speeds are in m/s and pressures in Pa, while temperatures must have theirs. Otherwise
the rules of `gripscale.io.text_table` hold.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import ClassVar, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gripscale.conditions.area_term import InterfacialShearStress
from gripscale.core import Array, Checked, Finding, Topic, Vector, checked, checks, doubt, labelled
from gripscale.core.errors import FileError, about_file
from gripscale.core.units import (
    UNITS,
    ZERO_CELSIUS,
    display_unit_of,
    listed,
    plain,
    quantity_in_si,
    spelled,
)
from gripscale.io.text_table import ColumnTitle, file_path, read_table
from gripscale.model import PLAUSIBLE

# What the titles of the columns may be called, in small letters; the first word is ours.
_WORDS = {
    "speed": r"speed|velocity|v|(sliding|slip|test|rubbing|sled) (speed|velocity)|geschwindigkeit"
    r"|gleitgeschwindigkeit|vitesse( de glissement)?|velocidad|velocit(à|a)|滑动速度|速度",
    "friction": r"friction|(friction )?coefficient( of friction)?|mu|µ|μ|cof|µ ?k|μ ?k"
    r"|(mean|measured|dry|wet|kinetic|dynamic|sliding) (friction|cof|mu|µ|μ)( coefficient)?"
    r"|reibwert|reibbeiwert|reibungs(koeffizient|zahl|beiwert)|coefficient de frottement"
    r"|coeficiente de (fricci(ó|o)n|rozamiento)|coefficiente di attrito|摩擦系数|摩擦係数",
    "spread": r"spread|std|sd|standard deviation|standardabweichung|uncertainty|error"
    r"|(é|e)cart.type",
    "temperature": r"temperature|temp|t|temperatur|temp(é|e)rature|temperatura|温度",
    "pressure": r"pressure|(nominal|contact) pressure|p|druck|pression|presi(ó|o)n|pressione|压力",
}

# Unit of a column, of the kind it is called by, where the title names none, if that is clear.
_UNITS = {"speed": "m/s", "temperature": None, "pressure": "Pa"}

# Columns that may be absent, and where values may be missing, with their units.
_OPTIONAL = {"spread": "", "temperature": "K", "pressure": "Pa"}
# Largest absolute values [-], [K], [Pa]: beyond any rubber's, below what marks missing ones.
_MOST = {"friction": 100.0, "spread": 100.0, "temperature": 3000.0, "pressure": 1e11}
_RATIO = ("1", "-", "–")  # units of what has none


def _column(name: str, array: ArrayLike) -> Array:
    """Return a column; raise `InputError` if a value is out of its range."""
    unit = _OPTIONAL.get(name, "")
    values = checks.vector(name, array, unit=unit, missing=name in _OPTIONAL)
    most = f"{name} must be at most {_MOST[name]:g}, missing values nan or an empty cell"
    checks.refuse_entries(values, np.abs(values) > _MOST[name], most)
    if name == "spread":
        checks.refuse_entries(values, values < 0.0, f"{name} must not be negative")
    elif name in _OPTIONAL:
        checks.refuse_entries(values, values <= 0.0, f"{name} must be above zero [{unit}]")
    return values


class MeasuredFriction(Checked, eq=False):
    """Measured friction coefficients over sliding speed, in the order they were given in.

    Raises `InputError` if the lengths differ or a value is out of its range.

    Parameters
    ----------
    speed : array_like, shape (n,)
        Sliding speeds [m/s], above zero, in any order.
    friction : array_like, shape (n,)
        Friction coefficients [-].
    spread : array_like, shape (n,), optional
        Standard deviations of the friction coefficients [-]; NaN where unknown, as by default.
    temperature : array_like, shape (n,), optional
        Temperatures of the rubber [K]; NaN where unknown, as by default.
    pressure : array_like, shape (n,), optional
        Nominal pressures [Pa]; NaN where unknown, as by default.
    source : str
        Where they come from.
    assumed : str
        What was assumed of them because the source does not state it, in sentences.
    """

    speed: Vector = checked(checks.positive_vector, unit="m/s", repr=False)
    friction: Vector = checked(_column, repr=False)
    spread: Vector = checked(_column, default=None, repr=False)
    temperature: Vector = checked(_column, default=None, repr=False)
    source: str = ""
    _: KW_ONLY
    pressure: Vector = checked(_column, default=None, repr=False)
    assumed: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = {name: getattr(self, name) for name in _WORDS}
        for name in _OPTIONAL:
            if columns[name] is None:
                columns[name] = np.full(self.speed.size, np.nan)
        checks.same_length(1, **columns)
        self._set(**columns)

    def middle(self, column: str) -> float | None:
        """Return the middle one of the values of a column; None where none is known."""
        rising = np.sort(getattr(self, column))  # nan last
        count = int(np.isfinite(rising).sum())
        return float(rising[count // 2]) if count else None


def read_measured_friction(path: str | Path, *, sheet: str | int | None = None) -> MeasuredFriction:
    """Read measured friction from a text, CSV or Excel (.xlsx) file, in the order of its rows.

    `sheet` is the name of the Excel sheet or its number from 1, where several hold numbers. Raises
    `FileError` if the file is missing or unreadable, a column is missing or named twice, or a unit
    or a value cannot be used; `InputError` if `sheet` is missing or none of the file.
    """
    path = file_path(path)
    table = read_table(
        path,
        "rows of speed and friction, with titles above them",
        kinds=tuple(_UNITS),
        named=lambda title: _word(title) is not None,
        sheet=sheet,
    )
    columns: dict[str, Array] = {}
    assumed: list[str] = []
    for at, column in enumerate(table.columns):
        word = _word(column.name)
        if word in columns:
            raise FileError(f"{path}: expected one column of {word}; got two")
        if word is not None:
            values = table.numbers(at, f"a {word}", missing=word in _OPTIONAL)
            columns[word] = _in_si(path, word, column, values)
            if word in _UNITS and column.unit is None:
                assumed.append(
                    f"The unit of {word} in {path.name} is not stated and {_UNITS[word]} is "
                    f"assumed: write it in the title, such as '{word} [{list(UNITS[word])[1]}]'."
                )
    for word in ("speed", "friction"):
        if word not in columns:
            titles = table.titles or "no titles"
            text = f"{path}: expected a column named {word}; got {titles}"
            raise FileError(text, missing=word)
    with about_file(path):
        return MeasuredFriction(**columns, source=str(path), assumed=" ".join(assumed))


def _word(title: str) -> str | None:
    """Return which of our columns a title names, or None."""
    plain = " ".join(title.lower().replace("_", " ").replace(".", " ").split())
    return next((word for word, names in _WORDS.items() if re.fullmatch(names, plain)), None)


_FAR = 30.0  # ratio of measured speeds to that of the case beyond which another unit is likely


def speed_doubts(measured: MeasuredFriction, speed: float) -> list[Finding]:
    """Return that the unit of measured speeds looks wrong beside a `speed` [m/s].

    Empty if it does not; at rest any speeds up to the largest plausible one are right.
    """
    low, high = float(measured.speed.min()), float(measured.speed.max())
    most = PLAUSIBLE["speed"][1]
    if high > most:
        odd = f"not all below {most:g} m/s"
    elif speed > 0.0 and (low > _FAR * speed or high < speed / _FAR):
        side = "above" if low > speed else "below"
        odd = f"all more than {_FAR:g} times {side} that of the case, {plain(speed, 3)} m/s"
    else:
        return []
    measured_speeds = f"The measured speeds, {plain(low, 3)} to {plain(high, 3)} m/s,"
    return [_doubt(f"{measured_speeds} are {odd}: is their unit right?")]


def _doubt(sentence: str) -> Finding:
    return doubt(sentence, topic=Topic.SOLUTION)


# Attribute of a result that shows measured friction: its `friction_doubts`.
FRICTION_DOUBTS = "friction_doubts"


def friction_doubts(measured: MeasuredFriction | None, speed: float) -> list[Finding]:
    """Return what was assumed of measured friction, and `speed_doubts`; nothing of none."""
    if measured is None:
        return []
    return [*map(_doubt, filter(None, [measured.assumed])), *speed_doubts(measured, speed)]


def _in_si(path: Path, word: str, column: ColumnTitle, values: Array) -> Array:
    if word not in _UNITS:
        if column.unit not in (None, *_RATIO):
            raise FileError(
                f"{path}: {word} has no unit; got {checks.short_repr(column.unit)} in its title"
            )
        return values
    unit = column.unit or _UNITS[word]
    if unit is None:
        raise FileError(
            f"{path}: {word} must have its unit in its title ({listed(word)}), such as "
            f"'{word} [C]'; got '{column.name}'",
            missing=word,
        )
    if spelled(unit, word) is None:
        raise FileError(
            f"{path}: {word} must be in one of {listed(word)}; got {checks.short_repr(unit)}"
        )
    return quantity_in_si(values, unit, word)


@dataclass(frozen=True)
class TemperatureProbe:
    """A shear stress of 1 Pa for each kelvin; none where the temperature is not known.

    With tau_f = s T, s = 1 Pa/K, the area term mu = s T A_r/(A_0 p) of an answer tells the mean
    temperature over the real contact area. Laws are fitted to answers made with it: an answer then
    does not depend on the law, and serves all of them; but for the heat of the interface.
    """

    kind: ClassVar[str] = "temperature_probe"

    warming_law: InterfacialShearStress | None = None
    """Law whose friction warms the interface; None: the interface loses nothing."""

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return T in K as a stress [Pa], shape of the speeds [m/s] and temperatures [K]."""
        kelvin = 0.0 if temperature is None else np.asarray(temperature, dtype=float)
        return np.asarray(np.zeros(np.shape(speed)) + kelvin)


# Columns of a measurement as result files hold them, with unit and meaning.
MEASURED = {
    "speed": ("m/s", "speed of the measurement"),
    "friction": ("1", "measured friction coefficient"),
    "spread": ("1", "its standard deviation"),
    "temperature": ("K", "temperature of the rubber before the contact"),
    "pressure": ("Pa", "nominal pressure"),
}


def measured_variables(measured: MeasuredFriction) -> dict[str, xr.Variable]:
    """Return the columns of a measurement as variables over `measurement`."""
    columns = {}
    for name, (unit, text) in MEASURED.items():
        values = getattr(measured, name)
        columns[f"measured_{name}"] = labelled("measurement", values, unit, text, measured.source)
    if measured.assumed:
        columns["measured_friction"].attrs["assumed"] = measured.assumed
    return columns


class MeasuredSeries(NamedTuple):
    """Measured friction at one temperature and pressure over rising speed [m/s]."""

    state: str  # temperature, and pressure if there are several; empty if unknown
    temperature: float  # [K]; NaN if unknown
    speed: Array
    friction: Array
    spread: Array
    # Their places among the points of the measurement, which are in any order.
    rows: NDArray[np.intp]

    @property
    def label(self) -> str:
        """What figures and tables call it."""
        return f"measured, {self.state}" if self.state else "measured"

    def at(self, speed: float) -> tuple[float, float] | None:
        """Return friction and spread at `speed`, interpolated in its logarithm; None outside."""
        if not self.speed[0] <= speed <= self.speed[-1]:
            return None
        at, speeds = math.log(speed), np.log(self.speed)
        friction, spread = (np.interp(at, speeds, row) for row in (self.friction, self.spread))
        return float(friction), float(spread)


def measured_series(data: xr.Dataset) -> Iterator[MeasuredSeries]:
    """Yield what was measured at each temperature, to the kelvin, and each pressure."""
    if "measured_friction" not in data:
        return
    kelvin = np.round(data.measured_temperature.values)
    pascal = data.measured_pressure.values
    several = np.unique(pascal).size > 1
    by_speed = np.argsort(data.measured_speed.values, kind="stable")
    pressure_unit = display_unit_of(data.attrs, "pressure")
    for temperature in np.unique(kelvin):
        for pressure in np.unique(pascal):
            here = np.isclose(kelvin, temperature, equal_nan=True)
            here &= np.isclose(pascal, pressure, rtol=0.0, atol=0.0, equal_nan=True)
            if not here.any():
                continue
            rows = by_speed[here[by_speed]]
            words = []
            if not math.isnan(temperature):
                words.append(f"{temperature - ZERO_CELSIUS:.0f} °C")
            if several and not math.isnan(pressure):
                words.append(pressure_unit.text(float(pressure), 3))
            names, state = ("speed", "friction", "spread"), ", ".join(words)
            speed, friction, spread = (data[f"measured_{name}"].values[rows] for name in names)
            yield MeasuredSeries(state, float(temperature), speed, friction, spread, rows)


def nearest_series(measured: MeasuredFriction, temperature: float | None) -> MeasuredSeries:
    """Return what was measured nearest to a temperature [K]; the first without one."""
    series = list(measured_series(xr.Dataset(measured_variables(measured))))
    if temperature is None:
        return series[0]
    away = [np.nan_to_num(abs(part.temperature - temperature), nan=0.0) for part in series]
    return series[int(np.argmin(away))]
