"""A design of a compound in words: answer, tables and files, and goals and limits as text."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.analysis.compound_limits import QUANTITIES, PointLimit, changed
from gripscale.analysis.compound_search import ROLLING_LEVEL
from gripscale.analysis.goal_friction import CompoundGoal
from gripscale.case import folder as folders
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.core.units import parse_quantity
from gripscale.io.table import Column, Table, change, fixed, significant, write_csv
from gripscale.rubber import MasterCurve, Rubber, write_master_curve

DECIDES = 1e-3
"""Friction gained by a tenth more room from which a limit decides."""
GOAL_KEYS = {"speed": "speed", "pressure": "pressure", "temperature": "temperature"}
"""What a goal may state, with the kind of quantity; beside `weight` and `road`."""
TITLE = "Trade-off: each row is the admissible compound of most friction"
WORTH_SAYING = 0.2
"""Change of E' or E'' from which a frequency counts as changed."""


def parse_goal(text: str, default: CompoundGoal) -> CompoundGoal:
    """Return a goal stated as "speed=3 m/s, temperature=20 C, weight=2, road=wet.toml".

    What it does not state is that of `default`. Raises `InputError` if it cannot be understood.
    """
    values: dict[str, Any] = {name: getattr(default, name) for name in GOAL_KEYS}
    for part in text.split(","):
        name, sign, value = (word.strip() for word in part.partition("="))
        if not sign or name not in (*GOAL_KEYS, "weight", "road"):
            raise InputError(
                'goal must be such as "speed=3 m/s, temperature=20 C, pressure=2 bar, weight=1, '
                f'road=case"; got {checks.short_repr(part.strip())}'
            )
        if name == "road":
            values[name] = value
            continue
        try:
            values[name] = (
                float(value) if name == "weight" else parse_quantity(value, GOAL_KEYS[name])
            )
        except ValueError as error:
            raise InputError(f"goal {name} = {value!r}: {error}") from error
    return CompoundGoal(**values)


def parse_limit(text: str) -> PointLimit:
    """Return a limit stated as "loss_factor, 10 Hz, 0 C, 0.9:1.2" (the range over today's value).

    The temperature may be left out. Raises `InputError` if it cannot be understood.
    """
    parts = [part.strip() for part in text.split(",")]
    low, sign, high = parts[-1].partition(":")
    if len(parts) not in (3, 4) or not sign or parts[0] not in QUANTITIES:
        raise InputError(
            f'limit must be such as "{QUANTITIES[0]}, 10 Hz, 20 C, 0.9:1.1"; '
            f"got {checks.short_repr(text)}"
        )
    try:
        hertz = float(parts[1].removesuffix("Hz"))
        kelvin = parse_quantity(parts[2], "temperature") if len(parts) == 4 else None
        ends = float(low), float(high)
    except ValueError as error:
        raise InputError(f"limit {text!r}: {error}") from error
    return PointLimit(parts[0], *ends, hertz, kelvin)


def parse_levels(text: str) -> list[float]:
    """Return levels stated as "0.8,1,1.2"; raise `InputError` if one is no number above zero."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise InputError(f'levels must be such as "0.8,1,1.2"; got {text!r}') from error
    return [float(number) for number in checks.positive_vector("levels", numbers)]


def at_todays_rolling(data: xr.Dataset) -> xr.Dataset | None:
    """Return the point whose rolling resistance is at most today's, None if there is none."""
    allowed = np.flatnonzero(data.rolling_ratio.values <= 1.0 + 1e-6)
    return data.isel(point=allowed[-1]) if allowed.size else None


def rolling_at_todays_friction(data: xr.Dataset) -> float:
    """Return the least rolling resistance over today's with today's friction [-].

    Linear between the points; NaN if the lowest point still has more friction than today's.
    """
    ratio, gain = data.rolling_ratio.values, data.gain.values
    above = np.flatnonzero(gain >= 0.0)
    if not above.size or above[0] == 0:
        return math.nan
    low, high = above[0] - 1, above[0]
    share = -gain[low] / (gain[high] - gain[low])
    return float(ratio[low] + share * (ratio[high] - ratio[low]))


