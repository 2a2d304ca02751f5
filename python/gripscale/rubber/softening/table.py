"""Strain softening as measured: a strain sweep, or one for each of several temperatures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.softening.law import (
    UNIAXIAL_OF_SHEAR,
    Array,
    Deformation,
    SofteningFactors,
)


@dataclass(frozen=True)
class SofteningTable:
    """Moduli of strain sweeps, interpolated in the logarithms of strain and modulus.

    Beyond the largest strain the last moduli are held and flagged; between two temperatures the
    factors are interpolated linearly, beyond them those of the nearest are held and flagged.

    Parameters
    ----------
    strain : sequence of sequences of floats
        Amplitudes of each sweep [-], rising.
    storage, loss : sequence of sequences of floats
        Moduli of each sweep, in any unit: only ratios count.
    measured_at : float
        Strain amplitude at which the master curve was measured [-]: both factors are one there.
    deformation : "tension" or "shear"
        Kind of the strains.
    temperature : sequence of floats, optional
        Of each sweep [K], rising; needed if there are several.

    Raises
    ------
    InputError
        If a value cannot be used, lengths differ, or `measured_at` lies outside a sweep.
    """

    kind: ClassVar[str] = "table"

    strain: Sequence[Sequence[float]]
    storage: Sequence[Sequence[float]]
    loss: Sequence[Sequence[float]]
    measured_at: float
    deformation: Deformation
    temperature: Sequence[float] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "measured_at", checks.positive("measured_at", self.measured_at))
        checks.one_of("deformation", self.deformation, ["tension", "shear"])
        for name in ("strain", "storage", "loss"):
            object.__setattr__(self, name, _sweeps(name, getattr(self, name)))
        self._check_sweeps()
        if self.temperature is not None:
            kelvin = checks.positive_vector("temperature", self.temperature, unit="K")
            object.__setattr__(self, "temperature", tuple(kelvin.tolist()))
        self._check_temperatures()

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        Raises `InputError` if sweeps at several temperatures are asked without one.
        """
        amplitude = np.asarray(strain, dtype=float)
        if self.deformation == "shear":
            amplitude = amplitude / UNIAXIAL_OF_SHEAR
        share, beyond = self._place(temperature)
        used = [(float(w), n) for n, w in enumerate(share) if w > 0.0]
        out = [(w, *self._one(n, amplitude)) for w, n in used]
        return SofteningFactors(
            storage=np.asarray(sum(w * f for w, f, _ in out)),
            loss=np.asarray(sum(w * g for w, _, g in out)),
            outside=(amplitude > max(self.strain[n][-1] for _, n in used)) | beyond,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return kind and numbers."""
        return {"kind": self.kind, **self.__dict__}

    def _one(self, number: int, strain: Array) -> tuple[Array, Array]:
        at = np.log(np.maximum(strain, self.measured_at))
        own = np.log(self.strain[number])

        def ratio(modulus: Sequence[float]) -> Array:
            logs = np.log(modulus)
            reference = np.interp(np.log(self.measured_at), own, logs)
            return np.asarray(np.exp(np.interp(at, own, logs) - reference))

        return ratio(self.storage[number]), ratio(self.loss[number])

    def _place(self, temperature: float | None) -> tuple[Array, bool]:
        """Return the weight of each sweep, and whether the temperature lies beyond them."""
        count = len(self.strain)
        if self.temperature is None or (count == 1 and temperature is None):
            return np.ones(1), False
        if temperature is None:
            raise InputError(
                "temperature must be given for softening measured at several temperatures"
            )
        own = np.array(self.temperature)
        beyond = not own[0] <= temperature <= own[-1]
        rows = np.eye(count)
        return np.array([np.interp(temperature, own, row) for row in rows]), beyond

    def _check_sweeps(self) -> None:
        lengths = [
            [len(one) for one in sweeps] for sweeps in (self.strain, self.storage, self.loss)
        ]
        if lengths[0] != lengths[1] or lengths[0] != lengths[2]:
            raise InputError(
                "strain, storage and loss must have equally many values in every sweep; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        for one in self.strain:
            if len(one) < 2 or not (np.diff(one) > 0.0).all():
                raise InputError(
                    f"strain must rise over at least 2 values; got {checks.shown(list(one))}"
                )
            if not one[0] <= self.measured_at <= one[-1]:
                raise InputError(
                    f"measured_at must lie within the strains of every sweep, {one[0]:g} to "
                    f"{one[-1]:g}; got {self.measured_at:g}"
                )

    def _check_temperatures(self) -> None:
        count, kelvin = len(self.strain), self.temperature
        if kelvin is None and count == 1:
            return
        if kelvin is None or len(kelvin) != count or not (np.diff(kelvin) > 0.0).all():
            raise InputError(
                f"temperature must be one for each of the {count} sweeps, rising; "
                f"got {checks.shown(kelvin)}"
            )


def _sweeps(name: str, values: Any) -> tuple[tuple[float, ...], ...]:
    try:
        rows = list(values)
    except TypeError:
        rows = []
    if not rows:
        raise InputError(f"{name} must hold at least one sweep; got {checks.shown(values)}")
    return tuple(tuple(checks.positive_vector(name, row).tolist()) for row in rows)
