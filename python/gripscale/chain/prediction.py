"""What the chain answers: the waves solved, and area and friction down to each of them.

    real area    A_r/A_0  = prod A_i / lambda_i
    friction     mu_r     = sum mu_i

Lind & Wangenheim 2014, IMECE2014-37998, equations 2 and 3. The friction sum conserves energy,
because the pressure on a wave times the area fraction above it is the nominal pressure.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gripscale import checks, model, versions
from gripscale.chain.pressure import CLASS_PRESSURES
from gripscale.conditions.conditions import Conditions
from gripscale.cut_off_exponents import NOT_CONVERGED, CutOffExponents, of_curve
from gripscale.errors import InputError
from gripscale.model import NominalLoad
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import Extrapolation, of_sum
from gripscale.surface import SineStack
from gripscale.wave.result import WaveResult
from gripscale.wave.status import Status

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Prediction:
    """Contact and friction of a stack of waves (m, Pa, m/s).

    A wave that did not converge is kept, last, with its status: the totals are then NaN.
    """

    rubber: Rubber
    """As it was given; conditions may change it on the way, see `WaveResult.rubber`."""
    sines: SineStack
    load: NominalLoad
    scales: list[WaveResult]
    planned: int
    """Number of waves to solve."""
    conditions: Conditions | None = None
    """What changed the rubber on the way, and the area term."""

    @property
    def status(self) -> Status:
        """`converged` if every wave solved so far may be used, else the status of the last."""
        return self.scales[-1].status if self.scales else Status.CONVERGED

    @property
    def converged(self) -> bool:
        """Whether every wave solved so far may be used."""
        return all(scale.converged for scale in self.scales)

    @property
    def running_contact_fraction(self) -> Array:
        """A_r/A_0 down to each wave (equation 2); NaN from a failed wave on."""
        each = self._of_converged([s.contact_fraction for s in self.scales])
        return np.asarray(np.cumprod(each), dtype=float)

    @property
    def running_friction(self) -> Array:
        """Friction coefficient down to each wave (equation 3); NaN from a failed wave on."""
        each = self._of_converged([s.friction for s in self.scales])
        return np.asarray(np.cumsum(each), dtype=float)

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area, A_r/A_0, of all waves [-]."""
        return float(self.running_contact_fraction[-1]) if self.scales else math.nan

    @property
    def friction(self) -> float:
        """Friction coefficient of all waves [-]."""
        return float(self.running_friction[-1]) if self.scales else math.nan

    @property
    def friction_from_dissipation(self) -> float:
        """Friction coefficient of all waves from the energy lost in the rubber [-]."""
        each = self._of_converged([s.friction_from_dissipation for s in self.scales])
        return float(each.sum()) if self.scales else math.nan

    @property
    def adhesive_friction(self) -> float:
        """Friction coefficient of the area term [-], NaN where none was asked for or at rest."""
        if self.conditions is None or not self.scales:
            return math.nan
        kelvin = self.scales[-1].details.get("contact_temperature")
        if kelvin is None:
            kelvin = self.conditions.temperature_of(self.rubber)
        load = self.load
        return self.conditions.adhesive_friction(
            self.contact_fraction, load.pressure, load.speed, kelvin
        )

    @property
    def total_friction(self) -> float:
        """Hysteresis and area term together [-], NaN where no area term was asked for."""
        return self.friction + self.adhesive_friction

    @property
    def extrapolation(self) -> Extrapolation:
        """What of it rests on the rubber beyond its measured frequencies."""
        friction = self._of_converged([s.friction for s in self.scales])
        return of_sum([scale.extrapolation for scale in self.scales], friction)

    @property
    def cut_off_exponents(self) -> CutOffExponents:
        """How it changes with the cut-off length, over the last octave of its own waves."""
        if not self.converged:
            return NOT_CONVERGED
        return of_curve(
            [scale.wavelength for scale in self.scales],
            self.running_contact_fraction,
            self.running_friction,
            moving=self.load.speed > 0.0,
        )

    @property
    def why(self) -> str:
        """`converged`, or which wave failed and why."""
        return "converged" if self.converged else self.failure()

    def failure(self) -> str:
        """Return a sentence on the last wave, which did not converge."""
        scale = self.scales[-1]
        return (
            f"{self.place()} did not converge: {scale.why} after {scale.newton_iterations} "
            f"Newton iterations, residual {scale.residual:.2g}"
        )

    def place(self) -> str:
        """Return which wave the last one is, in words."""
        scale = self.scales[-1]
        return (
            f"wave {len(self.scales)} of {self.planned} "
            f"(wavelength {scale.wavelength * 1e3:.4g} mm, "
            f"amplitude {scale.amplitude * 1e3:.4g} mm, pressure {scale.pressure_received:.4g} Pa, "
            f"speed {scale.speed:.4g} m/s)"
        )

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over the dimension `scale`."""
        from gripscale.wave.dataset import CHAIN, LW, labelled, waves_to_dataset

        running = {
            "running_contact_fraction": (
                self.running_contact_fraction,
                "real over nominal contact area down to the wave",
                f"{LW}, equation 2",
            ),
            "running_friction": (
                self.running_friction,
                "friction coefficient down to the wave",
                f"{LW}, equation 3",
            ),
        }
        data = waves_to_dataset(self.scales).assign(
            {n: labelled("scale", values, "1", *words) for n, (values, *words) in running.items()}
            | {
                f"sines_{part}": labelled(
                    "wave", getattr(self.sines, part), "m", f"{part} of the waves", CHAIN
                )
                for part in ("wavelength", "amplitude")
            }
        )
        data = data.assign(_class_pressures(self.scales))
        totals = {
            "total_contact_fraction": self.contact_fraction,
            "total_friction": self.friction,
            "total_friction_from_dissipation": self.friction_from_dissipation,
        }
        data = data.assign_attrs(
            title="Real contact area and friction of rubber on a rough surface",
            rubber=f"{self.rubber.name}; {self.rubber.source}".strip("; "),
            rubber_parameters=json.dumps(self.rubber.to_dict()),
            planned_waves=self.planned,
            conditions=json.dumps(None if self.conditions is None else self.conditions.to_dict()),
            method=f"{LW}, equations 1 to 3",
            **versions.attributes(),
        )
        answer = model.answer(
            data,
            totals,
            self.why,
            "chain",
            self.load,
            self.extrapolation,
            self.cut_off_exponents,
        )
        return model.with_area_term(answer, self.adhesive_friction)

    @classmethod
    def from_dataset(cls, data: xr.Dataset) -> Prediction:
        """Return the prediction a Dataset was made of, in memory or read from a file.

        Raises `InputError` if it was made of something else.
        """
        import xarray as xr

        checks.instance("data", data, xr.Dataset)
        try:
            return cls._from_dataset(data)
        except (KeyError, TypeError, ValueError) as error:
            kind = data.attrs.get("model") or data.attrs.get("title") or "another kind"
            raise InputError(
                "data must be what `to_dataset` of a prediction of the chain returns; got a "
                f"Dataset of {kind}"
            ) from error

    @classmethod
    def _from_dataset(cls, data: xr.Dataset) -> Prediction:
        from gripscale.wave.dataset import waves_from_dataset

        stated = str(data.attrs["load_time"])
        conditions = json.loads(data.attrs.get("conditions", "null"))
        load = NominalLoad(
            pressure=float(data["nominal_pressure"]),
            speed=float(data["nominal_speed"]),
            footprint=float(data["footprint"]),
            load_time="passage" if stated == "passage" else float(stated),
        )
        return cls(
            rubber=Rubber.from_dict(json.loads(data.attrs["rubber_parameters"])),
            sines=SineStack(data["sines_wavelength"].values, data["sines_amplitude"].values),
            load=load,
            scales=_with_class_pressures(waves_from_dataset(data), data),
            planned=int(data.attrs["planned_waves"]),
            conditions=None if conditions is None else Conditions.from_dict(conditions),
        )

    def _of_converged(self, values: Sequence[float]) -> Array:
        usable = np.array([scale.converged for scale in self.scales], dtype=bool)
        return np.where(usable, np.array(values, dtype=float), math.nan)


def _class_pressures(scales: Sequence[WaveResult]) -> dict[str, xr.Variable]:
    """Return the pressures each wave was solved under, where there are several."""
    from gripscale.wave.dataset import CHAIN, labelled

    listed = [np.ravel(s.details.get(CLASS_PRESSURES, s.pressure_received)) for s in scales]
    most = max((len(pressures) for pressures in listed), default=0)
    if most < 2:
        return {}
    values = np.array([np.pad(p, (0, most - len(p)), constant_values=np.nan) for p in listed])
    words = "pressure on each class of equal load", CHAIN
    return {CLASS_PRESSURES: labelled(("scale", "pressure_class"), values, "Pa", *words)}


def _with_class_pressures(scales: list[WaveResult], data: xr.Dataset) -> list[WaveResult]:
    """Return the waves with the pressures they were solved under, if `data` has any."""
    if CLASS_PRESSURES not in data:
        return scales
    rows = [row[np.isfinite(row)] for row in data[CLASS_PRESSURES].values]
    return [
        replace(s, details={**s.details, CLASS_PRESSURES: row}) if len(row) > 1 else s
        for s, row in zip(scales, rows, strict=True)
    ]
