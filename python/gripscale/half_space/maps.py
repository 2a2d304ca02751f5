"""Synthetic isotropic maps of a measured surface: the factor from its lines to the surface.

A line is solved in plane strain, as if the surface were grooves across the sliding direction. The
maps are synthetic (`gripscale.surface.isotropic_maps`). Each is solved whole, sliding along x and
along y, and so are single lines of it:

    factor = mean over maps (map) / mean over maps (lines of the map)
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from gripscale import model
from gripscale.core import checks, provenance
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.half_space.windows import WindowContacts, solve_windows
from gripscale.model import NOT_CONVERGED, CutOffExponents, of_mean
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import Extrapolation, of_sum
from gripscale.surface import HeightMap, Profile, Surface, SurfacePart, isotropic_maps
from gripscale.surface.isotropic_maps import seed_numbers
from gripscale.surface.profile import profile_list

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import Load, OnProgress


QUANTITIES = ("contact_fraction", "friction_from_dissipation")
"""Of a contact. This friction is accurate to a few per cent with four points in a wave."""
KEPT = 16
"""Maps kept in memory, for other speeds and for the lines of the same map."""


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
            **provenance.attributes(),
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

    Multiply contact and friction of the measured line by the factors for a best estimate of the
    surface, if the maps' lines match the measured ones.

    Raises `InputError` if an argument is out of its range.

    Parameters
    ----------
    rubber, pressure, speed
        As for `solve_rough_contact`.
    profile, smallest_wavelength, construction, points, seeds, on_batch
        As for `gripscale.surface.isotropic_maps`.
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
    whole = solve_whole(rubber, surface, workers=workers, **load)
    of_lines = solve_lines_of(rubber, surface, lines=lines, tolerance=tolerance, **load)
    return MapContact(whole.values, of_lines.values, whole.between_directions)


class TwoWayContact(NamedTuple):
    """Contact of a surface that slides along x and along y."""

    values: dict[str, float]
    """Means of the two; NaN if a contact did not converge."""
    between_directions: dict[str, float]
    """Along x over along y; NaN over zero."""
    status: str
    extrapolation: Extrapolation
    cut_off_exponents: CutOffExponents


def solve_whole(
    rubber: Rubber, surface: HeightMap, *, workers: int | None = None, **load: Any
) -> TwoWayContact:
    """Return the contact of a square, periodic map with four points in the smallest wave.

    Raises `InputError` as `solve_rough_contact`, and if the map is no square.
    """
    options = {"periodic": True, "tolerance": None, "workers": workers, **load}
    return _both_ways(
        [[solve_rough_contact(rubber, turned, **options)] for turned in _directions(surface)]
    )


def solve_lines_of(
    rubber: Rubber, surface: HeightMap, *, lines: int, tolerance: float, **load: Any
) -> TwoWayContact:
    """Return the mean contact of lines of a square, periodic map, evenly spaced.

    Raises `InputError` as `solve_rough_contact`, and if the map is no square.
    """
    number = checks.whole("lines", lines, least=1, most=surface.z.shape[0])
    rows = np.linspace(0, surface.z.shape[0], number, endpoint=False).astype(int)
    options = {"periodic": True, "tolerance": tolerance, **load}
    return _both_ways(
        [
            [
                solve_rough_contact(rubber, Profile(turned.x, turned.z[:, row]), **options)
                for row in rows
            ]
            for turned in _directions(surface)
        ]
    )


def _directions(surface: HeightMap) -> list[HeightMap]:
    """Return a square map and the map turned, so that both slide along x."""
    if surface.z.shape[0] != surface.z.shape[1]:
        raise InputError(f"surface must have equal points each way; got {surface.z.shape}")
    return [surface, HeightMap(surface.x, surface.y, surface.z.T)]


def _both_ways(contacts: list[list[RoughContact]]) -> TwoWayContact:
    along, across = (
        {name: WindowContacts(group).mean(name) for name in (*QUANTITIES, "friction")}
        for group in contacts
    )
    every = [contact for group in contacts for contact in group]
    bad = [str(contact.status) for contact in every if not contact.converged]
    return TwoWayContact(
        {name: 0.5 * (along[name] + across[name]) for name in along},
        {name: _ratio(along[name], across[name]) for name in along},
        bad[0] if bad else "converged",
        of_sum(
            [contact.extrapolation for contact in every],
            [contact.friction_from_dissipation for contact in every],
        ),
        NOT_CONVERGED
        if bad
        else of_mean(
            [contact.cut_off_exponents for contact in every],
            *([getattr(contact, name) for contact in every] for name in QUANTITIES),
        ),
    )


def _ratio(above: float, below: float) -> float:
    """Return the ratio, NaN over zero: friction at rest, or of a flat line."""
    return above / below if below else math.nan


@dataclass(frozen=True)
class SyntheticMap(model.Model):
    """Model by an isotropic map of all cleaned profiles, see `gripscale.surface.isotropic_maps`.

    The answer is the mean of sliding along x and along y.
    """

    name: ClassVar[str] = "synthetic_map"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement"})

    seed: int
    """Seed of the map."""
    smallest_wavelength: float
    """Smallest wave of the map [m]; its length is `points / 4` of them."""
    lines: int = 0
    """Number of solved lines along each axis; 0 solves the map itself."""
    points: int = 512
    """See `gripscale.surface.isotropic_maps`."""
    construction: str = "lines"
    """See `gripscale.surface.isotropic_maps`."""
    tolerance: float = 0.05
    """Estimated relative error of the lines; the map has four points in its smallest wave."""

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer; `on_progress` is called while the map is made.

        Raises `InputError` if the surface has no profiles a map can be made from.
        """
        import xarray as xr

        if surface.measured is None or surface.measured.map is not None:
            raise InputError("a synthetic map is made from measured profiles; the surface has none")
        smallest = self.smallest_wavelength
        profiles = tuple(surface.measured.cleaned)
        shared = _shared_map(profiles, self.seed, smallest, self.points, self.construction)
        heights = shared.heights(on_progress)
        solve = partial(solve_whole, workers=1)
        if self.lines:
            solve = partial(solve_lines_of, lines=self.lines, tolerance=self.tolerance)
        contact = solve(
            rubber, heights, pressure=load.pressure, speed=load.speed, smallest_wavelength=smallest
        )
        totals = {name: contact.values[name.removeprefix("total_")] for name in model.TOTALS}
        data = xr.Dataset().assign_attrs(
            title="Contact of a synthetic isotropic map",
            synthetic=heights.source,
            **provenance.attributes(),
        )
        return model.answer(
            data,
            totals,
            contact.status,
            self.name,
            load,
            contact.extrapolation,
            contact.cut_off_exponents,
        )


@dataclass(eq=False)
class _SharedMap:
    """A map that the first caller makes, while other threads wait."""

    profiles: tuple[Profile, ...]
    seed: int
    smallest_wavelength: float
    points: int
    construction: str
    lock: threading.Lock = field(default_factory=threading.Lock)
    made: HeightMap | None = None

    def heights(self, on_progress: OnProgress) -> HeightMap:
        with self.lock:
            if self.made is None:
                maps = isotropic_maps(
                    list(self.profiles),
                    smallest_wavelength=self.smallest_wavelength,
                    construction=self.construction,
                    points=self.points,
                    seeds=[self.seed],
                    on_batch=on_progress and (lambda seed, share: on_progress(share)),
                )
                self.made = next(iter(maps))
            return self.made


_shared_map = lru_cache(maxsize=KEPT)(_SharedMap)
