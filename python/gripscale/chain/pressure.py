"""What a wave hands down: the pressure on the parts of its contact, in classes of equal load.

The mean pressure of the contact of wave i, p_(i+1) = p_i lambda_i / A_i (Lind & Wangenheim 2014,
IMECE2014-37998, equation 1), is one class. The pressure under a crest is not uniform, though, and
neither the contact of the next wave nor its friction is linear in the pressure. So the contact is
cut, from low to high pressure, into N classes that carry the same load:

    a_n = int dF / p    over the n-th of N equal shares of the load F,    p_n = p_1 / (N a_n)

with a_n the area of the class over the nominal area and p_1 the nominal pressure: load and area in
contact are kept exactly. The next wave is solved under each p_n. Of what it hands down in its turn,
N classes are made again: the cost grows as waves times classes, not as a tree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gripscale.errors import InputError
from gripscale.wave.result import WaveResult

Array = NDArray[np.float64]

MOST_CLASSES = 64
"""Classes beyond which a wave is not cut up."""

CLASS_PRESSURES = "class_pressures"
"""Name of the pressures a wave was solved under [Pa], among the details of its result."""


@dataclass(frozen=True)
class PressureClasses:
    """Parts of the nominal area under one pressure each, all carrying the same load."""

    pressure: Array
    """On each class [Pa], rising."""
    area: Array
    """Of each class over the nominal area [-]."""

    @classmethod
    def uniform(cls, pressure: float) -> PressureClasses:
        """Return the whole nominal area under one pressure."""
        return cls(np.array([pressure]), np.ones(1))

    @property
    def mean(self) -> float:
        """Mean pressure on the area of all classes [Pa]."""
        return float(self.pressure @ self.area / self.area.sum())

    def handed_down(self, solved: Sequence[WaveResult], count: int) -> PressureClasses:
        """Return `count` classes of what waves solved under each class hand down.

        Raises `InputError` if there are several, and a solver does not say where the pressure is.
        """
        if count == len(solved) == 1:
            wave, area = solved[0], self.area * solved[0].contact_fraction
            # equation 1; unchanged in full contact
            return PressureClasses(self.pressure * wave.wavelength / wave.contact_length, area)
        parts = [_contact_of(wave) for wave in solved]
        area = np.concatenate([a * part for a, (part, _) in zip(self.area, parts, strict=True)])
        pressure = np.concatenate([on_part for _, on_part in parts])
        order = np.argsort(pressure)
        load = np.append(0.0, np.cumsum((area * pressure)[order]))
        below = np.append(0.0, np.cumsum(area[order]))
        own = np.diff(np.interp(np.linspace(0.0, load[-1], count + 1), load, below))
        return PressureClasses(load[-1] / (count * own), own)

    def together(self, solved: Sequence[WaveResult]) -> WaveResult:
        """Return one result for a wave solved under each class.

        Contact fractions are averaged by area, frictions by load, the worst stretch, residual and
        status count, iterations are added. Pressure and deformed mesh are those of the class
        nearest to the mean pressure.
        """
        failed = [wave for wave in solved if not usable(wave)]
        if failed or len(solved) == 1:
            return (failed or list(solved))[0]
        nearest = solved[int(np.argmin(np.abs(self.pressure - self.mean)))]

        def average(name: str, weight: Array) -> float:
            return float(np.average([getattr(wave, name) for wave in solved], weights=weight))

        by_load = self.area * self.pressure
        return replace(
            nearest,
            pressure_received=self.mean,
            contact_fraction=average("contact_fraction", self.area),
            contact_fraction_error=average("contact_fraction_error", self.area),
            friction=average("friction", by_load),
            friction_from_dissipation=average("friction_from_dissipation", by_load),
            friction_error=average("friction_error", by_load),
            newton_iterations=sum(wave.newton_iterations for wave in solved),
            residual=max(wave.residual for wave in solved),
            min_stretch=min(wave.min_stretch for wave in solved),
            max_stretch=max(wave.max_stretch for wave in solved),
            details={**nearest.details, CLASS_PRESSURES: self.pressure},
        )


def usable(wave: WaveResult) -> bool:
    """Return whether a wave may hand its pressure on: converged, and in contact."""
    return wave.converged and 0.0 < wave.contact_fraction <= 1.0


def _contact_of(wave: WaveResult) -> tuple[Array, Array]:
    """Return share of the wavelength and pressure [Pa] of each node in contact.

    Nodes do not end where the contact does: shares are scaled to the contact fraction, pressures
    to the load.
    """
    after = np.append(wave.x[1:], wave.x[0] + wave.wavelength)
    before = np.insert(wave.x[:-1], 0, wave.x[-1] - wave.wavelength)
    touching = wave.pressure > 0.0
    if not touching.any():
        raise InputError(
            "pressure_classes must be 1 for a solver that gives no pressure along the wave; "
            f"got none above zero from {wave.model}"
        )
    share = (after - before)[touching]
    share *= wave.contact_fraction / share.sum()
    pressure = wave.pressure[touching]
    return share, pressure * (wave.pressure_received / (share @ pressure))
