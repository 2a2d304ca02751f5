"""A block of layers that slides, each softened by its strain, against the half-space with the rule.

The block is a stack of layers, thin at the surface, each with E'(w) times f and E''(w) times g of
its amplitude, iterated with the contact. The amplitude of a layer is the mean of the equivalent
strain in it under the contact, as blocks at rest have it whose modulus follows the local strain
(`static`). A filler network that does not heal between two contacts has more: the "passing"
amplitude is the rms along the layer, weighted by the energy.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.fft

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.conditions.conditions import DEPTH_FACTOR
from gripscale.core import Array, ComplexArray, checked
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.rubber.softening import SofteningLaw, SofteningTable
from gripscale.surface import Profile
from gripscale.theory import layers as theory
from gripscale.theory.layers import Layers
from studies.strain_rule.lines import LENGTH, WAVES, line, rms_slope
from studies.strain_rule.static import AT, MEASURED_AT, MODULUS, SWEEPS_AT, pressures, sweep

GROWTH, THINNEST, DEEPEST = 1.4, 1.0 / 16.0, 1.0
"""Ratio of heights of layers, the first over the smallest wave, and all over the period."""
PASSES, CLOSE = 14, 0.01
SPEED = 0.3  # [m/s]


class Softened(Rubber, eq=False):
    """A rubber with E' times `storage` and E'' times `loss` at all frequencies."""

    factors: tuple[float, float] = checked(lambda _, value: tuple(value), default=(1.0, 1.0))

    def complex_modulus(self, angular_frequency: object) -> ComplexArray:
        """Return f E' + i g E'' [Pa]."""
        whole = super().complex_modulus(angular_frequency)  # type: ignore[arg-type]
        return np.asarray(self.factors[0] * whole.real + 1j * self.factors[1] * whole.imag)


def heights_of_layers(length: float, smallest: float) -> Array:
    """Return the heights of the layers [m], that in contact first."""
    heights = [THINNEST * smallest]
    while sum(heights) < DEEPEST * length:
        heights.append(GROWTH * heights[-1])
    return np.array(heights)


def strain_of_layers(
    contact: RoughContact,
    moduli: list[ComplexArray],
    bulk: float,
    thickness: Array,
    *,
    passing: bool,
) -> Array:
    """Return the amplitude of the uniaxial strain in each layer [-], shape (layers,)."""
    grid = contact.grid
    q = grid.wavenumber[1:]
    spectrum = scipy.fft.rfft(contact.pressure)[1:]
    lower: ComplexArray | None = None
    follows = []
    for modulus, height in zip(moduli[::-1], thickness[::-1], strict=True):
        shear, compression = theory.shear_and_compression(modulus[1:], bulk)
        stiffness = theory._layer_stiffness(q * height, shear, compression)
        upper = stiffness[:, 2:, 2:]
        if lower is not None:
            follow = -np.linalg.solve(stiffness[:, :2, :2] + lower, stiffness[:, :2, 2:])
            upper = upper + stiffness[:, 2:, :2] @ follow
            follows.append(follow)
        lower = upper
    assert lower is not None
    load = np.zeros((q.size, 2, 1), dtype=complex)
    load[:, 1] = 1.0
    displacement = np.linalg.solve(lower, load) / q[:, None, None]
    out = []
    for layer, height in enumerate(thickness):
        below = np.zeros_like(displacement)
        if layer < len(follows):
            below = follows[len(follows) - 1 - layer] @ displacement
        middle = 0.5 * (displacement + below)[:, :, 0]
        slope = (displacement - below)[:, :, 0] / height
        # displacements (i U, W): along, and in shear
        along, shear = -q * middle[:, 0], 0.5j * (slope[:, 0] + q * middle[:, 1])
        square = np.zeros(grid.points)
        for part in (along, shear):
            values = np.append(0.0, part * spectrum)
            square += 4.0 / 3.0 * scipy.fft.irfft(values, grid.points) ** 2
        if passing:
            out.append(np.sqrt(np.mean(square**2) / max(float(np.mean(square)), 1e-300)))
        else:
            out.append(DEPTH_FACTOR * np.sqrt(square)[contact.active].mean())
        displacement = below
    return np.array(out)


