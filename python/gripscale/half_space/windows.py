"""Windows of a surface, and periodic lines to compare with: one period of a line, and sines."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from gripscale.core import InputError, Quantity, checks
from gripscale.half_space.grid import surface_axes
from gripscale.surface import HeightMap, Profile, SineStack
from gripscale.surface.low_pass import one_period as one_period
from gripscale.surface.profile import FEWEST_POINTS

LEAST_VALID = 0.5  # share of heights that a window must have
_POINTS_IN_WAVE = 8
_MOST_POINTS = 10_000_000


def windows(
    surface: Profile | HeightMap, length: float | tuple[float, float]
) -> list[Profile | HeightMap]:
    """Return the surface cut into as many windows as fit, centred.

    `length` is that of the windows along x, and for a map along y [m]; with one length they are as
    wide as the map. Windows with fewer than half their heights are left out. Raises `InputError` if
    none is left, or one would have fewer than 16 points along an axis or exceed the surface.
    """
    lengths = tuple(length) if isinstance(length, tuple | list) else (length,)
    axes = surface_axes(surface)
    if not 1 <= len(lengths) <= surface.z.ndim:
        raise InputError(
            f"length must be one of a profile, one or two of a map; got {checks.short_repr(length)}"
        )
    cuts = []
    for axis, part in zip(axes, lengths, strict=False):
        step = float((axis[-1] - axis[0]) / (axis.size - 1))
        wanted = checks.positive("length", part, unit="m")
        points = round(min(wanted / step, 2.0 * axis.size))
        if not FEWEST_POINTS <= points <= axis.size:
            raise InputError(
                f"length must be from {FEWEST_POINTS * step:.4g} m to {axis.size * step:.4g} m, "
                f"the surface's; got {part:.4g} m"
            )
        number = axis.size // points
        first = (axis.size - number * points) // 2
        cuts.append([slice(first + i * points, first + (i + 1) * points) for i in range(number)])
    out: list[Profile | HeightMap] = []
    for cut in product(*cuts):
        heights = surface.z[cut]
        if np.isfinite(heights).mean() < LEAST_VALID:
            continue
        if isinstance(surface, Profile):
            out.append(Profile(surface.x[cut[0]], heights, surface.name))
        else:
            across = cut[1] if len(cut) > 1 else slice(None)
            out.append(HeightMap(surface.x[cut[0]], surface.y[across], heights, surface.name))
    if not out:
        raise InputError(f"length {length} m leaves no window with half of its heights")
    return out


def spread_windows(profiles: Sequence[Profile], length: float, most: int) -> list[Profile]:
    """Return at most `most` windows of a `length` [m], spread evenly, each made `one_period`.

    Raises `InputError` as `windows` does, or if `most` is not a whole number from 1.
    """
    number = checks.whole("most", most, least=1, most=100_000)
    lines = checks.instances("profiles", profiles, Profile)
    every = [window for line in lines for window in windows(line, length)]
    chosen = np.linspace(0, len(every) - 1, min(number, len(every))).round().astype(int)
    return [one_period(every[index]) for index in chosen]


def surface_of_sines(stack: SineStack, length: Quantity, seed: int) -> Profile:
    """Return a periodic line of superposed sine waves, each with a random phase from a `seed`.

    Each wavelength is changed to the nearest that divides the period, `length` [m], and its
    amplitude in proportion: slopes are kept. Raises `InputError` if an argument is out of its
    range, as a period below the largest wavelength, or for more than ten million points.
    """
    checks.instance("stack", stack, SineStack)
    period = checks.positive("length", length, unit="m")
    if period < stack.wavelength.max():
        raise InputError(
            f"length must be at least the largest wavelength, {stack.wavelength.max():g} m; "
            f"got {period:g} m"
        )
    counts = np.rint(period / stack.wavelength)
    points = max(64, _POINTS_IN_WAVE * int(counts.max()))
    if points > _MOST_POINTS:
        raise InputError(
            "length over the smallest wavelength must be at most "
            f"{_MOST_POINTS // _POINTS_IN_WAVE}; got {int(counts.max())}"
        )
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    position = np.arange(points) / points
    amplitudes = stack.amplitude * (period / counts) / stack.wavelength
    z = np.zeros(points)
    for count, amplitude in zip(counts, amplitudes, strict=True):
        z += amplitude * np.cos(2.0 * np.pi * (count * position + random.random()))
    return Profile(position * period, z, name=f"{len(stack)} sine waves", source=f"seed {seed}")
