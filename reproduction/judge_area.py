"""Statements about real contact area (Figs 5 to 7)."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.surface import SineStack
from reproduction.inputs import SPEED, Inputs
from reproduction.panels import STATIC, Solved
from reproduction.statement import Statement

Array = NDArray[np.float64]

SAME = 0.25
MICRO = 0.5e-3
LESS = 0.05


def judge_progression(figure: str, solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the area goes the same way for all factors and settles (Figs 5a and 5b)."""
    state = "static" if figure == "fig5a" else f"{SPEED * 1e3:g} mm/s"
    statements = []
    for road, predictions in solved.items():
        where, worst = f"{road}, {inputs.rubber}, {state}", inputs.worst_fit(road)
        statements += [
            _same_way(figure, where, predictions, worst),
            _settles(figure, where, predictions, inputs.stacks[road]),
        ]
    return statements


def _same_way(
    figure: str, where: str, predictions: Mapping[str, xr.Dataset], worst: str
) -> Statement:
    x = _common(predictions.values())
    curves = {name: _area_at(prediction, x) for name, prediction in predictions.items()}
    spread = _spread(list(curves.values()))
    others = _spread([curve for name, curve in curves.items() if name != worst])
    steepest = {name: float(prediction.slope.max()) for name, prediction in predictions.items()}
    why = (
        f"without {worst}, which fits C_z worst, the others are {others:.0%} apart; its waves "
        f"reach a slope of {steepest.pop(worst):.1f}, theirs of {max(steepest.values()):.1f}"
    )
    return Statement(
        figure,
        "relative contact area goes the same way for all pairs of factors",
        where,
        f"running areas within {SAME:.0%} of each other at all wavelengths that all have: less "
        "than one wave of the coarsest stack takes away",
        f"at most {spread:.0%} apart down to {x[-1] * 1e3:.2g} mm",
        spread <= SAME,
        why,
    )


def _settles(
    figure: str, where: str, predictions: Mapping[str, xr.Dataset], stacks: Mapping[str, SineStack]
) -> Statement:
    """Judge whether curves flatten fast enough to end level."""
    rates, unsettled = [], []
    for name, prediction in predictions.items():
        slope, decades, more = _level(prediction)
        end = f"level {more:.1f} decades on" if more < math.inf else "never level"
        rates.append(f"{name}: {slope[0]:.2f} to {slope[-1]:.2f}, {end}")
        if more > decades:
            stack = stacks[name]
            rise = (stack.s_wavelength or math.nan) / (stack.s_amplitude or math.nan)
            unsettled.append(f"{rise:.2f} times in {name}, of {decades:.1f} decades")
    return Statement(
        figure,
        "the curves converge towards small wavelengths",
        where,
        "at the rate at which d ln(area)/d ln(wavelength) falls from the second wave to the last, "
        "each curve is level before the waves span as many decades again",
        "; ".join(rates),
        not unsettled,
        f"amplitude/wavelength rises from each wave to the next, {'; '.join(unsettled)}",
    )


def _level(prediction: xr.Dataset) -> tuple[Array, float, float]:
    """Return slopes, decades of wavelength, and decades after which the slope is zero.

    The slope goes on as straight over ln(wavelength) as from the first to the last, each of which
    belongs to the middle between two waves.
    """
    x, slope = np.log10(prediction.wavelength.values), _slopes(prediction)
    middle = 0.5 * (x[1:] + x[:-1])
    fall = float(slope[0] - slope[-1]) / float(middle[0] - middle[-1])
    more = float(slope[-1]) / fall - float(middle[-1] - x[-1]) if fall > 0.0 else math.inf
    return slope, float(x[0] - x[-1]), more


