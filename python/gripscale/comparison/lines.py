"""One period of a line in the finite-strain block, and in the half-space, as models to compare.

Their ratio over the same windows of a profile is what finite strain changes, see
`gripscale.rough.solve_both_ways`; here each answer is a task of its own and kept by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from gripscale import model
from gripscale.errors import InputError
from gripscale.rough.solve import solve_rough_contact
from gripscale.surface import Measured, PreparedSurface, Profile
from gripscale.wave.profile import solve_profile
from gripscale.wave.result import WaveResult

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber


@dataclass(frozen=True)
class BlockOnLine:
    """The only profile of a surface as one period under the finite-strain block."""

    name: ClassVar[str] = "block_on_line"

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return nothing of `surface` but its profile."""
        return _relevant(surface)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer; `on_progress` gets the `WaveResult`.

        A mesh too coarse for the line counts as not converged.
        """
        from gripscale.wave.dataset import waves_to_dataset

        result = solve_profile(
            rubber,
            _line(surface),
            pressure=load.pressure,
            speed=load.speed,
            load_time=load.time_under(load.footprint),
            periodic=True,
        )
        if on_progress is not None:
            on_progress(result)
        status = _status(result)
        totals = {name: getattr(result, name.removeprefix("total_")) for name in model.TOTALS}
        if status != "converged":
            totals = dict.fromkeys(totals, math.nan)
        kept = ["contact_fraction_error", "friction_error", "contact_fraction", "friction"]
        data = waves_to_dataset([result])[[*kept, "outside_band"]]
        return model.answer(data, totals, status, self.name, load)


@dataclass(frozen=True)
class HalfSpaceOnLine:
    """The only profile of a surface as one period under the half-space, at small strain.

    Parameters
    ----------
    tolerance : float
        Estimated relative error, see `solve_rough_contact`.
    """

    name: ClassVar[str] = "half_space_on_line"

    tolerance: float = 0.02

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return nothing of `surface` but its profile."""
        return _relevant(surface)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer; `on_progress` gets the `RoughContact`."""
        contact = solve_rough_contact(
            rubber,
            _line(surface),
            pressure=load.pressure,
            speed=load.speed,
            tolerance=self.tolerance,
            periodic=True,
        )
        if on_progress is not None:
            on_progress(contact)
        totals = {
            name: getattr(contact, name.removeprefix("total_")) if contact.converged else math.nan
            for name in model.TOTALS
        }
        data = contact.to_dataset(fields=False).drop_dims(["patch", "grid"])
        data = data.expand_dims("profile").assign(weight=("profile", [1.0]))
        return model.answer(data, totals, str(contact.status), self.name, load)


def _status(result: WaveResult) -> str:
    from gripscale.rough.finite_strain import MOST_MISMATCH

    if not result.converged:
        return result.why
    if result.friction_mismatch > MOST_MISMATCH:
        return f"the block's two frictions differ by {result.friction_mismatch:.0%}"
    return "converged"


def _line(surface: PreparedSurface) -> Profile:
    lines = [] if surface.measured is None else surface.measured.cleaned
    if len(lines) != 1:
        raise InputError(f"a line must be the only profile of its surface; got {len(lines)}")
    return lines[0]


def _relevant(surface: PreparedSurface) -> PreparedSurface:
    line = _line(surface)
    return PreparedSurface(surface.sines, source="", measured=Measured.of([line]))
