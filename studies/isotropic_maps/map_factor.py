"""Synthetic isotropic maps of a measured surface: the factor from its lines to the surface.

A line is solved in plane strain, as if the surface were grooves across the sliding direction. The
maps are synthetic (`studies.isotropic_maps.construction`). Each map and single lines of it are
solved, sliding along x and along y:

    factor = mean over maps (map) / mean over maps (lines of the map)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from gripscale.core import checks, provenance
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile
from gripscale.surface.profile import profile_list
from studies.isotropic_maps.construction import isotropic_maps, seed_numbers
from studies.isotropic_maps.window_contacts import WindowContacts, solve_windows

if TYPE_CHECKING:
    import xarray as xr


QUANTITIES = ("contact_fraction", "friction_from_dissipation")
"""Of a contact. This friction is accurate to a few per cent with four points in a wave."""


@dataclass(frozen=True)
class MapContact:
    """Contact of one periodic map and of its lines, each the mean of sliding along x and y."""

    whole: dict[str, float]
    """`QUANTITIES` of the map; NaN if a contact did not converge."""
    lines: dict[str, float]
    """The same, mean over its lines."""
    between_directions: dict[str, float]
    """Of the map: sliding along x over sliding along y; NaN over zero."""


@dataclass(frozen=True)
class MapOverLines:
    """Contact of synthetic maps, of their lines, and of measured windows as long as a line."""

    construction: str
    length: float
    """Length of a map along each axis, and of a window [m]."""
    smallest_wavelength: float
    """Of every solved surface [m]."""
    measured: WindowContacts = field(repr=False)
    seeds: list[int]
    maps: list[MapContact] = field(repr=False)
    """One for each seed."""

    def factor(self, name: str) -> float:
        """Return mean over maps by mean over their lines of one of `QUANTITIES`; NaN over zero."""
        return _ratio(self._mean("whole", name), self._mean("lines", name))

    def scatter(self, name: str) -> float:
        """Return the standard deviation of map by lines from map to map; NaN for a single one."""
        if len(self.maps) < 2:
            return math.nan
        ratios = [_ratio(contact.whole[name], contact.lines[name]) for contact in self.maps]
        return float(np.std(ratios, ddof=1))

    def match(self, name: str) -> float:
        """Return mean over the maps' lines by mean over the measured windows; 1 if they match."""
        return _ratio(self._mean("lines", name), self.measured.mean(name))

    def uncertainty(self, name: str) -> float:
        """Return the standard error of `match`, from the scatter of windows and maps."""
        windows = self.measured.values(name)
        lines = np.array([contact.lines[name] for contact in self.maps])
        if min(windows.size, lines.size) < 2:
            return math.nan
        relative = [
            _ratio(float(v.std(ddof=1)), float(v.mean())) / math.sqrt(v.size)
            for v in (windows, lines)
        ]
        return self.match(name) * math.hypot(*relative)

    def to_dataset(self) -> xr.Dataset:
        """Return all numbers over `seed`, labelled as those of synthetic maps."""
        import xarray as xr

        def over(values: Sequence[float] | Array, text: str) -> xr.Variable:
            return xr.Variable("seed", np.asarray(values), {"units": "1", "long_name": text})

        data = {}
        for name in QUANTITIES:
            words = name.replace("_", " ")
            data[f"map_{name}"] = over([m.whole[name] for m in self.maps], f"{words} of the map")
            data[f"lines_{name}"] = over(
                [m.lines[name] for m in self.maps], f"{words}, mean over lines of the map"
            )
            windows = self.measured.values(name)
            attrs = {"units": "1", "long_name": f"{words} of measured windows of equal length"}
            data[f"measured_{name}"] = xr.Variable("window", windows, attrs)
        return xr.Dataset(data, coords={"seed": self.seeds}).assign_attrs(
            title="Contact of synthetic isotropic maps and of their lines",
            synthetic=f"isotropic maps, construction {self.construction}; no map was measured",
            length_m=self.length,
            smallest_wavelength_m=self.smallest_wavelength,
            **provenance.version_attributes(),
        )

    def _mean(self, part: str, name: str) -> float:
        return float(np.mean([getattr(contact, part)[name] for contact in self.maps]))


