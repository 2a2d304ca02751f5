"""Texture of profiles and maps, in the numbers of the standards.

Heights over the least-squares line or plane of the measured points: ISO 21920-2:2021 for profiles,
ISO 25178-2:2021 for maps, by the names of `TEXTURE_NUMBERS`. Slopes are those between neighbours;
a missing height has no weight, and neither has a slope that needs it. The mean profile depth is
that of ISO 13473-1:2019, the g-factor that of ISO 13473-2:2002, and third-octave levels are

    L = 10 log10( <z^2> in the band / a^2 ),    a = 1 um

by ISO 13473-4:2024. The steps of each are in docs/derivations.md.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from gripscale.core import Array, InputError, in_mm
from gripscale.core.units import MILLI
from gripscale.surface.cleaning import mark_steep_steps, subtract_form, subtract_trend
from gripscale.surface.direction import texture_direction, texture_lengths
from gripscale.surface.profile import HeightMap, Profile, profile_list
from gripscale.surface.resampling import fill_gaps, without_line
from gripscale.surface.spectrum import profile_spectrum

if TYPE_CHECKING:
    import xarray as xr

_SEGMENT = 0.1  # length of a segment [m]
# Steps to which a finer profile is averaged, and beyond which it has no profile depth [m].
_SAMPLE, _COARSEST = 0.5e-3, 1e-3
_SHORTEST_WAVE = 2.4e-3  # wavelength at which the filter of the standard begins [m]
_PADDING = 9  # samples by which the filter continues a line at either end
# Share of missing heights beyond which a segment does not count: the standard allows 10 % of
# dropouts and 5 % of spikes.
_MOST_MISSING = 0.15
# Symbols of profiles and maps, unit and meaning of each number.
TEXTURE_NUMBERS = {
    "mean_profile_depth": ("MPD", "m", "mean profile depth, ISO 13473-1"),
    "g_factor": ("g", "1", "share of the heights above the middle, ISO 13473-2"),
    "depth_segments": ("segments", "1", "segments of 100 mm in the mean profile depth"),
    "rms_height": ("Pq, Sq", "m", "root mean square height"),
    "mean_deviation": ("Pa, Sa", "m", "mean absolute height"),
    "skewness": ("Psk, Ssk", "1", "skewness of heights"),
    "kurtosis": ("Pku, Sku", "1", "kurtosis of heights, 3 if Gaussian"),
    "peak_height": ("Pp, Sp", "m", "highest point over the mean"),
    "pit_depth": ("Pv, Sv", "m", "lowest point below the mean"),
    "total_height": ("Pt, Sz", "m", "highest over lowest point"),
    "rms_slope": ("Pdq", "1", "root mean square slope of lines"),
    "rms_gradient": ("Sdq", "1", "root mean square gradient of the surface"),
    "developed_area_ratio": ("Sdr", "1", "area of the surface over its projection, less one"),
    "autocorrelation_length": ("Sal", "m", "shortest length to an autocorrelation of 0.2"),
    "texture_aspect_ratio": ("Str", "1", "that length over the longest, 1 without a direction"),
    "texture_direction": ("Std", "rad", "angle of the ridges to x"),
}
DEPTH_NOTE = "depth_note"  # why there is no mean profile depth, or empty


def texture(surface: Profile | Sequence[Profile] | HeightMap) -> xr.Dataset:
    """Return the texture of a profile, of several together, or of a map, of cleaned heights.

    The line of each profile, or the plane of the map, is subtracted; missing heights are NaN. The
    result has scalars by the names of `TEXTURE_NUMBERS` in SI units, with attributes `units`,
    `symbol` and `long_name`. Profiles have none of the numbers with S alone in their symbol, a
    map has no `rms_slope`: NaN. The mean profile depth of a map is that of its lines along x. It is
    NaN without a whole segment of 100 mm; the text `depth_note` then says why. Raises `InputError`
    if `surface` is none of these.
    """
    values = dict.fromkeys(TEXTURE_NUMBERS, np.nan)
    if isinstance(surface, HeightMap):
        lines = surface.lines()
        level, _ = subtract_form(surface, order=1)
        x, y = ((np.diff(level.z, axis=axis) / level.step[axis]) ** 2 for axis in (0, 1))
        # the corners of all cells, NaN where a height is missing
        squares = np.array([a + b for a in (x[:, :-1], x[:, 1:]) for b in (y[:-1], y[1:])])
        values |= _height_numbers(level.z) | {
            "rms_gradient": _mean(squares) ** 0.5,
            "developed_area_ratio": _mean(np.sqrt(1.0 + squares) - 1.0),
        }
        lengths = texture_lengths(surface)
        values["autocorrelation_length"], values["texture_aspect_ratio"] = lengths
        values["texture_direction"] = texture_direction(surface)
    else:
        lines = profile_list(surface)
        levels = [subtract_trend(line)[0] for line in lines]
        slopes = np.concatenate([np.diff(line.z) / line.step for line in levels])
        values |= _height_numbers(np.concatenate([line.z for line in levels]))
        values["rms_slope"] = _mean(slopes**2) ** 0.5
    depths, shares = np.concatenate([_depths_and_shares(line) for line in lines], axis=1)
    values |= {"mean_profile_depth": _mean(depths), "depth_segments": depths.size}
    values["g_factor"] = _mean(shares)
    note = ""
    if not depths.size:
        if max(line.length for line in lines) < _SEGMENT:
            note = f"shorter than {in_mm(_SEGMENT)}"
        elif max(line.step for line in lines) > _COARSEST:
            note = f"step above {in_mm(_COARSEST)}"
        else:
            note = f"more than {_MOST_MISSING:.0%} of heights missing"
    return _dataset(values, note)


Heights = Profile | Sequence[Profile] | HeightMap  # a profile, several together, or a map


def textures(surfaces: Mapping[str, Heights | None], dim: str) -> xr.Dataset:
    """Return the texture of surfaces by name, over `dim`; None is one that was not measured."""
    import xarray as xr  # slow to import: not for reading a surface

    empty = _dataset(dict.fromkeys(TEXTURE_NUMBERS, np.nan), "not measured")
    parts = [empty if surface is None else texture(surface) for surface in surfaces.values()]
    return xr.concat(parts, dim=dim).assign_coords({dim: list(surfaces)})


def _dataset(values: Mapping[str, float], note: str) -> xr.Dataset:
    """Return numbers by the names of `TEXTURE_NUMBERS`, and the note, as a Dataset."""
    import xarray as xr

    data = {
        name: ((), values[name], {"units": unit, "symbol": symbol, "long_name": text})
        for name, (symbol, unit, text) in TEXTURE_NUMBERS.items()
    }
    return xr.Dataset(data).assign({DEPTH_NOTE: note})


def _depths_and_shares(profile: Profile) -> Array:
    """Return segment depth [m] and g-factor [-] of each whole segment; none with steps above 1 mm.

    Of shape (2, segments).
    """
    step = max(profile.step, _SAMPLE)
    if step > _COARSEST or len(profile) * profile.step < _SEGMENT:
        return np.zeros((2, 0))
    sample = np.floor(np.arange(len(profile)) * (profile.step / step) + 1e-6).astype(int)
    samples = int(_SEGMENT / step + 1e-6)
    whole = (sample[-1] + 1) // samples
    counts = np.bincount(sample)
    steady, _ = mark_steep_steps(profile)
    rough = np.bincount(sample, fill_gaps(steady.z)) / counts
    smooth = _without_short_waves(rough, step / _SHORTEST_WAVE)
    missing = np.bincount(sample, np.isnan(steady.z)) / counts
    smooth, rough, gaps = (
        part[: whole * samples].reshape(whole, -1) for part in (smooth, rough, missing)
    )
    counted = gaps.mean(axis=1) <= _MOST_MISSING
    smooth, rough = (without_line(segments)[counted] for segments in (smooth, rough))
    halves = np.array_split(smooth, 2, axis=1)
    depths = np.mean([half.max(axis=1) for half in halves], axis=0)
    middle = 0.5 * (rough.max(axis=1) + rough.min(axis=1))
    return np.array([depths, (rough > middle[:, None]).mean(axis=1)])


# Estimated texture depth, which a patch of sand would show, over the mean profile depth (ISO
# 13473-1:2019).
ESTIMATED_DEPTH = 1.1
# Texture depth of the asphalt on which tyres are labelled [m] (ISO 23671:2021: 0.7 +- 0.3 mm).
LABEL_DEPTH = 0.4e-3, 1.0e-3


def beside_label(depth: float) -> str:
    """Return that a mean profile depth [m] is not that of the tyre label; empty if it is."""
    estimated = ESTIMATED_DEPTH * depth
    low, high = LABEL_DEPTH
    if np.isnan(depth) or low <= estimated <= high:
        return ""
    return (
        f"Texture depth {in_mm(estimated, 2)} ({ESTIMATED_DEPTH} MPD); the asphalt of the tyre "
        f"label has {low / MILLI:.1f} to {high / MILLI:.1f} mm (ISO 23671): no wet grip of a label."
    )


def _without_short_waves(heights: Array, frequency: float) -> Array:
    """Return heights through a second-order low-pass Butterworth filter, forwards and backwards.

    `frequency` is the cut-off in cycles a sample. The ends are continued by points mirrored at the
    first and last, as `scipy.signal.sosfiltfilt` does; its import alone takes half a second.
    """
    from scipy.linalg import solve_banded

    before = 2.0 * heights[0] - heights[_PADDING:0:-1]
    after = 2.0 * heights[-1] - heights[-2 : -_PADDING - 2 : -1]
    values = np.concatenate([before, heights, after])
    warped = np.tan(np.pi * frequency)
    scale = 1.0 + np.sqrt(2.0) * warped + warped**2
    recursion = 2.0 * (warped**2 - 1.0) / scale, (1.0 - np.sqrt(2.0) * warped + warped**2) / scale
    bands = np.ones((3, values.size)) * np.array([[1.0], *([value] for value in recursion)])
    for _ in range(2):
        start = values[0]  # before it the values are constant
        weighted = np.convolve(values - start, [1.0, 2.0, 1.0])[: values.size]
        values = solve_banded((2, 0), bands, warped**2 / scale * weighted)[::-1] + start
    return values[_PADDING:-_PADDING]


def _height_numbers(z: Array) -> dict[str, float]:
    heights = z[np.isfinite(z)]
    rms = _mean(heights**2) ** 0.5
    shape = heights / rms if rms > 0.0 else np.full(1, np.nan)
    top, bottom = float(heights.max()), float(heights.min())
    return {
        "rms_height": rms,
        "mean_deviation": _mean(np.abs(heights)),
        "skewness": _mean(shape**3),
        "kurtosis": _mean(shape**4),
        "peak_height": top,
        "pit_depth": -bottom,
        "total_height": top - bottom,
    }


def _mean(values: Array) -> float:
    """Return the mean of the values that are there, NaN without any."""
    present = values[np.isfinite(values)]
    return float(present.mean()) if present.size else np.nan


_REFERENCE = 1e-6  # root mean square height of the level zero [m]
_LENGTHS = 12.0  # length of a profile over the longest wavelength of its bands
_HALF_BAND = 10.0**0.05  # edge of a band over its middle
# Numbers by which the middles of the bands are called (ISO 3, R10).
_PREFERRED = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def texture_levels(surface: Profile | Sequence[Profile] | HeightMap) -> xr.Dataset:
    """Return the third-octave texture levels of profiles, or of the lines of a map along x.

    The result has `level` [dB re 1 um] over `wavelength` [m], the middles of the bands, longest
    first. `surface` are cleaned heights; missing ones are interpolated, and several profiles must
    have the same step. Raises `InputError` if they are too short for a band that they resolve.
    """
    import xarray as xr  # slow to import: not for reading a surface

    lines = surface.lines() if isinstance(surface, HeightMap) else profile_list(surface)
    length = min(line.length for line in lines)
    shortest = max(line.resolution_limit for line in lines)
    # numbers of the bands: wavelength 10^(number / 10)
    first = int(np.ceil(10.0 * np.log10(shortest * _HALF_BAND) - 1e-9))
    last = int(np.floor(10.0 * np.log10(length / _LENGTHS) + 1e-9))
    if last < first:
        raise InputError(
            f"profile must be longer than {in_mm(_LENGTHS * shortest * _HALF_BAND, 3)} for a level "
            f"at wavelengths that it resolves; got {in_mm(length, 3)}"
        )
    bands = np.arange(last, first - 1, -1)
    middle = 2.0 * np.pi / 10.0 ** (bands / 10.0)
    spectrum = profile_spectrum(surface, window=length, steepest=np.inf)
    edges = spectrum.wavenumber[:1] - 0.5 * spectrum.width[:1]
    edges = np.concatenate([edges, spectrum.wavenumber + 0.5 * spectrum.width])
    # variance of all shorter waves, of which the least are summed first
    shorter = np.append(np.cumsum((spectrum.density * spectrum.width)[::-1])[::-1], 0.0)
    ends = middle[:, None] * [1.0 / _HALF_BAND, _HALF_BAND]
    variance = -np.diff(np.interp(ends, edges, shorter), axis=1)[:, 0]
    nominal = np.array([_PREFERRED[n % 10] * 10.0 ** (n // 10) for n in bands])
    with np.errstate(divide="ignore"):  # a flat line
        level = 10.0 * np.log10(variance / _REFERENCE**2)
    about = {"units": "dB", "long_name": "third-octave texture level re 1 um, ISO 13473-4"}
    lengths = {"units": "m", "long_name": "texture wavelength"}
    return xr.Dataset(
        {"level": ("wavelength", level, about)}, {"wavelength": ("wavelength", nominal, lengths)}
    )
