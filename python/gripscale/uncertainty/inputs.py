"""What one sample is made of: the inputs of a case, as each source of uncertainty changes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from gripscale.case.results import CaseResults
from gripscale.chain.model import Chain
from gripscale.model import LoadTime, Model
from gripscale.rough.model import DirectContact
from gripscale.rubber import PronyFit, Rubber
from gripscale.rubber.master_curve import MasterCurve
from gripscale.surface import (
    HeightDifference,
    Measured,
    PreparedSurface,
    Profile,
    SineStack,
    fit_sines,
)
from gripscale.uncertainty.load_time import loaded_longer

END_KEYS = ("cut_off", "smallest_wavelength")
"""Arguments of `fit_sines` that say where the waves end."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """What a case is known from: prepared surface and rubber, and what they were fitted to."""

    surface: PreparedSurface
    rubber: Rubber
    master: MasterCurve | None = None
    fit: PronyFit | None = None
    speed: float = 0.0
    """Sliding speed of the case [m/s]."""
    load_time: LoadTime = "passage"

    @classmethod
    def of(cls, case: CaseResults) -> Measurement:
        """Return what a prepared case is known from."""
        rubber, load = case.rubber, case.load
        return cls(
            case.surface, rubber.rubber, rubber.master, rubber.fit, load.speed, load.load_time
        )

    @property
    def profiles(self) -> list[Profile]:
        """The cleaned profiles or the lines of a map; none of waves stated by hand."""
        return [] if self.surface.measured is None else self.surface.measured.cleaned

    @property
    def is_map(self) -> bool:
        """Whether a map was measured."""
        return self.surface.measured is not None and self.surface.measured.map is not None

    @property
    def fitted(self) -> bool:
        """Whether the waves were fitted to a measured correlation."""
        return self.surface.correlation is not None and bool(self.surface.fit)


@dataclass(frozen=True, eq=False)
class Inputs:
    """The inputs of one sample, before any model is asked.

    Attributes
    ----------
    surface, rubber
        As prepared, or as a source drew them.
    correlation
        What the waves are fitted to; None for waves stated by hand.
    fit
        Arguments of `fit_sines`.
    redrawn
        Gives what the direct contact is solved on, where it is not what was measured.
    load_time_factor
        How much longer each wave is loaded than the model says [-].
    """

    surface: PreparedSurface
    rubber: Rubber
    correlation: HeightDifference | None = None
    fit: Mapping[str, Any] = field(default_factory=dict)
    redrawn: Callable[[], tuple[Profile, ...]] | None = None
    load_time_factor: float = 1.0

    @classmethod
    def of(cls, known: Measurement) -> Inputs:
        """Return the inputs of the case itself."""
        surface = known.surface
        return cls(surface, known.rubber, surface.correlation, surface.fit)

    @property
    def end(self) -> float:
        """Where the waves end [m]: the cut-off or, without one, the last wave."""
        stated = (self.fit.get(name) for name in END_KEYS)
        return next((float(end) for end in stated if end), self.surface.sines.roughness_end)

    def ended_at(self, wavelength: float) -> Inputs:
        """Return the inputs with the end of the waves at a wavelength [m].

        It is the cut-off where the case states one, else the last wave.
        """
        name = "cut_off" if self.fit.get("cut_off") is not None else "smallest_wavelength"
        fit = {**self.fit, **dict.fromkeys(END_KEYS), name: wavelength}
        if fit.get("s_wavelength") is not None:
            fit["scales"] = None  # the factor and the end say how many
        return replace(self, fit=fit)

    def for_model(self, model: Model) -> tuple[PreparedSurface, Model]:
        """Return surface and model as `model` takes this sample.

        Raises `InputError` if no waves fit.
        """
        if isinstance(model, DirectContact):
            return self._measured(), model
        if isinstance(model, Chain) and self.load_time_factor != 1.0:
            model = replace(model, solver=loaded_longer(model.solver, self.load_time_factor))
        if self.correlation is None or self._as_prepared:
            return self.surface, model
        return replace(self.surface, sines=fit_sines(self.correlation, **self.fit)), model

    @property
    def _as_prepared(self) -> bool:
        same = self.correlation is self.surface.correlation
        return same and dict(self.fit) == dict(self.surface.fit)

    def _measured(self) -> PreparedSurface:
        """Return lines or map, and nothing of the waves but where they end."""
        wave, measured = np.array([self.end]), self.surface.measured
        if self.redrawn is not None:
            measured = Measured.of(self.redrawn())
        return PreparedSurface(SineStack(wave, wave), self.surface.source, measured=measured)
