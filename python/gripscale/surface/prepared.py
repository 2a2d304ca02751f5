"""A surface ready for any model: its sine waves and, where it was measured, the way to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from gripscale.errors import InputError
from gripscale.surface.cleaning import CleaningReport
from gripscale.surface.doubts import profile_doubts, stack_notes
from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.height_map import HeightMap
from gripscale.surface.profile import Profile
from gripscale.surface.self_affine import SelfAffineFit
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.sines import SineStack


@dataclass(frozen=True)
class Measured:
    """Profiles as read and cleaned, what cleaning did, and the fit to their correlation.

    Of a map the profiles are one line to be shown; its lines and itself are as cleaned.
    """

    profiles: list[tuple[Profile, Profile]]
    cleaning: list[CleaningReport]
    self_affine: SelfAffineFit | None
    no_self_affine: str
    """Why there is no self-affine fit, or empty."""
    map: HeightMap | None = None
    """The map, x along the way of sliding, or None for profiles."""

    @classmethod
    def of(cls, measured: Sequence[Profile] | HeightMap) -> Measured:
        """Return profiles or a map as they stand: nothing cleaned, nothing fitted."""
        if isinstance(measured, HeightMap):
            return cls([], [], None, "", measured)
        return cls([(line, line) for line in measured], [], None, "")

    @property
    def cleaned(self) -> list[Profile]:
        """The profiles as cleaned, or all lines of the map along the way of sliding."""
        if self.map is not None:
            return self.map.lines()
        return [cleaned for _, cleaned in self.profiles]

    @property
    def surfaces(self) -> list[Profile] | list[HeightMap]:
        """What a contact can be solved on: the profiles as cleaned, or the map."""
        return self.cleaned if self.map is None else [self.map]

    @property
    def notes(self) -> tuple[str, ...]:
        """What reading changed and what is implausible, a sentence each."""
        found = []
        for raw, cleaned in self.profiles:
            about = f"{raw.name}: " if raw.name else ""
            doubts = profile_doubts(raw, cleaned, steep=self.map is None)
            found += [f"{about}{note}" for note in (*raw.notes, *doubts)]
        return tuple(found)

    def bare(self) -> Measured:
        """Return what was measured, without how it was cleaned and what was fitted to it."""
        return Measured.of(self.cleaned if self.map is None else self.map)


@dataclass(frozen=True)
class PreparedSurface:
    """Sine waves, and what they were fitted to, if anything.

    Attributes
    ----------
    sines, source
        The waves, and where they come from.
    correlation
        What they were fitted to, or None for waves stated by hand.
    fit
        Arguments of `fit_sines` they were fitted with.
    measured
        The measurement behind the correlation, or None for a synthetic surface.
    """

    sines: SineStack
    source: str
    correlation: HeightDifference | None = None
    fit: Mapping[str, Any] = field(default_factory=dict)
    measured: Measured | None = None

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be known of the measurement and of where the waves end, a sentence each."""
        found = () if self.measured is None else self.measured.notes
        if self.correlation is None:
            return found
        return (*found, *stack_notes(self.sines, self.correlation, self.fit))

    def varied(
        self,
        *,
        factors: tuple[float, float] | None = None,
        waves: int | None = None,
        smallest_wavelength: float | None = None,
    ) -> PreparedSurface:
        """Return the surface with other waves.

        Parameters
        ----------
        factors
            Magnification factors of wavelength and amplitude, from the same first wave down to
            the same smallest wavelength as far as whole waves go.
        waves
            Their number: fitted anew to a measured surface, the first ones of waves by hand.
        smallest_wavelength
            Where they end [m]: fitted anew, or cut off.

        Raises
        ------
        InputError
            If there are no such waves.
        """
        if factors is None and waves is None and smallest_wavelength is None:
            return self
        if factors is not None:
            stack = self._magnified(factors, waves, smallest_wavelength)
        elif self.correlation is None or not self.fit:
            stack = self._shortened(waves, smallest_wavelength)
        else:
            stack = self._fitted(self.correlation, waves, smallest_wavelength)
        return replace(self, sines=stack)

    def _fitted(
        self, correlation: HeightDifference, waves: int | None, smallest: float | None
    ) -> SineStack:
        options = dict(self.fit)
        fixed = options.get("s_wavelength") is not None
        if waves is not None:
            options |= {"scales": waves} | ({"smallest_wavelength": None} if fixed else {})
        if smallest is not None:
            options |= {"smallest_wavelength": smallest}
            options |= {"scales": None} if fixed and waves is None else {}
        return fit_sines(correlation, **options)

    def _magnified(
        self, factors: tuple[float, float], waves: int | None, smallest: float | None
    ) -> SineStack:
        first, last = self.sines.wavelength[0], smallest or self.sines.wavelength[-1]
        if waves is None:
            if last > first:
                raise InputError(_beyond_the_largest(first, last))
            waves = 1 + int(np.log(first / last) / np.log(factors[0]) + 1e-9)
        order = np.arange(waves)
        stack = SineStack(
            wavelength=first / factors[0] ** order,
            amplitude=self.sines.amplitude[0] / factors[1] ** order,
            s_wavelength=factors[0],
            s_amplitude=factors[1],
        )
        return stack if self.correlation is None else _judged(self.correlation, stack)

    def _shortened(self, waves: int | None, smallest: float | None) -> SineStack:
        count = len(self.sines) if waves is None else waves
        if count > len(self.sines):
            raise InputError(
                f"waves must be at most {len(self.sines)}, as many as there are; got {count}"
            )
        keep = np.arange(len(self.sines)) < count
        if smallest is not None:
            keep &= self.sines.wavelength >= smallest
        if not keep.any():
            raise InputError(_beyond_the_largest(self.sines.wavelength[0], smallest))
        return SineStack(self.sines.wavelength[keep], self.sines.amplitude[keep])


def _judged(correlation: HeightDifference, stack: SineStack) -> SineStack:
    """Return `stack` with its residual from the measured curve."""
    return fit_sines(
        correlation,
        scales=len(stack),
        s_wavelength=stack.s_wavelength,
        s_amplitude=stack.s_amplitude,
        first_wavelength=float(stack.wavelength[0]),
        first_amplitude=float(stack.amplitude[0]),
    )


def _beyond_the_largest(largest: float, smallest: float | None) -> str:
    return (
        f"smallest_wavelength must not exceed the largest wave, {largest:g} m; got {smallest:g} m"
    )
