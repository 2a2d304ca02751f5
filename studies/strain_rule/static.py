"""The block at rest, whose secant modulus follows a sweep, against the half-space with the rule.

Heights, pressures and strains of the sweep are a twentieth of the real ones: the block then has the
small strains of the half-space, and what differs is the rule alone. Ratios of softened to
unsoftened areas also cancel the errors of mesh and grid.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any
from unittest.mock import patch

import numpy as np
import scipy.fft
from scipy.optimize import least_squares

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.core import Array, ComplexArray, Mask
from gripscale.half_space.conditions import strain_by_scale
from gripscale.half_space.grid import Grid
from gripscale.rubber.softening import Kraus
from gripscale.rubber.strain_energy import KrausEnergy
from gripscale.surface import Profile
from gripscale.wave.result import ScaleResult
from studies.shipped import DATA
from studies.strain_rule.lines import line, rms_slope

SWEEPS_AT = DATA / "friction"
SWEEPS = ("S100", "S120", "S140")
AT = 30.0  # temperature of the sweeps [C]
MEASURED_AT = 1e-3
MODULUS = 1e7
FLATTER = 0.05
AREAS = (0.04, 0.1, 0.22, 0.45)
"""Contact fractions aimed at by the four loads."""
FACTORS = (0.4, 0.5)
"""Strain over rms slope in the contact."""


@dataclass(frozen=True)
class Sweep:
    """Kraus' law with exponent 1/2 through a sweep, in strain of length."""

    ratio: float
    critical: float
    misfit: float  # rms of ln E' [-]

    def kept(self, strain: float) -> float:
        """Return the modulus at a strain over that at `MEASURED_AT` [-]."""
        low, high = (
            self.ratio + (1.0 - self.ratio) / (1.0 + e / self.critical)
            for e in (MEASURED_AT, np.hypot(strain, MEASURED_AT))
        )
        return float(high / low)


@cache
def sweep(name: str) -> Sweep:
    """Return the law through the storage moduli of a sweep above `MEASURED_AT`."""
    rows = np.genfromtxt(SWEEPS_AT / f"{name}_strain_sweeps.csv", delimiter=",", skip_header=1)
    rows = rows[(np.abs(rows[:, 0] - AT) < 2.0) & (rows[:, 2] > 0.09)]
    strain, storage = rows[:, 2] / 100.0, rows[:, 3]

    def misfit(p: Array) -> Array:
        law = Sweep(1.0 / (1.0 + np.exp(-p[0])), float(np.exp(p[1])), 0.0)
        kept = np.log([law.kept(e) for e in strain])
        return np.asarray(kept - np.log(storage) + p[2])

    p = least_squares(misfit, [-2.0, np.log(0.05), np.log(storage[0])]).x
    error = float(np.sqrt(np.mean(misfit(p) ** 2)))
    return Sweep(float(1.0 / (1.0 + np.exp(-p[0]))), float(np.exp(p[1])), error)


def softening(law: Sweep, flatter: float = FLATTER) -> Conditions:
    """Return conditions with the softening of a sweep in strains `flatter` times the real ones."""
    strains = flatter * law.critical, flatter * MEASURED_AT
    return Conditions(softening=Kraus(law.ratio, 0.1, *strains, "tension", 0.5))


def slope_rule(factor: float, heights: Array) -> Callable[[Grid, Array, Mask, Array], Array]:
    """Return the rule of the slope on a line, in place of `strain_by_scale`."""

    def strain(grid: Grid, _: Array, active: Mask, wavenumber: Array) -> Array:
        slopes = [grid.slope(low_pass(grid, q))[active] for q in wavenumber]
        rms = [factor * np.sqrt(np.mean(slope**2)) for slope in slopes]
        return np.maximum.accumulate(np.array(rms))

    def low_pass(grid: Grid, largest: float) -> Array:
        spectrum = resample_spectrum(heights, grid.points)
        return np.asarray(
            scipy.fft.irfft(np.where(grid.wavenumber <= largest, spectrum, 0.0), grid.points)
        )

    return strain


def resample_spectrum(heights: Array, points: int) -> ComplexArray:
    """Return the spectrum of periodic heights on another number of points."""
    out, old = np.zeros(points // 2 + 1, dtype=complex), scipy.fft.rfft(heights)
    kept = min(out.size, old.size)
    out[:kept] = old[:kept] * (points / heights.size)
    return out


def pressures(heights: Array, law: Sweep) -> list[float]:
    """Return the loads [Pa] of the contact fractions aimed at, on real heights."""
    slope = rms_slope(heights)
    full = 0.5 * (4.0 / 3.0) * MODULUS * slope
    return [area * full * law.kept(0.4 * slope * min(1.0, 2.0 * area**0.5)) for area in AREAS]


def solve(family: str, number: int, name: str) -> list[dict[str, float | str]]:
    """Return one row for each load of a line and sweep."""
    law, whole = sweep(name), line(family, number)
    flat = Profile(whole.x, FLATTER * whole.z)
    shear = FLATTER * np.sqrt(3.0)  # of a uniaxial strain that stores the same energy
    energy = KrausEnergy(law.ratio, law.critical * shear, MEASURED_AT * shear)
    bulk = 1e3 * MODULUS
    hard = gs.Rubber(MODULUS, (), (), bulk_modulus=bulk)
    soft = gs.Rubber(MODULUS, (), (), bulk_modulus=bulk, strain_energy=energy)
    rows: list[dict[str, float | str]] = []
    start: dict[str, ScaleResult] = {}
    for load in pressures(whole.z, law):
        at: dict[str, Any] = {"pressure": FLATTER * load, "speed": 0.0, "periodic": True}
        row: dict[str, float | str] = {"family": family, "line": number, "sweep": name}
        row |= {"slope": rms_slope(whole.z), "pressure": load, "status": "converged"}
        for key, rubber in (("block", soft), ("block_hard", hard)):
            solved = gs.solve_profile(rubber, flat, start=start.get(key), workers=1, **at)
            row[key], start[key] = solved.contact_fraction, solved
            if not solved.converged:
                row["status"] = str(solved.status)
        row["hard"] = gs.solve_rough_contact(hard, flat, **at).contact_fraction
        for factor in (0.0, *FACTORS):
            rule = slope_rule(factor, flat.z) if factor else strain_by_scale
            with patch("gripscale.half_space.conditions.strain_by_scale", rule):
                contact = gs.solve_rough_contact(hard, flat, conditions=softening(law), **at)
            row[f"slope {factor}" if factor else "rule"] = contact.contact_fraction
            if not contact.converged and not factor:
                row["status"] = str(contact.status)
        rows.append(row)
    return rows
