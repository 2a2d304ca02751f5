"""Surfaces and rubbers of a study: read and fitted once, then varied without reading again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.case import CaseFile, RubberSource, Surface, read_case, validate
from gripscale.case.models import NAMED_RUBBERS
from gripscale.errors import FileError, InputError
from gripscale.rubber import Rubber
from gripscale.study.synthetic import SYNTHETIC_SURFACES, synthetic_surface
from gripscale.surface import HeightDifference, SineStack, fit_sines

FIT_KEYS = (
    "scales",
    "smallest_wavelength",
    "s_wavelength",
    "s_amplitude",
    "first_wavelength",
    "first_amplitude",
    "single_factor",
    "smallest_lag",
    "largest_lag",
)
"""Keys of the case's [surface] that say how sine waves are fitted."""


@dataclass(frozen=True)
class Road:
    """A surface ready for a study: its waves, and what they were fitted to, if anything."""

    sines: SineStack
    source: str
    correlation: HeightDifference | None = None
    settings: Surface | None = None

    def stack(
        self,
        *,
        factors: tuple[float, float] | None = None,
        waves: int | None = None,
        smallest_wavelength: float | None = None,
    ) -> SineStack:
        """Return the waves with something changed.

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
            return self.sines
        if factors is not None:
            return self._magnified(factors, waves, smallest_wavelength)
        if self.correlation is None or self.settings is None:
            return self._shortened(waves, smallest_wavelength)
        options = {key: getattr(self.settings, key) for key in FIT_KEYS}
        fixed = options["s_wavelength"] is not None
        if waves is not None:
            options |= {"scales": waves} | ({"smallest_wavelength": None} if fixed else {})
        if smallest_wavelength is not None:
            options |= {"smallest_wavelength": smallest_wavelength}
            options |= {"scales": None} if fixed and waves is None else {}
        return fit_sines(self.correlation, **options)

    def _magnified(
        self, factors: tuple[float, float], waves: int | None, smallest: float | None
    ) -> SineStack:
        first, last = self.sines.wavelength[0], smallest or self.sines.wavelength[-1]
        if waves is None:
            if last > first:
                raise InputError(
                    f"smallest_wavelength must not exceed the largest wave, {first:g} m; "
                    f"got {last:g} m"
                )
            waves = 1 + int(np.log(first / last) / np.log(factors[0]) + 1e-9)
        order = np.arange(waves)
        stack = SineStack(
            wavelength=first / factors[0] ** order,
            amplitude=self.sines.amplitude[0] / factors[1] ** order,
            s_wavelength=factors[0],
            s_amplitude=factors[1],
        )
        return stack if self.correlation is None else self._judged(stack)

    def _judged(self, stack: SineStack) -> SineStack:
        """Return `stack` with its residual from the measured curve."""
        assert self.correlation is not None
        return fit_sines(
            self.correlation,
            scales=len(stack),
            s_wavelength=stack.s_wavelength,
            s_amplitude=stack.s_amplitude,
            first_wavelength=float(stack.wavelength[0]),
            first_amplitude=float(stack.amplitude[0]),
        )

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
            raise InputError(
                f"smallest_wavelength must not exceed the largest wave, "
                f"{self.sines.wavelength[0]:g} m; got {smallest:g} m"
            )
        return SineStack(self.sines.wavelength[keep], self.sines.amplitude[keep])


def case_road(file: CaseFile) -> Road:
    """Return the surface of a case."""
    return _road(file.case.surface, file.resolve)


def case_rubber(file: CaseFile) -> Rubber:
    """Return the rubber of a case."""
    return _rubber(file.case.rubber, file.resolve)


def road_of(value: Any, file: CaseFile) -> Road:
    """Return the surface an axis names.

    `value` is "case" (the case's own), a synthetic surface known by name, another case (its
    [surface] is taken), a profile (read with all other settings of the case), a `SineStack`
    or a `Road`.
    """
    if isinstance(value, Road):
        return value
    if isinstance(value, SineStack):
        return Road(value, "sine waves given by the caller")
    if value == "case":
        return case_road(file)
    if value in SYNTHETIC_SURFACES:
        sines, source, correlation = synthetic_surface(value)
        settings = Surface(files=[value], smallest_wavelength=float(sines.wavelength[-1]))
        return Road(sines, source, correlation, settings)
    path = _found("surface", value, file, ("case", *SYNTHETIC_SURFACES))
    if path.suffix == ".toml":
        return case_road(read_case(path))
    own = file.case.surface.model_dump(exclude_none=True, exclude={"files", "sines"})
    if file.case.surface.sines is not None:
        own["scales"] = len(file.case.surface.sines)
    return _road(validate(Surface, {**own, "files": [str(path)]}, "vary surface"), Path)


def rubber_of(value: Any, file: CaseFile) -> Rubber:
    """Return the rubber an axis names.

    `value` is "case", a rubber known by name, another case (its [rubber] is taken), a master
    curve (with the bulk modulus of the case), or a `Rubber`.
    """
    if isinstance(value, Rubber):
        return value
    if value == "case":
        return case_rubber(file)
    bulk = file.case.rubber.bulk_modulus
    stiffness = {} if bulk is None else {"bulk_modulus": bulk}
    if value in NAMED_RUBBERS:
        return _rubber(validate(RubberSource, {"name": value, **stiffness}, "vary rubber"), Path)
    path = _found("rubber", value, file, ("case", *NAMED_RUBBERS))
    if path.suffix == ".toml":
        return case_rubber(read_case(path))
    source = validate(RubberSource, {"file": str(path), **stiffness}, "vary rubber")
    return _rubber(source, Path)


def _found(name: str, value: Any, file: CaseFile, known: tuple[str, ...]) -> Path:
    """Return the file `value`, looked for here and beside the case."""
    here = Path(str(value)).expanduser()
    for path in (here, file.resolve(str(value))):
        if path.is_file():
            return path
    raise FileError(
        f"{name} {value} is neither a file here or beside the case nor one of {', '.join(known)}"
    )


def _road(surface: Surface, resolve: Callable[[str], Path]) -> Road:
    from gripscale.cli.inputs import study_surface  # late: it loads the command line

    made = study_surface(surface, resolve)
    if made.measured is None:
        return Road(made.sines, made.source)
    return Road(made.sines, made.source, made.measured.correlation, surface)


def _rubber(source: RubberSource, resolve: Callable[[str], Path]) -> Rubber:
    from gripscale.cli.inputs import study_rubber

    return study_rubber(source, resolve).rubber