def judge_motion(rest: Solved, moving: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the area is smaller and falls more steeply in motion (Fig. 5b)."""
    statements = []
    for road in moving:
        ratios = [_ratio(rest[road][name], moving[road][name]) for name in moving[road]]
        largest = max(float(each.max()) for each in ratios)
        steeper = all(each[-1] < each[0] for each in ratios)
        holds = largest < 1.0 and steeper
        stiffer = [(moving[road][n].modulus / rest[road][n].modulus).values for n in moving[road]]
        why = (
            f"|E*| in motion is {min(each[0] for each in stiffer):.2f} times "
            f"that at rest at the first wave, {min(each[-1] for each in stiffer):.2f} at the last"
        )
        statements.append(
            Statement(
                "fig5b",
                "in motion the area is smaller than at rest and falls more steeply",
                f"{road}, {inputs.rubber}, {SPEED * 1e3:g} mm/s",
                "area in motion over area at rest below 1 at every wave and less at the last "
                "wave than at the first",
                f"at most {largest:.2f}; first to last: "
                + ", ".join(f"{r[0]:.2f} to {r[-1]:.2f}" for r in ratios),
                holds,
                why,
            )
        )
    return statements


def judge_speed(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the area falls with speed, most at micro scale (Fig. 6a)."""
    predictions = [
        prediction for name, prediction in solved[inputs.rubber].items() if name != STATIC
    ]
    grows = [
        f"{float(ratio.max()):.2f}"
        for ratio in (_ratio(slow, fast) for slow, fast in pairwise(predictions))
        if (ratio >= 1.0).any()
    ]
    left = _ratio(predictions[0], predictions[-1])
    holds = not grows and bool(left[-1] < left[0])
    why = (
        f"from a speed to the next the area is up to {', '.join(grows)} times as large: the modulus"
        " of this rubber does not rise with frequency there"
        if grows
        else "the modulus of this rubber rises as much between the speeds at large waves"
    )
    return [
        Statement(
            "fig6a",
            "contact area falls with speed, most at micro scale",
            f"{inputs.surface}, {inputs.rubber}, {len(predictions)} speeds over four decades",
            "running area falls from speed to speed at every wave, and what is left of it from "
            "the slowest to the fastest falls from the first wave to the last",
            f"left: {left[0]:.2f} at {float(predictions[0].wavelength[0]) * 1e3:.3g} mm, "
            f"{left[-1]:.2f} at {float(predictions[0].wavelength[left.size - 1]) * 1e3:.3g} mm",
            holds,
            why,
        )
    ]


def judge_stiffness(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the stiffer compound has less area at every scale (Fig. 6b)."""
    ((panel, lines),) = solved.items()
    (a, one), (b, other) = lines.items()
    if float(np.log(one.modulus / other.modulus).mean()) < 0.0:
        (a, one), (b, other) = (b, other), (a, one)
    stiffer = (one.modulus / other.modulus).values
    area = (one.running_contact_fraction / other.running_contact_fraction).values
    holds = bool((area < 1.0).all()) if (stiffer > 1.0).all() else None
    why = {
        True: "",
        False: f"|E*| differs by {stiffer.min():.2f} times only, loss factors "
        f"are up to {float((other.loss_factor / one.loss_factor).max()):.2f} times as large",
        None: "neither compound is the stiffer one at every wave",
    }
    return [
        Statement(
            "fig6b",
            "the stiffer compound has the smaller contact area at every scale",
            f"{inputs.surface}, {a} over {b}, {panel.rsplit(', ', 1)[-1]}",
            "ratio of running areas below 1 at every wave, the ratio of |E*| above 1 at each",
            f"|E*| ratio {stiffer.min():.1f} to {stiffer.max():.1f}, area ratio {area.min():.2f} "
            f"to {area.max():.2f}",
            holds,
            why[holds],
        )
    ]


def judge_surfaces(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether surfaces differ at macro scale, less with the micro scale (Fig. 7b)."""
    ((state, predictions),) = solved.items()
    a, b = predictions
    macro, whole = (
        abs(math.log(_down_to(predictions[b], end) / _down_to(predictions[a], end)))
        for end in (MICRO, 0.0)
    )
    steep = {road: inputs.surfaces[road].sines for road in (a, b)}
    finest = max(float(each.wavelength[-1]) for each in steep.values())
    holds = whole < (1.0 - LESS) * macro if finest < MICRO else None
    why = {
        True: "",
        False: f"areas at macro scale differ by {math.expm1(macro):.0%}, and "
        "amplitude/wavelength of the smallest waves is "
        + " and ".join(f"{s.amplitude[-1] / s.wavelength[-1]:.3f}" for s in steep.values()),
        None: f"the waves end at {finest * 1e3:.2g} mm: no micro scale",
    }
    return [
        Statement(
            "fig7b",
            "two surfaces differ at macro scale, less when macro and micro scale are taken "
            "together",
            f"{a} and {b}, {inputs.rubber}, {state}",
            f"difference of ln(area) down to 0.5 mm (macrotexture of ISO 13473-1) falls by more "
            f"than {LESS:.0%} with all waves: more than the mesh can make of it",
            f"{macro:.2f} at macro scale, {whole:.2f} of all waves",
            holds,
            why[holds],
        )
    ]


def _spread(curves: Sequence[Array]) -> float:
    """Return how far curves are apart where they are furthest, relative to the lowest."""
    return float((np.max(curves, axis=0) / np.min(curves, axis=0)).max() - 1.0)


def _common(predictions: Collection[xr.Dataset]) -> Array:
    """Return wavelengths from the first wave down to the last one all predictions have [m]."""
    first, last = (
        max(float(prediction.wavelength[at]) for prediction in predictions) for at in (0, -1)
    )
    return np.geomspace(first, last, 40)


def _kept(prediction: xr.Dataset) -> tuple[Array, Array]:
    """Return wavelength [m] and running area of the waves."""
    return prediction.wavelength.values, prediction.running_contact_fraction.values


def _area_at(prediction: xr.Dataset, wavelength: Array) -> Array:
    """Return the running area between waves, straight in logarithms."""
    own, area = _kept(prediction)
    return np.asarray(np.exp(np.interp(-np.log(wavelength), -np.log(own), np.log(area))))


def _slopes(prediction: xr.Dataset) -> Array:
    own, area = _kept(prediction)
    return np.asarray(np.diff(np.log(area)) / np.diff(np.log(own)))


def _ratio(rest: xr.Dataset, moving: xr.Dataset) -> Array:
    """Return running area in motion over that at rest, for the waves both have."""
    return np.asarray(moving.running_contact_fraction / rest.running_contact_fraction)


def _down_to(prediction: xr.Dataset, smallest: float) -> float:
    """Return the running area of the waves longer than `smallest` [m]."""
    own, area = _kept(prediction)
    return float(area[own >= smallest * (1.0 - 1e-9)][-1])