def design_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the answer of a design, what it is for, what decides it, and what it rests on."""
    same, least = at_todays_rolling(data), rolling_at_todays_friction(data)
    answers = []
    if same is not None:
        answers.append(f"friction {_gain(same)} at the same rolling resistance")
    if math.isfinite(least):
        answers.append(f"rolling resistance {_percent(least - 1.0)} at the same friction")
    elif float(data.gain[0]) >= 0.0:
        lowest = data.isel(point=0)
        answers.append(
            f"rolling resistance {_percent(float(lowest.rolling_ratio) - 1.0)} still with "
            f"friction {_gain(lowest)}"
        )
    chosen = data.isel(point=-1) if same is None else same
    decided = "the limits decide" if _decide(chosen) else "the limits do not decide"
    answer = "; or ".join(answers) or "no more friction for less rolling resistance"
    yield f"Answer: {answer}; {decided}"
    for goal in data.goal.values.tolist():
        today = float(data.today_friction.sel(goal=goal))
        design = float(chosen.friction.sel(goal=goal))
        yield f"  for {goal}: friction {today:.3f} today, {design:.3f} designed"
    tangent = float(data.today_rolling_loss_factor)
    yield (
        f"  rolling resistance is tan δ at {data.attrs['rolling_condition']}, "
        f"{significant(tangent)} today"
    )
    yield f"  {_what_changes(data, chosen)}"
    count = round(float(chosen.limited_share) * chosen.sizes["term"])
    yield (
        f"  {count} of {chosen.sizes['term']} moduli are at the largest factor "
        f"({data.attrs['largest_factor']:g}) or as far from a neighbour as they may be (a factor "
        f"of {data.attrs['factor_per_decade']:g} a decade)"
    )
    worths = [f"{name}, {_percent(worth)}" for name, worth in _worths(chosen).items()]
    yield f"  a tenth more room gives friction, to first order: {'; '.join(worths)}"
    yield f"  {_interval_sources(chosen)}"
    yield from (f"note: {note}" for note in data.attrs.get("notes", "").splitlines())


def _gain(point: xr.Dataset) -> str:
    low, high = float(point.gain_low), float(point.gain_high)
    interval = f" ({_percent(low)} to {_percent(high)})" if math.isfinite(low) else ""
    return f"{_percent(float(point.gain))}{interval}"


def _percent(value: float) -> str:
    return f"{100.0 * value:+.0f} %" if abs(value) > 0.0995 else f"{100.0 * value:+z.1f} %"


def _worths(point: xr.Dataset) -> dict[str, float]:
    """Return what a tenth more room is worth, by what limits the friction of a point."""
    pairs = zip(point.widened.values.tolist(), point.limit_worth.values.tolist(), strict=True)
    return {name: math.expm1(worth) for name, worth in pairs}


def _decide(point: xr.Dataset) -> bool:
    """Return whether a limit other than the rolling resistance holds the friction back."""
    return any(worth > DECIDES for name, worth in _worths(point).items() if name != ROLLING_LEVEL)


def changed_frequencies(data: xr.Dataset, point: xr.Dataset) -> list[tuple[float, float]]:
    """Return the ranges of frequency [Hz] in which E' or E'' of a point is not today's."""
    ratios = np.stack([point[name] / data[f"today_{name}"] for name in ("storage", "loss")])
    flags = np.concatenate([[False], (np.abs(ratios - 1.0) > WORTH_SAYING).any(axis=0), [False]])
    ends = np.flatnonzero(np.diff(flags.astype(int)))
    frequency = data.frequency.values
    return [
        (float(frequency[first]), float(frequency[last - 1]))
        for first, last in zip(ends[::2], ends[1::2], strict=True)
    ]


def _what_changes(data: xr.Dataset, point: xr.Dataset) -> str:
    """Return where the largest changes of E' and E'' are."""
    texts = []
    for name, symbol in (("storage", "E'"), ("loss", "E''")):
        ratio = (point[name] / data[f"today_{name}"]).values
        for at in sorted({int(np.argmin(ratio)), int(np.argmax(ratio))}):
            if abs(ratio[at] - 1.0) > WORTH_SAYING:
                texts.append(f"{symbol} × {ratio[at]:.2f} at {data.frequency.values[at]:.2g} Hz")
    ranges = [f"{low:.2g} to {high:.2g} Hz" for low, high in changed_frequencies(data, point)]
    if not ranges:
        return "the master curve stays within 20 % of today's"
    return (
        f"the master curve changes by more than 20 % from {', '.join(ranges)}: {', '.join(texts)}"
    )


def _interval_sources(point: xr.Dataset) -> str:
    """Return what the interval of a gain is made of."""
    parts = {
        "pieces of the road": float(point.gain_sampling_error),
        "grids": float(point.gain_grid_error) / math.sqrt(3.0),
        "measurement of the rubber": float(point.gain_rubber_error),
    }
    each = ", ".join(
        f"{name} {significant(100.0 * value, 2)} %" if math.isfinite(value) else f"{name} not known"
        for name, value in parts.items()
    )
    doubled = float(point.gain_twice_cut_off)
    return (
        f"90 % interval from (1 sd): {each}; with twice the cut-off of the road "
        f"{_percent(doubled)}. Finite strain and the step from lines to a surface are taken to be "
        "the same for both compounds"
    )


