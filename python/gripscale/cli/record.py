"""What a run writes beside its chain, so that a report needs nothing but the result file.

Group `inputs`: the input files with their checksums, the profiles as drawn, their cleaning, the
height difference correlation and its fits, the master curve and its Prony series.
Group `solver`: the deformed meshes and further counts of the solver.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.case import CaseFile
from gripscale.chain import Prediction
from gripscale.cli.inputs import Measured, RubberStudy, SurfaceStudy
from gripscale.scale import ScaleResult
from gripscale.surface import Profile
from gripscale.textfile import read_bytes

Variables = dict[str, Any]
BINS = 1200
"""Pieces a profile is cut into for drawing; each keeps its lowest and its highest height."""
CLOSE_UP = 30e-3
"""Length of the piece of a profile that is kept point by point [m]."""


def inputs_group(file: CaseFile, surface: SurfaceStudy, rubber: RubberStudy) -> xr.Dataset:
    """Return everything a report says about the inputs of a case."""
    data, attrs = _waves(surface)
    for part in (_files(file), _rubber(rubber)):
        data |= part[0]
        attrs |= part[1]
    if surface.measured is not None:
        for part in (_profiles(surface.measured), _correlation(surface.measured)):
            data |= part[0]
            attrs |= part[1]
    return xr.Dataset(data, attrs={k: v for k, v in attrs.items() if v is not None})


def solver_group(prediction: Prediction) -> xr.Dataset:
    """Return the solver's own counts and estimates, and the deformed meshes [m].

    Meshes are in single precision, to be drawn, and padded with NaN to the size of the largest.
    """
    scales = prediction.scales
    data: Variables = {}
    for name in dict.fromkeys(name for scale in scales for name in scale.details):
        values = [scale.details.get(name, math.nan) for scale in scales]
        if all(isinstance(value, int | float) for value in values):
            data[name] = ("scale", np.array(values, dtype=float))
    for name in ("contact_fraction_error", "friction_error"):
        estimates = np.array([getattr(scale, name) for scale in scales])
        if np.isfinite(estimates).any():
            data[name] = ("scale", estimates)
    for name, layers in _meshes(scales).items():
        data[name] = (("scale", "layer", "column"), layers, {"units": "m"})
    return xr.Dataset(data)


def _meshes(scales: Sequence[ScaleResult]) -> dict[str, NDArray[np.float32]]:
    meshes = [scale.deformed_mesh for scale in scales]
    shapes = [mesh[0].shape for mesh in meshes if mesh is not None]
    if not shapes:
        return {}
    size = (len(scales), *(max(lengths) for lengths in zip(*shapes, strict=True)))
    out = {name: np.full(size, math.nan, dtype=np.float32) for name in ("mesh_x", "mesh_z")}
    for i, mesh in enumerate(meshes):
        for values, part in zip(out.values(), mesh or (), strict=False):
            values[i, : part.shape[0], : part.shape[1]] = part
    return out


def _files(file: CaseFile) -> tuple[Variables, Variables]:
    """Return names, sizes and checksums of the measured files of the case."""
    surface, rubber = file.case.surface.files or [], file.case.rubber.file
    named = [("surface", name) for name in surface]
    named += [("rubber", rubber)] if rubber is not None else []
    contents = [read_bytes(file.resolve(name)) for _, name in named]
    if not named:
        return {}, {}
    return {
        "file_role": ("file", _texts([role for role, _ in named])),
        "file_name": ("file", _texts([name for _, name in named])),
        "file_bytes": ("file", np.array([len(content) for content in contents])),
        "file_sha256": ("file", _texts([hashlib.sha256(c).hexdigest() for c in contents])),
    }, {}


def _waves(surface: SurfaceStudy) -> tuple[Variables, Variables]:
    sines = surface.sines
    low, high = sines.lag_range or (None, None)
    return {
        "wave_wavelength": ("wave", np.asarray(sines.wavelength), {"units": "m"}),
        "wave_amplitude": ("wave", np.asarray(sines.amplitude), {"units": "m"}),
    }, {
        "sines_s_wavelength": sines.s_wavelength,
        "sines_s_amplitude": sines.s_amplitude,
        "sines_residual_decades": sines.residual,
        "sines_lag_min_m": low,
        "sines_lag_max_m": high,
    }


def _profiles(measured: Measured) -> tuple[Variables, Variables]:
    """Return the profiles as drawn, and what each step of their cleaning did."""
    raw, cleaned = (list(column) for column in zip(*measured.profiles, strict=True))
    steps = measured.cleaning[0].steps
    data: Variables = {
        "profile_name": ("profile", _texts([p.name or Path(p.source).name for p in raw])),
        "profile_step": ("profile", np.array([p.step for p in raw]), {"units": "m"}),
        "profile_length": ("profile", np.array([p.length for p in raw]), {"units": "m"}),
        "profile_points": ("profile", np.array([len(p) for p in raw])),
        "cleaning_step_name": ("cleaning_step", _texts([step.step for step in steps])),
    }
    for field in ("points", "removed", "made_missing", "missing"):
        counts = [[getattr(step, field) for step in report] for report in measured.cleaning]
        data[f"cleaning_{field}"] = (("profile", "cleaning_step"), np.array(counts))
    notes = [[step.note for step in report] for report in measured.cleaning]
    data["cleaning_note"] = (("profile", "cleaning_step"), _texts(notes))
    for name, profiles in (("read", raw), ("cleaned", cleaned)):
        drawn = np.array([_envelope(profile) for profile in profiles])
        for i, part in enumerate(("x", "lowest", "highest")):
            data[f"{name}_{part}"] = (("profile", "bin"), drawn[:, i], {"units": "m"})
    pieces = [_close_up(profile) for profile in cleaned]
    longest = min(piece.shape[1] for piece in pieces)
    for i, part in enumerate("xz"):
        values = np.array([piece[i, :longest] for piece in pieces])
        data[f"close_up_{part}"] = (("profile", "close_up_point"), values, {"units": "m"})
    return data, {}


def _envelope(profile: Profile) -> NDArray[np.float64]:
    """Return middle [m], lowest and highest height [m] of `BINS` pieces; NaN where none is."""
    edges = np.linspace(0, len(profile), min(BINS, len(profile)) + 1).astype(int)
    out = np.full((3, BINS), math.nan)
    for i, (first, past) in enumerate(pairwise(edges)):
        heights = profile.z[first:past]
        heights = heights[np.isfinite(heights)]
        out[0, i] = profile.x[first:past].mean()
        if heights.size:
            out[1:, i] = heights.min(), heights.max()
    return out


def _close_up(profile: Profile) -> NDArray[np.float64]:
    """Return distance and height [m] of a piece from the middle, point by point."""
    start = 0.5 * (profile.x[0] + profile.x[-1])
    inside = (profile.x >= start) & (profile.x <= start + CLOSE_UP)
    return np.array([profile.x[inside], profile.z[inside]])


def _correlation(measured: Measured) -> tuple[Variables, Variables]:
    hdc, fit = measured.correlation, measured.self_affine
    data: Variables = {"lag": ("lag", np.asarray(hdc.lag), {"units": "m"})}
    for name in ("value", "lower", "upper"):
        values = np.asarray(getattr(hdc, name))
        data[f"correlation_{name}"] = ("lag", values, {"units": "m^2"})
    data["correlation_pairs"] = ("lag", np.asarray(hdc.pairs))
    if fit is None:
        return data, {"no_self_affine": measured.no_self_affine}
    return data, {
        "self_affine_hurst": fit.hurst,
        "self_affine_xi_parallel_m": fit.xi_parallel,
        "self_affine_xi_perpendicular_m": fit.xi_perpendicular,
        "self_affine_lag_min_m": fit.lag_min,
        "self_affine_lag_max_m": fit.lag_max,
        "self_affine_residual_decades": fit.residual,
    }


def _rubber(study: RubberStudy) -> tuple[Variables, Variables]:
    rubber, master, fit = study.rubber, study.master, study.fit
    low, high = rubber.valid_band or (None, None)
    attrs: Variables = {
        "rubber_name": rubber.name,
        "strain_energy": str(rubber.strain_energy),
        "equilibrium_modulus_Pa": rubber.equilibrium_modulus,
        "bulk_modulus_Pa": rubber.bulk_modulus,
        "band_low_rad_per_s": low,
        "band_high_rad_per_s": high,
    }
    data: Variables = {}
    if len(rubber.moduli):
        times = np.asarray(rubber.relaxation_times)
        data["term_relaxation_time"] = ("term", times, {"units": "s"})
        data["term_modulus"] = ("term", np.asarray(rubber.moduli), {"units": "Pa"})
    if master is not None:
        attrs["reference_temperature_K"] = master.reference_temperature
        columns = {"frequency": "Hz", "storage": "Pa", "loss": "Pa"}
        for name, unit in columns.items():
            values = np.asarray(getattr(master, name))
            data[f"master_{name}"] = ("row", values, {"units": unit})
    if master is not None and fit is not None:
        out = np.isin(master.frequency, fit.outlier_frequency)
        data["master_left_out"] = ("row", out.astype(np.int8))
        attrs |= {
            "prony_rms_storage": fit.rms_storage,
            "prony_rms_loss": fit.rms_loss,
            "prony_rms_loss_factor": fit.rms_loss_factor,
            "prony_mean_loss_factor_error": fit.mean_loss_factor_error,
            "prony_storage_scatter": fit.storage_scatter,
            "prony_loss_scatter": fit.loss_scatter,
            "prony_consistent": int(fit.consistent),
        }
    return data, attrs


def _texts(values: Sequence[Any]) -> NDArray[np.object_]:
    return np.array(values, dtype=object)
