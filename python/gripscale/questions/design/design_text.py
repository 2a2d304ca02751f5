"""Goals, limits and levels of a design as a user states them, and its targets as files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core import InputError, checks, parse_quantity
from gripscale.io.folders import make_folder, write_text
from gripscale.io.table import Column, Table, write_csv
from gripscale.questions.design.compound_limits import LIMITED_QUANTITIES, PointLimit, changed
from gripscale.questions.design.goal_friction import CompoundGoal
from gripscale.questions.vary.axis import values_by_name
from gripscale.rubber import MasterCurve, Rubber, write_master_curve

# What a goal may state beside `weight` and `road`.
GOAL_QUANTITIES = ("speed", "pressure", "temperature")


def parse_goal(text: str, default: CompoundGoal) -> CompoundGoal:
    """Return a goal stated as "speed=3 m/s, temperature=20 C, weight=2, road=wet.toml".

    What it does not state is that of `default`. Raises `InputError` if it cannot be understood.
    """
    values: dict[str, Any] = {name: getattr(default, name) for name in GOAL_QUANTITIES}
    example = "speed=3 m/s, temperature=20 C, pressure=2 bar, weight=1, road=case"
    for name, value in values_by_name(text.split(","), "goal", example).items():
        checks.one_of("goal", name, (*GOAL_QUANTITIES, "weight", "road"))
        if name == "road":
            values[name] = value
            continue
        try:
            values[name] = float(value) if name == "weight" else parse_quantity(value, name)
        except ValueError as error:
            raise InputError(f"goal {name} = {value!r}: {error}") from error
    return CompoundGoal(**values)


def parse_limit(text: str) -> PointLimit:
    """Return a limit stated as "loss_factor, 10 Hz, 0 C, 0.9:1.2" (the range over today's value).

    The temperature may be left out. Raises `InputError` if it cannot be understood.
    """
    parts = [part.strip() for part in text.split(",")]
    low, sign, high = parts[-1].partition(":")
    if len(parts) not in (3, 4) or not sign or parts[0] not in LIMITED_QUANTITIES:
        raise InputError(
            f'limit must be such as "{LIMITED_QUANTITIES[0]}, 10 Hz, 20 C, 0.9:1.1"; '
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


def designed_rubber(data: xr.Dataset, point: int) -> Rubber:
    """Return the rubber that a point of a design asks for."""
    today = Rubber.from_dict(json.loads(data.attrs["rubber_parameters"]))
    chosen = data.isel(point=point)
    name = f"target_{round(100.0 * float(chosen.rolling_ratio)):03d}"
    return changed(today, np.asarray(chosen.modulus_ratio.values), name=name)


def write_targets(data: xr.Dataset, folder: str | Path) -> list[Path]:
    """Write master curve (CSV), Prony series (CSV) and rubber (JSON) of each point.

    The number in the name is tan(delta) at the rolling condition in per cent of today's. The JSON
    file is what `gripscale export rubber` takes. Returns the paths.
    """
    target = Path(folder)
    make_folder(target)
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
        paths.append(write_text(target / f"{rubber.name}.json", text))
    return paths
