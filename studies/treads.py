"""The tread compounds whose dry friction was measured, as the studies take them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

import gripscale as gs
from gripscale.core import ZERO_CELSIUS, Array, ComplexArray
from gripscale.rubber import ShiftTable, StrainSweep
from gripscale.surface import ArealSpectrum
from studies.shipped import DATA

FRICTION = DATA / "friction"
SERIES_S, SERIES_R = ("S100", "S120", "S140"), ("R00", "R20", "R40", "R60")
REFERENCE = dict.fromkeys(SERIES_S, 40.0 + ZERO_CELSIUS) | dict.fromkeys(SERIES_R, 293.15)
"""Temperatures of the master curves [K]."""
S_SPEEDS_OVER_R = 25.0
"""Published speeds of the S series over those that are taken here, see SOURCE.txt."""
LAST_WAVENUMBER = 1.05129e5
"""Where the publisher ends the road's spectrum [rad/m], 60 um."""


def table(name: str) -> Array:
    """Return the numbers of a file; shape (rows, columns)."""
    return np.loadtxt(FRICTION / f"{name}.csv", delimiter=",", skiprows=1)


@lru_cache
def compound(name: str, temperature: float = 293.15) -> gs.Rubber:
    """Return a compound at a temperature [K], with its measured shift."""
    celsius, a_t = table(f"{name}_shift").T
    order = np.argsort(celsius)
    # The row next to the reference is where a_T is one.
    kelvin = celsius[order] + ZERO_CELSIUS
    kelvin[np.argmin(np.abs(kelvin - REFERENCE[name]))] = REFERENCE[name]
    shift = ShiftTable(kelvin, np.log10(a_t[order]), reference_temperature=REFERENCE[name])
    frequency, storage, loss = table(f"{name}_master_curve").T
    curve = gs.MasterCurve(
        frequency, storage, loss, reference_temperature=REFERENCE[name], shift=shift, name=name
    )
    return gs.fit_prony(curve).at(temperature)


class MeasuredModuli(gs.Rubber):
    """Moduli as measured, between the rows in the logarithms, without a series; E = 3 G.

    A series misses the moduli of these compounds by up to a tenth, as no passive solid has both.
    """

    rows: tuple[tuple[float, ...], ...] = ()
    """Rising angular frequencies [rad/s], E' and E'' [Pa]."""

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return E* [Pa] at `omega` [rad/s], the ends held."""
        at = np.log(np.maximum(omega, self.rows[0][0]))
        frequency, storage, loss = np.log(self.rows)
        real, imaginary = (np.exp(np.interp(at, frequency, row)) for row in (storage, loss))
        return np.asarray(real + 1j * imaginary)


def measured_moduli(name: str, temperature: float = 293.15) -> MeasuredModuli:
    """Return the moduli of a compound at a temperature [K]."""
    fitted = compound(name, temperature)
    assert fitted.shift is not None
    rows = table(f"{name}_master_curve")
    frequency, storage, loss = rows[np.argsort(rows[:, 0])].T
    omega = 2.0 * np.pi * frequency / fitted.shift.a(temperature, REFERENCE[name])
    return MeasuredModuli(
        1e6,
        bulk_modulus=1e13,
        name=name,
        reference_temperature=temperature,
        rows=tuple(tuple(row.tolist()) for row in (omega, storage, loss)),
    )


def sweeps(name: str) -> dict[float, StrainSweep]:
    """Return the sweeps of a compound of the S series by their rounded temperature [C].

    Whether the strain is of tension or of shear is not stated.
    """
    rows = table(f"{name}_strain_sweeps")
    if name == "S120":
        rows = np.delete(rows, 1, axis=0)  # a row of another sweep
    celsius = np.round(rows[:, 0], -1)
    return {
        at: StrainSweep(1e-2 * of[:, 2], of[:, 3], of[:, 4], None, at + ZERO_CELSIUS, 1.0, name)
        for at in np.unique(celsius).tolist()
        for of in [rows[celsius == at]]
    }


def dry_friction(name: str) -> tuple[Array, Array]:
    """Return speeds [m/s] and measured friction of a compound on the road."""
    speed, friction = table(f"{name}_friction").T
    return speed / (S_SPEEDS_OVER_R if name in SERIES_S else 1.0), friction


def road_spectrum(*, whole: bool = False) -> ArealSpectrum:
    """Return the spectrum of the road, down to where the publisher ends it or the whole of it."""
    wavenumber, density = table("road_spectrum").T
    measured = ArealSpectrum(wavenumber, density)
    if whole:
        return measured
    ended = np.append(wavenumber[wavenumber < LAST_WAVENUMBER], LAST_WAVENUMBER)
    return ArealSpectrum(ended, measured.at(ended))
