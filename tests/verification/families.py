"""Kinds of waves with what is known of them: solved by the tests here and by the benchmarks."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from gripscale import theory
from gripscale.wave import FiniteStrainBlock, Mesh, ScaleResult, Sine, WaveLoad, WaveProblem
from studies import shipped
from tests.closed_forms import contact_fraction
from tests.samples import ROOT

WAVELENGTH = 1e-3
AMPLITUDE = 1e-6
"""Of waves of small slope: finite strain is worth (k A)^2 = 4e-5 there."""
SLOPE = 2.0 * np.pi * AMPLITUDE / WAVELENGTH
RELAXED = 3e6
SPEED = 1.0

Row = dict[str, float]


@dataclass(frozen=True)
class Family:
    """Waves of one kind, with contact fractions and frictions known by other means."""

    name: str
    problems: tuple[WaveProblem, ...]
    contact_fraction: NDArray[np.float64]
    friction: NDArray[np.float64] | None = None
    """None where nothing slides."""
    depth: float = Mesh.depth

    def solve(self, mesh: Mesh, tolerance: float | None = None) -> list[ScaleResult]:
        """Solve all waves; none may fail."""
        block = FiniteStrainBlock(replace(mesh, depth=self.depth), tolerance)
        results = [block.solve(problem) for problem in self.problems]
        failed = [result for result in results if not result.converged]
        assert not failed, f"{self.name}: {failed[0]}"
        return results

    def area_errors(self, results: Sequence[ScaleResult]) -> NDArray[np.float64]:
        """Return errors of the contact fraction."""
        return np.array([result.contact_fraction for result in results]) - self.contact_fraction

    def friction_errors(
        self, results: Sequence[ScaleResult], measure: str = "friction"
    ) -> NDArray[np.float64]:
        """Return relative errors of the friction coefficient."""
        assert self.friction is not None
        return np.array([getattr(result, measure) for result in results]) / self.friction - 1.0

    def every(self, step: int) -> Family:
        """Return the family with every `step`-th wave."""
        friction = None if self.friction is None else self.friction[::step]
        return replace(
            self,
            problems=self.problems[::step],
            contact_fraction=self.contact_fraction[::step],
            friction=friction,
        )


def root_mean_square(errors: NDArray[np.float64]) -> float:
    """Return the rms of `errors`."""
    return float(np.sqrt(np.mean(np.square(errors))))


def worst(errors: NDArray[np.float64]) -> float:
    """Return the largest magnitude of `errors`."""
    return float(np.abs(errors).max())


def westergaard() -> Family:
    """Elastic contact at small slope, p/p* 0.1 to 0.9 (Westergaard, J. Appl. Mech. 6 (1939) 49)."""
    rubber = gs.Rubber(RELAXED, bulk_modulus=1e3 * RELAXED)
    full = theory.full_contact_pressure(
        rubber.plane_strain_modulus(1.0).real, wavelength=WAVELENGTH, amplitude=AMPLITUDE
    )
    ratios = np.linspace(0.1, 0.9, 9)
    return Family(
        "Westergaard",
        tuple(_wave(rubber, AMPLITUDE, ratio * full) for ratio in ratios),
        np.array([float(contact_fraction(ratio)) for ratio in ratios]),
    )


def finite_strain() -> Family:
    """Elastic contact at A/lambda = 0.1, K/G = 1000, p/(4 pi G A/lambda) = 0.1 to 0.9.

    Contact fractions converged with three other finite-element codes to 0.0002.
    """
    shear = RELAXED / 3.0
    fractions = {0.1: 0.20589, 0.3: 0.37276, 0.5: 0.50448, 0.7: 0.63081, 0.9: 0.77240}
    rubber = gs.Rubber(RELAXED, bulk_modulus=1e3 * shear)
    unit = 4.0 * np.pi * shear * 0.1
    problems = tuple(_wave(rubber, 0.1 * WAVELENGTH, ratio * unit) for ratio in fractions)
    return Family("finite strain", problems, np.array(list(fractions.values())), depth=1.0)


@cache
def zener_table() -> list[Row]:
    """Return the rows of the reference table of a sliding Zener half-plane."""
    path = ROOT / "tests" / "reference" / "zener_sliding_half_plane.csv"
    with path.open() as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def zener(least: float = 0.04, most: float = np.inf) -> Family:
    """Zener solid sliding at small slope: the rows of the table with mu/(kA) in a range.

    The table's frictions are good to 2e-4 of kA, its contact fractions to 0.001.
    """
    rows = [row for row in zener_table() if least < row["mu_over_kDelta_n1024"] <= most]
    return Family(
        "Zener",
        tuple(zener_wave(row) for row in rows),
        np.array([row["contact_ratio_n1024"] for row in rows]),
        SLOPE * np.array([row["mu_over_kDelta_n1024"] for row in rows]),
    )


def zener_wave(row: Row) -> WaveProblem:
    """Return the wave of one row of the table."""
    rubber = gs.Rubber(
        RELAXED,
        [(row["E_glassy_over_E_relaxed"] - 1.0) * RELAXED],
        [row["k_v_tau"] * WAVELENGTH / (2.0 * np.pi * SPEED)],
        bulk_modulus=1e4 * RELAXED,
    )
    # p*_relaxed = k A E_inf / (2 (1 - nu^2)) with nu = 1/2
    full = SLOPE * RELAXED / 1.5
    return _wave(rubber, AMPLITUDE, row["pbar_over_pstar_relaxed"] * full, SPEED)


def zener_loads(points: int = 4096) -> Family:
    """Zener solid, E_0/E_inf = 10, k v tau = 0.1, sixteen loads, against the half-plane model."""
    problems = tuple(
        zener_wave({"E_glassy_over_E_relaxed": 10.0, "pbar_over_pstar_relaxed": p, "k_v_tau": 0.1})
        for p in np.geomspace(0.1, 0.8, 16)
    )
    plane = theory.HalfPlane(points=points)
    return _against("Zener, many loads", problems, [plane.solve(one) for one in problems])


tread = cache(shipped.tread)
"""The measured tread rubber of the shipped case."""


def large_strain(*meshes: Mesh) -> Family:
    """Tread rubber sliding over a steep wave, A/lambda = 0.16, stretches 0.6 to 1.6 at 9 MPa.

    Known by the mean of the results on fine `meshes`.
    """
    problems = tuple(
        _wave(tread(), 0.16 * WAVELENGTH, pressure, 0.3, 5e-3)
        for pressure in (2e6, 3.5e6, 5e6, 7e6, 9e6)
    )
    fine = [FiniteStrainBlock(mesh) for mesh in meshes]
    return _against("large strain", problems, *([b.solve(p) for p in problems] for b in fine))


def _wave(
    rubber: gs.Rubber,
    amplitude: float,
    pressure: float,
    speed: float = 0.0,
    load_time: float = np.inf,
) -> WaveProblem:
    return WaveProblem(rubber, Sine(WAVELENGTH, amplitude), WaveLoad(pressure, speed, load_time))


def _against(
    name: str, problems: tuple[WaveProblem, ...], *results: Sequence[ScaleResult]
) -> Family:
    assert all(result.converged for many in results for result in many)
    fractions = np.array([[result.contact_fraction for result in many] for many in results])
    frictions = np.array([[result.friction for result in many] for many in results])
    return Family(name, problems, fractions.mean(axis=0), frictions.mean(axis=0))
