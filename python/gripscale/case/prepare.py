"""From the surface a case names to what a model needs: cleaned profiles, sine waves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from gripscale.case.surface_table import Surface
from gripscale.errors import GripscaleError, InputError, about_keys
from gripscale.surface import (
    CleaningReport,
    CutOffRule,
    HeightDifference,
    HeightMap,
    Measured,
    PreparedSurface,
    Profile,
    SelfAffineFit,
    SineStack,
    clean,
    clean_map,
    find_cut_off,
    fit_self_affine,
    fit_sines,
    height_difference,
    read_map,
    read_profile,
)

Resolve = Callable[[str], Path]

FIT_KEYS = (
    "scales",
    "smallest_wavelength",
    "cut_off",
    "s_wavelength",
    "s_amplitude",
    "first_wavelength",
    "first_amplitude",
    "single_factor",
    "smallest_lag",
    "largest_lag",
)
"""Keys of the case's [surface] that say how sine waves are fitted."""

COUNTED_KEYS = ("upper_share", "max_lag")
"""Keys of the case's [surface] that say which heights and lags count in the correlation."""


@about_keys("surface")
def prepare_surface(surface: Surface, resolve: Resolve = Path) -> PreparedSurface:
    """Read, clean and describe the profiles or the map of `surface`, or take its waves as stated.

    `resolve` turns the name of a file into its path.

    Raises `FileError` and `InputError` as reading, cleaning and fitting do.
    """
    if surface.sines is not None:
        stack = SineStack(
            wavelength=np.array([wave.wavelength for wave in surface.sines]),
            amplitude=np.array([wave.amplitude for wave in surface.sines]),
        )
        return PreparedSurface(stack, "sine waves stated in the case")
    paths = [resolve(name) for name in surface.measured_files]
    measured = _map(surface, paths[0]) if surface.map else _profiles(surface, paths)
    counted = {key: getattr(surface, key) for key in COUNTED_KEYS}
    correlation = height_difference(measured.cleaned, **counted)
    self_affine, why_not = _self_affine(correlation)
    measured = replace(measured, self_affine=self_affine, no_self_affine=why_not)
    fit = {key: getattr(surface, key) for key in FIT_KEYS}
    if surface.cut_off is not None:
        where = str(paths[0]) if len(paths) == 1 else f"{len(paths)} profiles"
        fit["cut_off"] = _cut_off(measured, surface.cut_off, where)
    return PreparedSurface(
        fit_sines(correlation, **fit),
        ", ".join(str(path) for path in paths),
        correlation,
        fit,
        measured,
        counted,
        surface.cut_off,
    )


def _cut_off(measured: Measured, rule: CutOffRule, where: str) -> float:
    """Return where the roughness ends [m]; an error begins with `where`."""
    if isinstance(rule, float):
        return rule
    try:
        return find_cut_off(measured.slopes, rule).wavelength
    except InputError as error:
        raise InputError(f"{where}: {error}") from error


def _profiles(surface: Surface, paths: list[Path]) -> Measured:
    """Read and clean profiles."""
    profiles, reports = [], []
    for path in paths:
        raw = read_profile(
            path,
            x_unit=surface.x_unit,
            z_unit=surface.z_unit,
            direction=surface.direction,
            channel=surface.channel,
            sheet=surface.sheet,
            reader=surface.reader,
        )
        cleaned, report = _clean(raw, surface, path)
        profiles.append((raw, cleaned))
        reports.append(report)
    return Measured(profiles, reports, None, "")


def _map(surface: Surface, path: Path) -> Measured:
    """Read and clean a map, turned so that its x is the way of sliding."""
    raw = read_map(
        path,
        x_unit=surface.x_unit,
        z_unit=surface.z_unit,
        step=_pair(surface.step),
        channel=surface.channel,
        reader=surface.reader,
    )
    raw = raw if surface.direction == "x" else raw.turned()
    try:
        cleaned, report = clean_map(
            raw,
            crop=(_pair(surface.crop), _pair(surface.crop_across)),
            valid_range=_pair(surface.valid_range),
            trim=surface.trim,
            remove_spikes=surface.remove_spikes,
            spike_slope=surface.spike_slope,
            form=surface.form,
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    return Measured([_middle(raw, cleaned)], [report], None, "", cleaned)


def _middle(raw: HeightMap, cleaned: HeightMap) -> tuple[Profile, Profile]:
    """Return one line as read and as cleaned: the fullest, nearest to the middle, to be shown."""
    away = np.abs(np.arange(cleaned.y.size) - cleaned.y.size // 2)
    fullest = np.lexsort((away, np.isnan(cleaned.z).sum(axis=0)))[0]
    one, other = (
        surface.line(int(np.argmin(np.abs(surface.y - cleaned.y[fullest]))))
        for surface in (raw, cleaned)
    )
    return one, replace(other, name=one.name, source=one.source)


def _clean(raw: Profile, surface: Surface, path: Path) -> tuple[Profile, CleaningReport]:
    """Clean `raw`; an error names the file, which the cleaning does not know."""
    try:
        return clean(
            raw,
            crop=_pair(surface.crop),
            valid_range=_pair(surface.valid_range),
            remove_spikes=surface.remove_spikes,
            spike_slope=surface.spike_slope,
            across_gaps=surface.across_gaps,
            detrend=surface.detrend,
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _self_affine(hdc: HeightDifference) -> tuple[SelfAffineFit | None, str]:
    """Fit what may not be there: the sine waves do not need a self-affine surface."""
    try:
        return fit_self_affine(hdc), ""
    except GripscaleError as error:
        return None, str(error)


def _pair(limits: list[float] | None) -> tuple[float, float] | None:
    return None if limits is None else (limits[0], limits[1])
