"""A design of a compound in words: which point answers, what it gains and what it changes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.core.arrays import runs
from gripscale.io.table import significant
from gripscale.questions.design.compound_design import FRUITLESS
from gripscale.questions.design.compound_search import ROLLING_LEVEL
from gripscale.report.elements import Card

LEAST_CHANGE = 0.2  # change of E' or E'' from which a frequency counts as changed
DECIDES = 1e-3  # friction gained by a tenth more room from which a limit decides
SAME = 5e-3  # relative difference of rolling resistances that is none


def answering_point(data: xr.Dataset) -> tuple[int, bool]:
    """Return the place of the point that answers, and whether it keeps to today's rolling.

    It is the last whose rolling resistance is at most today's; without one the last.
    """
    allowed = np.flatnonzero(data.rolling_ratio.values <= 1.0 + 1e-6)
    return (int(allowed[-1]), True) if allowed.size else (data.sizes["point"] - 1, False)


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


def changed_frequencies(data: xr.Dataset, point: xr.Dataset) -> list[tuple[float, float]]:
    """Return the ranges of frequency [Hz] in which E' or E'' of a point is not today's."""
    ratios = np.stack([point[name] / data[f"today_{name}"] for name in ("storage", "loss")])
    changes = np.asarray((np.abs(ratios - 1.0) > LEAST_CHANGE).any(axis=0))
    frequency = data.frequency.values
    return [(float(frequency[low]), float(frequency[end - 1])) for low, end in runs(changes)]


def design_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the answer of a design, what it is for, what decides it, and what it rests on."""
    attrs, least = data.attrs, rolling_at_todays_friction(data)
    chosen = data.isel(point=answering_point(data)[0])
    now, then = data.today_answer_friction.values, chosen.answer_friction.values
    goals = [f" at {goal}" for goal in data.goal.values] if now.size > 1 else [""]
    pairs = [
        f"{old:.3f} now → {new:.3f}{at}" for old, new, at in zip(now, then, goals, strict=True)
    ]
    lead = f"friction {', '.join(pairs)} with the design {_at_rolling(chosen)}"
    without = f"; without {attrs['left_out']} of the case" if attrs.get("left_out") else ""
    yield f"Answer: {lead}: {_gain(chosen)}{without}."
    if math.isfinite(least):
        yield f"  Or the same friction with rolling resistance {_percent(least - 1.0)}."
    elif float(data.gain[0]) >= 0.0 and data.sizes["point"] > 1:
        lowest = data.isel(point=0)
        yield f"  Or friction {_gain(lowest)} {_at_rolling(lowest)}."
    named = zip(chosen.widened.values.tolist(), chosen.limit_worth.values.tolist(), strict=True)
    worths = {name: math.expm1(worth) for name, worth in named}
    if any(worth > DECIDES for name, worth in worths.items() if name != ROLLING_LEVEL):
        yield (
            f"  The limits you allow (moduli at most × {attrs['largest_factor']:g}) set the "
            "size of the gain, not physics."
        )
    if json.loads(attrs.get(FRUITLESS, "[]"))[-1:] > [float(data.rolling_level[-1])]:
        last = _percent(float(data.rolling_ratio[-1]) - 1.0)
        yield f"  More rolling resistance than {last} gives no more friction."
    tangent = float(data.today_rolling_loss_factor)
    yield (
        f"  Rolling resistance is tan δ and loss compliance at {attrs['rolling_band']}, the "
        f"worst of them; today tan δ is {significant(tangent)} at "
        f"{attrs['rolling_condition']}."
    )
    relaxed = [f"{name}, {_percent(worth)}" for name, worth in worths.items()]
    yield f"  A limit relaxed by a tenth gives, to first order: {'; '.join(relaxed)}."
    yield f"  {_interval_sources(chosen)}"
    yield from (f"note: {note}" for note in attrs.get("notes", "").splitlines())


def design_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield the gain at today's rolling resistance, and the least of it at today's friction."""
    (at, same), least = answering_point(data), rolling_at_todays_friction(data)
    if same:
        point = data.isel(point=at)
        now, then = float(point.today_answer_friction[0]), float(point.answer_friction[0])
        yield Card("Friction", f"{now:.3f} → {then:.3f}", f"{_gain(point)} {_at_rolling(point)}")
    if math.isfinite(least):
        yield Card("Rolling resistance", _percent(least - 1.0), "at the same friction")


def _gain(point: xr.Dataset) -> str:
    low, high = float(point.gain_low), float(point.gain_high)
    interval = f" ({_percent(low)} to {_percent(high)})" if math.isfinite(low) else ""
    return f"{_percent(float(point.gain))}{interval}"


def _at_rolling(point: xr.Dataset) -> str:
    change = float(point.rolling_ratio) - 1.0
    if abs(change) < SAME:
        return "at the same rolling resistance"
    return f"with rolling resistance {_percent(change)}"


def _percent(value: float) -> str:
    return f"{100.0 * value:+.0f} %" if abs(value) > 0.0995 else f"{100.0 * value:+z.1f} %"


def _interval_sources(point: xr.Dataset) -> str:
    """Return what the interval of a gain is made of."""
    parts = {
        "pieces of the surface": float(point.gain_sampling_error),
        "grids": float(point.gain_grid_error) / math.sqrt(3.0),
        "measurement of the rubber": float(point.gain_rubber_error),
    }
    each = ", ".join(
        f"{name} {significant(100.0 * value, 2)} %" if math.isfinite(value) else f"{name} not known"
        for name, value in parts.items()
    )
    doubled = float(point.gain_twice_cut_off)
    return (
        f"The 90 % interval is made of (1 sd): {each}; with twice the cut-off of the surface "
        f"{_percent(doubled)}. Finite strain and the step from lines to a surface are taken to be "
        "the same for both compounds."
    )
