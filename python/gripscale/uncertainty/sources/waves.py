"""The source `waves`: which of the stacks that follow C_z as well as it is known.

`gripscale.surface.sine_ambiguity` finds their numbers of waves and first wavelengths. All of them
count alike; they are drawn in the order of their rms slope, so that `place` spreads them evenly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from gripscale.errors import InputError
from gripscale.surface import SineStack, sine_ambiguity
from gripscale.surface.sine_search import FACTOR_RANGE
from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.quantities import count
from gripscale.uncertainty.range import Range
from gripscale.uncertainty.sources.source import Coordinate, NotHere, Stated

CHOSEN = ("s_wavelength", "s_amplitude", "first_wavelength", "first_amplitude")
"""Arguments of a fit that leave no choice of waves."""


@dataclass(frozen=True)
class WavesSource:
    """Number and first wavelength [m] of stacks as good, by rising slope."""

    name: ClassVar[str] = "waves"
    label: ClassVar[str] = "choice of sine waves"
    models: ClassVar[tuple[str, ...]] = ("chain",)
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "waves": Coordinate("1", "number of sine waves"),
        "first_wavelength": Coordinate("m", "wavelength of the largest wave"),
    }

    choices: tuple[tuple[int, float], ...]

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> WavesSource:
        """Return the source of a case.

        Raises `NotHere` where the case leaves no choice, `InputError` if none of the numbers of
        waves that are given follows C_z.
        """
        surface = known.surface
        if surface.correlation is None or not surface.fit:
            raise NotHere("the waves are stated by hand")
        fixed = [key for key in CHOSEN if surface.fit.get(key) is not None]
        if fixed or surface.fit.get("single_factor") or len(surface.sines) < 2:
            raise NotHere(f"the case states {fixed[0] if fixed else 'one factor or one wave'}")
        stacks = sine_ambiguity(surface.correlation, surface.sines).stacks
        wanted = _numbers(stated)
        good = [stack for stack in stacks if wanted is None or len(stack) in wanted]
        if not good:
            found = sorted({len(stack) for stack in stacks})
            raise InputError(
                f"waves must be among the numbers that follow C_z as well as it is known, "
                f"{found[0]} to {found[-1]}; got {stated.values}"
            )
        return cls(_choices(good))

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the stack at `place`; one wave fewer where factors get too small.

        The cut-off of the sample may leave no room for as many waves.
        """
        number, first = self.choices[min(int(place * len(self.choices)), len(self.choices) - 1)]
        ended = inputs.ended_at(inputs.end)
        half = 0.5 if ended.fit["cut_off"] is not None else 0.0
        most = 1.0 - half + math.log(first / ended.end) / math.log(FACTOR_RANGE[0])
        fit = {**ended.fit, "scales": min(number, int(most)), "first_wavelength": first}
        told = {"waves": float(number), "first_wavelength": first}
        return replace(inputs, fit=fit), told


def _numbers(stated: Stated) -> Sequence[int] | None:
    if stated.values is None:
        return None
    given = Range.read(WavesSource.name, stated.values, count)
    low, high = int(given.values[0]), int(given.values[-1])
    return range(low, high + 1) if given.between else [int(value) for value in given.values]


def _choices(stacks: Sequence[SineStack]) -> tuple[tuple[int, float], ...]:
    ordered = sorted(stacks, key=lambda stack: float(stack.rms_slope))
    return tuple((len(stack), float(stack.wavelength[0])) for stack in ordered)