def map_over_lines(
    rubber: Rubber,
    profile: Profile | Sequence[Profile],
    *,
    pressure: float,
    speed: float,
    smallest_wavelength: float,
    construction: str = "lines",
    points: int = 512,
    seeds: Iterable[int] = range(6),
    lines: int = 10,
    tolerance: float = 0.05,
    workers: int | None = None,
    on_batch: Callable[[int, float], None] | None = None,
    on_map: Callable[[MapContact], None] | None = None,
) -> MapOverLines:
    """Compare synthetic isotropic maps of a measured surface with their lines.

    Multiply contact and friction of the measured line by the factors for an answer of the
    surface, if the maps' lines match the measured ones.

    Raises `InputError` if an argument is out of its range.

    Parameters
    ----------
    rubber, pressure, speed
        As for `solve_rough_contact`.
    profile, smallest_wavelength, construction, points, seeds, on_batch
        As for `studies.isotropic_maps.construction`.
    lines : int
        Number of solved lines of each map in each of two directions, evenly spaced.
    tolerance : float
        Estimated relative error of the lines and windows. Maps have four points in the smallest
        wave, whatever the errors.
    workers : int, optional
        As for `solve_rough_contact`.
    on_map : callable, optional
        Called with the `MapContact` of each map as it is done.
    """
    load: dict[str, Any] = {
        "pressure": pressure,
        "speed": speed,
        "smallest_wavelength": smallest_wavelength,
    }
    chosen = seed_numbers(seeds)
    drawn = isotropic_maps(
        profile,
        smallest_wavelength=smallest_wavelength,
        construction=construction,
        points=points,
        seeds=chosen,
        on_batch=on_batch,
    )
    options = {"lines": lines, "tolerance": tolerance, "workers": workers, **load}
    contacts = []
    for surface in drawn:
        contacts.append(solve_map_and_lines(rubber, surface, **options))
        if on_map is not None:
            on_map(contacts[-1])
    if not contacts:
        raise InputError("seeds must be one whole number at least; got none")
    length = points * surface.step[0]
    measured = WindowContacts(
        [
            contact
            for line in profile_list(profile)
            for contact in solve_windows(rubber, line, length, tolerance=tolerance, **load).contacts
        ]
    )
    return MapOverLines(construction, length, smallest_wavelength, measured, chosen, contacts)


def solve_map_and_lines(
    rubber: Rubber,
    surface: HeightMap,
    *,
    lines: int = 10,
    tolerance: float = 0.05,
    workers: int | None = None,
    **load: Any,
) -> MapContact:
    """Return the contact of a map and of single lines of it, sliding along x and along y.

    `surface` is one period, of equal points and steps each way. Further arguments are those of
    `map_over_lines` and `solve_rough_contact`. Raises `InputError` if one is out of its range.
    """
    checks.instance("surface", surface, HeightMap)
    number = checks.whole("lines", lines, least=1, most=surface.z.shape[0])
    if surface.z.shape[0] != surface.z.shape[1]:
        raise InputError(f"surface must have equal points each way; got {surface.z.shape}")
    rows = np.linspace(0, surface.z.shape[0], number, endpoint=False).astype(int)
    along_y = HeightMap(surface.x, surface.y, surface.z.T)
    whole, of_lines = [], []
    for turned in (surface, along_y):
        options = {"periodic": True, **load}
        contact = solve_rough_contact(rubber, turned, tolerance=None, workers=workers, **options)
        profiles = (Profile(turned.x, turned.z[:, row]) for row in rows)
        contacts = [
            solve_rough_contact(rubber, p, tolerance=tolerance, **options) for p in profiles
        ]
        whole.append(_means([contact]))
        of_lines.append(_means(contacts))
    along, across = whole
    return MapContact(
        {name: 0.5 * (along[name] + across[name]) for name in along},
        {name: 0.5 * (of_lines[0][name] + of_lines[1][name]) for name in along},
        {name: _ratio(along[name], across[name]) for name in along},
    )


def _means(contacts: list[RoughContact]) -> dict[str, float]:
    return {name: WindowContacts(contacts).mean(name) for name in (*QUANTITIES, "friction")}


def _ratio(above: float, below: float) -> float:
    """Return the ratio, NaN over zero: friction at rest, or of a flat line."""
    return above / below if below else math.nan
