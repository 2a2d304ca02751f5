"""Models of measured profiles by theories: Persson, Klueppel & Heinrich."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from gripscale.core import checks
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError
from gripscale.model import Load, Model, OnProgress
from gripscale.rubber import Rubber
from gripscale.surface.profile import Profile
from gripscale.surface.spectrum import profile_spectrum
from gripscale.surface.surface import Surface, SurfacePart
from gripscale.theory.klueppel_heinrich import klueppel_heinrich
from gripscale.theory.persson import TheoryResult, persson

if TYPE_CHECKING:
    import xarray as xr


class Persson(Checked, Model):
    """Persson's theory; the profiles are lines on an isotropic surface."""

    name: ClassVar[str] = "persson"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement", "cut_off"})

    smallest_wavelength: float | None = checked(checks.positive, unit="m", default=None)
    """Smallest wave that counts [m]; by default the end of the surface's sine waves, see
    `SineStack.cutoff_wavelength`."""
    gamma: float = checked(checks.not_negative, default=0.5)
    """See `persson`."""
    window: float | None = checked(checks.positive, unit="m", default=None)
    """See `profile_spectrum` [m]."""

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer as a Dataset; `on_progress` gets the `PerssonResult`.

        Raises `InputError` if the surface was not measured, or not down to the smallest wave.
        """
        result = persson(
            rubber,
            profile_spectrum(_cleaned(surface, self.name), window=self.window),
            pressure=load.pressure,
            speed=load.speed,
            smallest_wavelength=self.smallest_wavelength or surface.cutoff_wavelength,
            gamma=self.gamma,
        )
        return _answered(replace(result, load=load), on_progress)


class KlueppelHeinrich(Checked, Model):
    """The theory of Klueppel and Heinrich for the upper part of the profiles."""

    name: ClassVar[str] = "klueppel_heinrich"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement", "cut_off"})

    layer_ratio: float = checked(checks.positive)
    """See `klueppel_heinrich` [-]."""
    penetration_depth: float = checked(checks.positive, unit="m")
    """See `klueppel_heinrich` [m]; the same at every load."""
    smallest_wavelength: float | None = checked(checks.positive, unit="m", default=None)
    """Smallest wave that counts [m]; by default the end of the surface's sine waves, see
    `SineStack.cutoff_wavelength`."""

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer as a Dataset; `on_progress` gets the `KlueppelHeinrichResult`.

        Raises `InputError` if the surface was not measured or its upper part is not self-affine.
        """
        result = klueppel_heinrich(
            rubber,
            _cleaned(surface, self.name),
            pressure=load.pressure,
            speed=load.speed,
            layer_ratio=self.layer_ratio,
            penetration_depth=self.penetration_depth,
            smallest_wavelength=self.smallest_wavelength or surface.cutoff_wavelength,
        )
        return _answered(replace(result, load=load), on_progress)


def _answered(result: TheoryResult, on_progress: OnProgress) -> xr.Dataset:
    if on_progress is not None:
        on_progress(result)
    return result.to_dataset()


def _cleaned(surface: Surface, name: str) -> list[Profile]:
    if surface.measured is None:
        raise InputError(
            f"{name} needs measured profiles; got a surface of sine waves only ({surface.source})"
        )
    return surface.measured.cleaned