@dataclass(frozen=True)
class LayeredContact:
    """A contact of the layered block."""

    contact: RoughContact
    strain: Array  # amplitude in each layer [-]
    thickness: Array  # [m]
    change: float  # of ln strain in the last pass [-]


def solve_layers(
    rubber: Rubber,
    line: Profile,
    law: SofteningLaw | None,
    *,
    pressure: float,
    speed: float,
    smallest: float,
    passing: bool = False,
) -> LayeredContact:
    """Return the contact of the block whose layers are softened by the strain that passes them."""
    length = len(line) * line.step
    thickness = heights_of_layers(length, smallest)
    strain = np.full(thickness.size, 1e-3)
    change, contact = np.inf, None
    for number in range(PASSES if law is not None else 1):
        factors = [(1.0, 1.0)] * thickness.size
        if law is not None:
            at = law.factors(strain)
            factors = list(zip(at.storage.tolist(), at.loss.tolist(), strict=True))
        solids = [
            Softened(**{k: getattr(rubber, k) for k in rubber.__dataclass_fields__}, factors=f)
            for f in factors
        ]
        contact = gs.solve_rough_contact(
            Layers(list(zip(solids, thickness.tolist(), strict=True))),
            line,
            pressure=pressure,
            speed=speed,
            periodic=True,
            start=contact,
        )
        moduli = [solid.complex_modulus(speed * contact.grid.along) for solid in solids]
        new = strain_of_layers(contact, moduli, rubber.bulk_modulus, thickness, passing=passing)
        step = np.log(np.maximum(new, 1e-6)) - np.log(strain)
        deep = strain > 0.05 * strain.max()
        change = float(np.abs(step[deep]).max())
        strain = strain * np.exp(np.clip((1.0 if number == 0 else 0.6) * step, -5.0, 5.0))
        if change < CLOSE:
            break
    assert contact is not None
    return LayeredContact(contact, strain, thickness, change)


def sweep_law(name: str) -> SofteningLaw:
    """Return f and g of a sweep as measured."""
    path = SWEEPS_AT / f"{name}_strain_sweeps.csv"
    rows = np.genfromtxt(path, delimiter=",", skip_header=1)
    rows = rows[np.abs(rows[:, 0] - AT) < 2.0]
    strain, storage, loss = (rows[:, 2] / 100.0).tolist(), rows[:, 3].tolist(), rows[:, 4].tolist()
    return SofteningTable([strain], [storage], [loss], MEASURED_AT, "tension")


def solve(family: str, number: int, name: str, rubber: Rubber) -> list[dict[str, float | str]]:
    """Return one row for each load of a line and sweep, at `SPEED`."""
    whole, law, smallest = line(family, number), sweep_law(name), LENGTH / WAVES
    stiffness = abs(complex(rubber.complex_modulus(2.0 * np.pi * SPEED / (4.0 * smallest))))
    rows = []
    for load in pressures(whole.z, sweep(name)):
        at: dict[str, Any] = {"pressure": load * stiffness / MODULUS, "speed": SPEED}
        rule = gs.solve_rough_contact(
            rubber, whole, periodic=True, conditions=Conditions(softening=law), **at
        )
        hard = gs.solve_rough_contact(rubber, whole, periodic=True, **at)
        layers = solve_layers(rubber, whole, law, smallest=smallest, **at)
        passing = solve_layers(rubber, whole, law, smallest=smallest, passing=True, **at)
        row: dict[str, float | str] = {"family": family, "line": number, "sweep": name}
        row |= {"slope": rms_slope(whole.z), **at, "change": layers.change}
        row |= {"status": str(rule.status)}
        solved = {
            "rule": rule,
            "hard": hard,
            "layers": layers.contact,
            "passing": passing.contact,
        }
        for key, contact in solved.items():
            row[f"{key} area"] = contact.contact_fraction
            row[f"{key} friction"] = contact.friction_from_dissipation
        rows.append(row)
    return rows
