"""The source `modulus`: what the measured moduli leave open, see `gripscale.uncertainty.series`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from gripscale.rubber import Rubber
from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.series import Array, SeriesScatter, with_series
from gripscale.uncertainty.sources.source import Coordinate, NotHere, Stated


@dataclass(frozen=True, eq=False)
class ModulusSource:
    """The Prony series is drawn among those the measurement leaves open."""

    name: ClassVar[str] = "modulus"
    label: ClassVar[str] = "scatter and ends of the moduli"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        f"{name}_{wave}_wave": Coordinate(
            "1", f"ln of {text} over the fitted one, at the {wave} wave", True
        )
        for wave in ("largest", "smallest")
        for name, text in (("modulus", "|E*|"), ("loss", "E''/E'"))
    }

    series: SeriesScatter
    omega: Array
    """Where the draws are told apart [rad/s]: excitation by the largest and the smallest wave."""

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> ModulusSource:
        """Return the source of a case; raise `NotHere` without a measured master curve."""
        if known.master is None or known.fit is None:
            raise NotHere("no moduli were measured")
        sines, band = known.surface.sines, known.fit.measured_band
        excited = 2.0 * np.pi * known.speed / sines.wavelength[[0, -1]]
        return cls(
            SeriesScatter.of(known.master, known.fit, known.rubber.bulk_modulus),
            excited if known.speed > 0.0 else np.array(band),
        )

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with a series; series have no order that `place` could follow."""
        drawn = with_series(inputs.rubber, self.series.draw(random))
        ratios = (_told(drawn, self.omega) - _told(inputs.rubber, self.omega)).ravel()
        return replace(inputs, rubber=drawn), dict(
            zip(self.coordinates, map(float, ratios), strict=True)
        )


def _told(rubber: Rubber, omega: Array) -> Array:
    """Return ln |E*| and ln E''/E' at each frequency, shape (frequencies, 2)."""
    modulus = rubber.complex_modulus(omega)
    parts = np.stack([np.abs(modulus), modulus.imag / modulus.real], axis=-1)
    return np.asarray(np.log(parts))