def design_table(data: xr.Dataset) -> Table:
    """Return the points of a design as a table."""
    columns = [
        Column("rolling_loss_factor", data.rolling_loss_factor.values, "tan δ rolling"),
        Column("rolling_change", data.rolling_ratio.values - 1.0, "change", format=_rolling),
        Column("gain", data.gain.values, "friction gained", format=change),
        Column(
            "gain_interval",
            np.column_stack([data.gain_low.values, data.gain_high.values]),
            "90 % interval",
            format=change,
        ),
    ]
    notes = []
    for at, goal in enumerate(data.goal.values.tolist()):
        columns.append(Column(f"friction_{at + 1}", data.friction.values[:, at], f"μ {at + 1}"))
        notes.append(f"μ {at + 1}: {goal}")
    for at, limit in enumerate(data.limit.values.tolist()):
        name = limit.split(" at ")[0]
        values = data.limited_ratio.values[:, at]
        columns.append(Column(f"limit_{at + 1}", values, f"{name} / today", format=fixed(2)))
    if bool(np.isfinite(data.wet_loss_factor.values).all()):
        columns.append(Column("wet_loss_factor", data.wet_loss_factor.values, "tan δ wet"))
        notes.append("tan δ wet: at 10 Hz and 0 °C, the rule of thumb for wet grip")
    columns.append(Column("limited_share", data.limited_share.values, "at a limit", format=_share))
    columns.append(Column("gap", data.gap.values, "left to gain", format=change))
    return Table("design", columns, TITLE, notes)


def compounds_table(data: xr.Dataset) -> Table | None:
    """Return the other compounds of a design as a table, None without any."""
    if "compound" not in data.dims:
        return None
    gains = np.column_stack([data.compound_gain_low.values, data.compound_gain_high.values])
    return Table(
        "compounds",
        [
            Column("compound", data.compound.values),
            Column(
                "rolling_change",
                data.compound_rolling_ratio.values - 1.0,
                "tan δ rolling, change",
                format=change,
            ),
            Column("gain", data.compound_gain.values, "friction gained", format=change),
            Column("gain_interval", gains, "90 % interval", format=change),
        ],
        "Other compounds beside today's",
    )


def _rolling(value: float) -> str:
    """Return a change of the rolling resistance; today's has no sign."""
    return change(round(value, 4) + 0.0)


def _share(value: float) -> str:
    return f"{100.0 * value:.0f} %"


def designed_rubber(data: xr.Dataset, point: int) -> Rubber:
    """Return the rubber that a point of a design asks for."""
    today = Rubber.from_dict(json.loads(data.attrs["rubber_parameters"]))
    chosen = data.isel(point=point)
    return changed(today, np.asarray(chosen.modulus_ratio.values), name=_name(chosen))


def _name(point: xr.Dataset) -> str:
    return f"target_{round(100.0 * float(point.rolling_ratio)):03d}"


def write_targets(data: xr.Dataset, folder: str | Path) -> list[Path]:
    """Write master curve (CSV), Prony series (CSV) and rubber (JSON) of each point.

    The number in the name is tan(delta) at the rolling condition in per cent of today's. The JSON
    file is what `gripscale export rubber` takes. Returns the paths.

    Raises `FileError` if a file cannot be written.
    """
    target = Path(folder)
    folders.make(target)
    paths = []
    for at in range(data.sizes["point"]):
        rubber, point = designed_rubber(data, at), data.isel(point=at)
        curve = MasterCurve(
            point.frequency.values,
            point.storage.values,
            point.loss.values,
            rubber.reference_temperature,
            rubber.name,
            f"design of gripscale, not measured; from {data.attrs['rubber']}",
        )
        paths.append(write_master_curve(target / f"{rubber.name}.csv", curve))
        series = Table(
            "prony",
            [
                Column("relaxation_time", data.relaxation_time.values, unit="s"),
                Column("modulus", point.modulus.values, unit="Pa"),
                Column("modulus_over_today", point.modulus_ratio.values, unit="1"),
            ],
        )
        paths.append(write_csv(series, target / f"{rubber.name}_prony.csv"))
        text = json.dumps(rubber.to_dict(), indent=1)
        paths.append(folders.write_text(target / f"{rubber.name}.json", text))
    return paths
