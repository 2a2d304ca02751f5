"""The direct contact as one of the models that can be compared, varied, drawn and reported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gripscale import model
from gripscale.conditions.conditions import Conditions
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.surface import HeightMap, PreparedSurface, Profile, SurfacePart

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber


@dataclass(frozen=True)
class DirectContact(model.Model):
    """Every cleaned profile solved whole, averaged by length; of a map, the map.

    In small strain the mean state does nothing: the load time has no part in it, and the footprint
    only in how long the rubber is heated.

    Parameters
    ----------
    smallest_wavelength : float, optional
        Shorter waves are left out [m]; by default those shorter than the cut-off of the surface's
        sine waves or, without one, than the last of them, so that chain and direct contact see the
        same roughness.
    tolerance, most_points, periodic, conditions
        See `solve_rough_contact`.
    """

    name: ClassVar[str] = "direct"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement", "cut_off"})
    takes_conditions: ClassVar[bool] = True

    smallest_wavelength: float | None = None
    tolerance: float | None = 0.02
    most_points: int = 2**22
    periodic: bool = False
    conditions: Conditions | None = None

    def __post_init__(self) -> None:
        if self.smallest_wavelength is not None:
            checks.positive("smallest_wavelength", self.smallest_wavelength, unit="m")
        if self.tolerance is not None:
            checks.positive("tolerance", self.tolerance)
        checks.positive("most_points", self.most_points)
        checks.flag("periodic", self.periodic)

    def with_conditions(self, conditions: Conditions | None) -> DirectContact:
        """Return the direct contact under other conditions."""
        return replace(self, conditions=conditions)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer, with each profile over `profile`; `on_progress` gets each contact.

        Raises
        ------
        InputError
            If the surface was not measured: waves stated by hand have no profile.
        """
        contacts = []
        for measured in _measured(surface):
            contact = solve_rough_contact(
                rubber,
                measured,
                pressure=load.pressure,
                speed=load.speed,
                smallest_wavelength=self._smallest(surface, measured),
                tolerance=self.tolerance,
                most_points=self.most_points,
                periodic=self.periodic,
                conditions=self.conditions,
                footprint=load.footprint,
            )
            contacts.append(contact)
            if on_progress is not None:
                on_progress(contact)
        return self._answer(contacts, load)

    def _smallest(self, surface: PreparedSurface, measured: Profile | HeightMap) -> float:
        """Return the length given, or where the waves say it ends [m], two steps at least."""
        if self.smallest_wavelength is not None:
            return self.smallest_wavelength
        return max(surface.cutoff_wavelength, 2.0 * float(np.max(measured.step)))

    def _answer(self, contacts: list[RoughContact], load: NominalLoad) -> xr.Dataset:
        import xarray as xr

        # what has a size of its own, profile by profile, is in the result of the profile
        parts = [
            contact.to_dataset(fields=False).drop_dims(["patch", "grid"]) for contact in contacts
        ]
        data = xr.concat(parts, dim="profile", join="outer", combine_attrs="override")
        why_not = ["" if contact.converged else str(contact.status) for contact in contacts]
        lengths = [contact.grid.lengths[0] for contact in contacts]
        answer = model.answer_by_length(
            data,
            contacts,
            why_not,
            lengths,
            self.name,
            load,
            [contact.cut_off_exponents for contact in contacts],
        )
        adhesive = [contact.adhesive_friction for contact in contacts]
        return model.with_area_term(answer, float(np.average(adhesive, weights=lengths)))


def _measured(surface: PreparedSurface) -> list[Profile] | list[HeightMap]:
    if surface.measured is None:
        raise InputError(
            "the direct contact needs a measured profile; got sine waves stated by hand, which "
            "have none (gripscale.half_space.surface_of_sines makes one)"
        )
    return surface.measured.surfaces
