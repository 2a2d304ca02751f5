"""The block on whole profiles as one of the models that can be compared, varied and reported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gripscale import checks, model, versions
from gripscale.errors import InputError
from gripscale.surface import Measured, PreparedSurface, Profile, SineStack
from gripscale.wave.profile import solve_profile
from gripscale.wave.result import WaveResult

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber


@dataclass(frozen=True)
class BlockOnProfile:
    """Every cleaned profile in one finite-strain block, averaged by length.

    The profiles must be short: a block carries a hundred waves or so (`gripscale.rough.windows`
    cuts them). A place is loaded for the time of the load, while the footprint passes.

    Parameters
    ----------
    smallest_wavelength, periodic, tolerance
        See `gripscale.solve_profile`.
    """

    name: ClassVar[str] = "block_on_profile"

    smallest_wavelength: float | None = None
    periodic: bool = False
    tolerance: float | None = None

    def __post_init__(self) -> None:
        if self.smallest_wavelength is not None:
            checks.positive("smallest_wavelength", self.smallest_wavelength, unit="m")
        checks.flag("periodic", self.periodic)
        if self.tolerance is not None:
            checks.positive("tolerance", self.tolerance)

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return nothing of `surface` but its profiles (and a wave, which a surface must have)."""
        measured = surface.measured and Measured.of(surface.measured.cleaned)
        return PreparedSurface(SineStack(np.ones(1), np.ones(1)), source="", measured=measured)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer, with each profile over `profile`; `on_progress` gets each result.

        Raises
        ------
        InputError
            If the surface has no profile, or one with more waves than a block carries.
        """
        results = []
        for line in _lines(surface):
            results.append(self._solve(rubber, line, load))
            if on_progress is not None:
                on_progress(results[-1])
        why_not = ["" if result.converged else result.why for result in results]
        return _answer(results, why_not, load)

    def _solve(self, rubber: Rubber, line: Profile, load: NominalLoad) -> WaveResult:
        return solve_profile(
            rubber,
            line,
            pressure=load.pressure,
            speed=load.speed,
            load_time=load.time_under(load.footprint),
            smallest_wavelength=self.smallest_wavelength,
            periodic=self.periodic,
            tolerance=self.tolerance,
        )


def _answer(results: list[WaveResult], why_not: list[str], load: NominalLoad) -> xr.Dataset:
    from gripscale.wave.dataset import waves_to_dataset

    data = waves_to_dataset(results).drop_vars("scale").rename(scale="profile")
    data = data.assign_attrs(title="Profiles in the finite-strain block", **versions.attributes())
    lengths = [result.wavelength for result in results]
    return model.answer_by_length(data, results, why_not, lengths, BlockOnProfile.name, load)


def _lines(surface: PreparedSurface) -> list[Profile]:
    if surface.measured is None:
        raise InputError(
            "the block on a profile needs a profile; got sine waves stated by hand, which have "
            "none (gripscale.rough.surface_of_sines makes one)"
        )
    return surface.measured.cleaned
