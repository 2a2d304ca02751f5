"""Statements about real contact area (Figs 5 to 7)."""

from __future__ import annotations

import math
from collections.abc import Collection
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reproduction.inputs import DENSE, ROAD, SBR, SPEED, TREAD
from reproduction.panels import STATIC, Solved, speed_name
from reproduction.statement import Statement

Array = NDArray[np.float64]

SAME = 0.25
MICRO = 0.5e-3
LESS = 0.05


def judge_progression(figure: str, solved: Solved) -> list[Statement]:
    """Judge whether the area goes the same way for all factors and settles (Figs 5a and 5b)."""
    state = "static" if figure == "fig5a" else f"{SPEED * 1e3:g} mm/s"
    statements = []
    for road, predictions in solved.items():
        x = _common(predictions.values())
        curves = np.array([_area_at(prediction, x) for prediction in predictions.values()])
        spread, good = _spread(curves), _spread(curves[:-1])
        steepest = max(float((prediction.slope).max()) for prediction in predictions.values())
        why = (
            f"different inputs: without the pair that fits worst the others are {good:.0%} apart; "
            f"its last wave is too steep (slope {steepest:.1f}) for so few waves on this road"
        )
        statements.append(
            Statement(
                figure,
                "relative contact area goes the same way for all three pairs of factors",
                f"{road}, {TREAD}, {state}",
                f"running areas within {SAME:.0%} of each other at all wavelengths that all "
                "three have: less than one wave of the coarsest stack takes away",
                f"at most {spread:.0%} apart down to {x[-1] * 1e3:.2g} mm",
                spread <= SAME,
                "" if spread <= SAME else why,
            )
        )
        slopes = {name: _slopes(prediction) for name, prediction in predictions.items()}
        flatter = all(each[-1] < each[0] for each in slopes.values())
        statements.append(
            Statement(
                figure,
                "the curves converge towards small wavelengths",
                f"{road}, {TREAD}, {state}",
                "each flattens: d ln(area)/d ln(wavelength) smaller at the last wave than at the "
                "second",
                "; ".join(f"{n}: {s[0]:.2f} to {s[-1]:.2f}" for n, s in slopes.items()),
                flatter,
            )
        )
    return statements


def judge_motion(rest: Solved, moving: Solved) -> list[Statement]:
    """Judge whether the area is smaller and falls more steeply in motion (Fig. 5b)."""
    statements = []
    for road in moving:
        pairs = [(rest[road][name], moving[road][name]) for name in moving[road]]
        ratios = [_ratio(one, other) for one, other in pairs]
        largest = max(float(each.max()) for each in ratios)
        steeper = all(each[-1] < each[0] for each in ratios)
        statements.append(
            Statement(
                "fig5b",
                "in motion the area is smaller than at rest and falls more steeply",
                f"{road}, {TREAD}, {SPEED * 1e3:g} mm/s",
                "area in motion over area at rest below 1 at every wave and less at the last "
                "wave than at the first",
                f"at most {largest:.2f}; first to last: "
                + ", ".join(f"{r[0]:.2f} to {r[-1]:.2f}" for r in ratios),
                largest < 1.0 and steeper,
            )
        )
    return statements


def judge_speed(solved: Solved) -> list[Statement]:
    """Judge whether the area falls with speed, most at micro scale (Fig. 6a)."""
    predictions = [prediction for name, prediction in solved[TREAD].items() if name != STATIC]
    falls = all((_ratio(slow, fast) < 1.0).all() for slow, fast in pairwise(predictions))
    left = _ratio(predictions[0], predictions[-1])
    return [
        Statement(
            "fig6a",
            "contact area falls with speed, most at micro scale",
            f"{ROAD}, {TREAD}, {len(predictions)} speeds over four decades",
            "running area falls from speed to speed at every wave, and what is left of it from "
            "the slowest to the fastest falls from the first wave to the last",
            f"left: {left[0]:.2f} at {float(predictions[0].wavelength[0]) * 1e3:.3g} mm, "
            f"{left[-1]:.2f} at {float(predictions[0].wavelength[left.size - 1]) * 1e3:.3g} mm",
            falls and bool(left[-1] < left[0]),
        )
    ]


def judge_stiffness(solved: Solved) -> list[Statement]:
    """Judge whether the stiffer compound has less area at every scale (Fig. 6b)."""
    tread, sbr = (solved[speed_name(SPEED)][name] for name in (TREAD, SBR))
    stiffer = (tread.modulus / sbr.modulus).values
    area = (tread.running_contact_fraction / sbr.running_contact_fraction).values
    return [
        Statement(
            "fig6b",
            "the stiffer compound has the smaller contact area at every scale",
            f"{ROAD}, {SPEED * 1e3:g} mm/s, {TREAD} over {SBR}",
            "ratio of running areas below 1 at every wave where the ratio of |E*| is above 1",
            f"|E*| ratio {stiffer.min():.1f} to {stiffer.max():.1f}, area ratio {area.min():.2f} "
            f"to {area.max():.2f}",
            bool((stiffer > 1.0).all() and (area < 1.0).all()),
        )
    ]


def judge_surfaces(figure: str, solved: Solved) -> list[Statement]:
    """Judge whether surfaces differ at macro scale, less with the micro scale (Figs 7a, 7b)."""
    (state, predictions), *_ = solved.items()
    macro, whole = (
        abs(math.log(_down_to(predictions[DENSE], end) / _down_to(predictions[ROAD], end)))
        for end in (MICRO, 0.0)
    )
    holds = whole < (1.0 - LESS) * macro
    return [
        Statement(
            figure,
            "two surfaces differ at macro scale, less when macro and micro scale are taken "
            "together",
            f"{ROAD} and {DENSE}, {TREAD}, {state}",
            f"difference of ln(area) down to 0.5 mm (macrotexture of ISO 13473-1) falls by more "
            f"than {LESS:.0%} with all waves: more than the mesh can make of it",
            f"{macro:.2f} at macro scale, {whole:.2f} of all waves",
            holds,
        )
    ]


def _spread(curves: Array) -> float:
    """Return how far curves are apart where they are furthest, relative to the lowest."""
    return float((curves.max(axis=0) / curves.min(axis=0)).max() - 1.0)


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
    return float(area[own >= smallest][-1])
