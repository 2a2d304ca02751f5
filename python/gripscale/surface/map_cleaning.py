"""Make a measured map fit for contact: crop, dropouts, borders, spikes, form, each one reported.

Missing heights stay missing: nothing is filled here.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.cleaning import CleaningReport, StepReport, believed, interval
from gripscale.surface.height_map import HeightMap
from gripscale.surface.profile import FEWEST_POINTS, FloatArray
from gripscale.units import in_mm

HIGHEST_ORDER = 8
"""Highest order of a form: beyond it a polynomial follows the roughness."""

Limits = tuple[float, float]


def clean_map(
    surface: HeightMap,
    *,
    crop: tuple[Limits | None, Limits | None] | None = None,
    valid_range: Limits | None = None,
    trim: float | None = 0.5,
    remove_spikes: bool = True,
    spike_slope: float = 3.0,
    form: int | None = 1,
) -> tuple[HeightMap, CleaningReport]:
    """Crop a map, mark dropouts and spikes as missing, cut off bare borders, take out the form.

    Parameters
    ----------
    surface : HeightMap
        The measured map.
    crop : ((float, float) or None, (float, float) or None), optional
        First and last distance to keep along x and along y [m], both included; None keeps all.
    valid_range : (float, float), optional
        Lowest and highest height to believe [m]; others become missing (sentinels, fixtures).
    trim : float, optional
        Share of missing heights above which a line at a border is cut off; None keeps all.
    remove_spikes : bool, optional
        Mark spikes as missing, see `mark_map_spikes`.
    spike_slope : float, optional
        Height over the neighbours, per step, at which a point is a spike.
    form : int, optional
        Order of the polynomial to subtract: 0 the mean, 1 a plane, 2 a paraboloid (as a shallow
        sphere or cylinder is) and so on to 8; None keeps the form.

    Returns
    -------
    HeightMap
        The cleaned map.
    CleaningReport
        What each step did, in numbers of points.

    Raises
    ------
    InputError
        If an argument is wrong, or a step leaves too few points or heights.
    """
    if not isinstance(surface, HeightMap):
        raise InputError(f"surface must be a HeightMap; got {type(surface).__name__}")
    reports = []
    if crop is not None:
        surface, report = crop_map(surface, crop)
        reports.append(report)
    z, note = believed(surface.z, valid_range)
    surface, report = _changed(surface, "dropouts", z=z, note=note)
    reports.append(report)
    if trim is not None:
        surface, report = trim_map(surface, trim)
        reports.append(report)
    if checks.flag("remove_spikes", remove_spikes):
        surface, report = mark_map_spikes(surface, slope=spike_slope)
        reports.append(report)
    if form is not None:
        surface, report = subtract_form(surface, form)
        reports.append(report)
    return surface, CleaningReport(tuple(reports))


def crop_map(
    surface: HeightMap, limits: tuple[Limits | None, Limits | None]
) -> tuple[HeightMap, StepReport]:
    """Keep the points within `limits` [m] along x and y, both included."""
    if not isinstance(limits, tuple | list) or len(limits) != 2:
        raise InputError(
            f"crop must be limits along x and along y, or None; got {checks.shown(limits)}"
        )
    kept = []
    for name, axis, pair in zip("xy", (surface.x, surface.y), limits, strict=True):
        whole = (-math.inf, math.inf)
        first, last = whole if pair is None else interval(f"crop along {name}", pair)
        inside = np.flatnonzero((axis >= first) & (axis <= last))
        if inside.size < FEWEST_POINTS:
            raise InputError(
                f"crop must leave at least {FEWEST_POINTS} points along {name}; {in_mm(first)} to "
                f"{in_mm(last)} leaves {inside.size} of a map from {in_mm(axis[0])} to "
                f"{in_mm(axis[-1])}"
            )
        kept.append(slice(int(inside[0]), int(inside[-1]) + 1))
    return _part(surface, "crop", kept[0], kept[1])


def trim_map(surface: HeightMap, share: float = 0.5) -> tuple[HeightMap, StepReport]:
    """Cut lines off the borders, the barest first, while more than a share of one is missing.

    Raises
    ------
    InputError
        If `share` is not from 0 to 1, or fewer than 16 points a way would be left.
    """
    most = checks.not_negative("trim", share)
    if most > 1.0:
        raise InputError(f"trim must be a share of the heights, from 0 to 1; got {most:g}")
    missing = np.isnan(surface.z)
    (left, right), (low, high) = (0, surface.x.size), (0, surface.y.size)
    while True:
        inside = missing[left:right, low:high]
        borders = [line.mean() for line in (inside[0], inside[-1], inside[:, 0], inside[:, -1])]
        barest = int(np.argmax(borders))
        if borders[barest] <= most:
            break
        left, right = left + (barest == 0), right - (barest == 1)
        low, high = low + (barest == 2), high - (barest == 3)
        if min(right - left, high - low) < FEWEST_POINTS:
            raise InputError(
                f"trim must leave at least {FEWEST_POINTS} points a way; lines with a share of "
                f"{most:g} missing leave {right - left} x {high - low}"
            )
    return _part(surface, "trim", slice(left, right), slice(low, high))


def mark_map_spikes(surface: HeightMap, *, slope: float = 3.0) -> tuple[HeightMap, StepReport]:
    """Mark spikes as missing: heights far from the median of the valid heights around them.

    A point is a spike if |z - median of its up to eight neighbours| >= slope * step, the larger
    step of both ways. It is the median test of J. Westerweel, Exp. Fluids 16 (1994) 236,
    doi:10.1007/BF00206543, with the limit of ISO 13473-1 for profiles. Where that marks both sides
    of a steep step, a map can tell: along a straight edge most neighbours of a point are on its
    own side, so that stones keep their edges, and a spike of up to two by two points is found. One
    pass, from the heights as they were.

    Parameters
    ----------
    surface : HeightMap
        The map.
    slope : float, optional
        Height over the neighbours, per step, at which a point is a spike.

    Raises
    ------
    InputError
        If `slope` is not above zero, or all heights would become missing.
    """
    limit = checks.positive("spike_slope", slope) * max(surface.step)
    spikes = np.abs(surface.z - _median_around(surface.z)) >= limit  # NaN, alone: no spike
    z = np.where(spikes, np.nan, surface.z)
    if np.isnan(z).all():
        raise InputError(
            f"spike_slope must leave some heights; {slope:g} makes all of them spikes (or are the "
            "units of distance and height others?)"
        )
    return _changed(surface, "spikes", z=z, note=f"{slope:g} steps off the median around")


def _median_around(z: FloatArray) -> FloatArray:
    """Return the median of the valid heights among the eight neighbours; NaN where there are none.

    Sorted, missing ones last: the median is the mean of the two in the middle of the valid ones.
    """
    padded = np.pad(z, 1, constant_values=np.nan)
    nx, ny = z.shape
    around = np.stack(
        [padded[i : i + nx, j : j + ny] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    )
    around.sort(axis=0)
    count = np.isfinite(around).sum(axis=0)[None]
    low, high = (
        np.take_along_axis(around, at, axis=0)[0]
        for at in (np.maximum(count - 1, 0) // 2, np.minimum(count // 2, 7))
    )
    return np.asarray(0.5 * (low + high))


def subtract_form(surface: HeightMap, order: int = 1) -> tuple[HeightMap, StepReport]:
    """Subtract the least-squares polynomial of the valid heights, of total order `order`.

    The F-operation of ISO 25178-2 with a polynomial sum of a_mn P_m(x) P_n(y), m + n <= order,
    in Legendre polynomials over the map, which keep the equations well conditioned.

    Raises
    ------
    InputError
        If `order` is not from 0 to 8, or there are fewer heights than coefficients.
    """
    highest = checks.whole("form", order, least=0, most=HIGHEST_ORDER)
    terms = [(m, n) for m in range(highest + 1) for n in range(highest + 1 - m)]
    if surface.z.size - surface.missing < len(terms):
        raise InputError(
            f"form {highest} must have at least {len(terms)} heights; "
            f"got {surface.z.size - surface.missing}"
        )
    along, across = (
        np.asarray(np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, n), highest), float)
        for n in surface.z.shape
    )
    coefficient = np.zeros((highest + 1, highest + 1))
    level = float(np.nanmean(surface.z))  # instruments put their origin metres away
    coefficient[*zip(*terms, strict=True)] = _least_squares(surface.z - level, along, across, terms)
    mean, slopes = level + coefficient[0, 0], ""
    if highest:
        sizes = (0.5 * length for length in surface.length)
        along_x, along_y = (c / s for c, s in zip(coefficient[[1, 0], [0, 1]], sizes, strict=True))
        slopes = f", slopes {along_x:.4g} along x and {along_y:.4g} along y"
    z = surface.z - level - along @ coefficient @ across.T
    return _changed(surface, "form", z=z, note=f"order {highest}: mean {1e3 * mean:.4g} mm{slopes}")


def _least_squares(
    z: FloatArray, along: FloatArray, across: FloatArray, terms: list[tuple[int, int]]
) -> FloatArray:
    """Return the factors of `terms` that fit the valid heights, from the normal equations.

    They are sums over x and y of products of functions of x and of y: matrix products, without a
    table of all terms at all points.
    """
    m, n = np.array(terms).T
    valid = np.isfinite(z)
    squares = np.einsum("ia,ib->iab", along, along)
    weighed = np.tensordot(squares, valid.astype(float), axes=(0, 0))
    normal = np.einsum("abj,jc,jd->acbd", weighed, across, across, optimize=True)
    pull = along.T @ np.where(valid, z, 0.0) @ across
    matrix = normal[m[:, None], n[:, None], m, n]
    return np.asarray(np.linalg.lstsq(matrix, pull[m, n], rcond=None)[0])


def _part(
    surface: HeightMap, step: str, along: slice, across: slice
) -> tuple[HeightMap, StepReport]:
    x, y = surface.x[along], surface.y[across]
    note = f"kept {in_mm(x[0])} to {in_mm(x[-1])} by {in_mm(y[0])} to {in_mm(y[-1])}"
    z = surface.z[along, across]
    if np.isnan(z).all():
        raise InputError(f"{step} must leave some heights; {note[5:]} has none")
    new = replace(surface, x=x, y=y, z=z)
    return new, StepReport(step, z.size, surface.z.size - z.size, 0, new.missing, note)


def _changed(
    surface: HeightMap, step: str, *, z: FloatArray, note: str
) -> tuple[HeightMap, StepReport]:
    new = replace(surface, z=z)
    return new, StepReport(step, z.size, 0, new.missing - surface.missing, new.missing, note)
