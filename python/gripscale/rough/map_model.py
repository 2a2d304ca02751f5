"""Synthetic maps of a measured surface, and their lines, as models that can be compared."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

from gripscale import model, versions
from gripscale.errors import InputError
from gripscale.rough.map_factor import Solved, solve_lines_of, solve_whole
from gripscale.surface import HeightMap, Measured, PreparedSurface, Profile, isotropic_maps

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber

KEPT = 16
"""Maps kept in memory for whoever asks next: the map and its lines, another speed."""


@dataclass(frozen=True)
class SyntheticMap:
    """An isotropic map made from all cleaned profiles, see `gripscale.surface.isotropic_maps`.

    The mean of sliding along x and along y.

    Parameters
    ----------
    seed : int
        Which map.
    smallest_wavelength : float
        Smallest wave of the map [m]; its length is `points / 4` of them.
    lines : int
        How many of its lines are solved each way; 0 for the map itself.
    points, construction
        See `gripscale.surface.isotropic_maps`.
    tolerance : float
        Estimated relative error of the lines; the map has four points in its smallest wave.
    """

    name: ClassVar[str] = "synthetic_map"

    seed: int
    smallest_wavelength: float
    lines: int = 0
    points: int = 512
    construction: str = "lines"
    tolerance: float = 0.05

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return nothing of `surface` but its profiles (and its waves, which it must have)."""
        return PreparedSurface(surface.sines, "", measured=Measured.of(_profiles(surface)))

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer; `on_progress` is called while the map is drawn.

        Raises
        ------
        InputError
            If the surface has no profiles a map can be made from.
        """
        import xarray as xr

        key = (*_profiles(surface),), self.seed, self.smallest_wavelength
        heights = _drawing(*key, self.points, self.construction).map(on_progress)
        arguments: dict[str, Any] = {
            "pressure": load.pressure,
            "speed": load.speed,
            "smallest_wavelength": self.smallest_wavelength,
        }
        found: Solved = (
            solve_lines_of(rubber, heights, lines=self.lines, tolerance=self.tolerance, **arguments)
            if self.lines
            else solve_whole(rubber, heights, workers=1, **arguments)
        )
        totals = {name: found.values[name.removeprefix("total_")] for name in model.TOTALS}
        data = xr.Dataset().assign_attrs(
            title="Contact of a synthetic isotropic map",
            synthetic=heights.source,
            **versions.attributes(),
        )
        return model.answer(
            data,
            totals,
            found.status,
            self.name,
            load,
            found.extrapolation,
            found.cut_off_exponents,
        )


@dataclass(eq=False)
class _Drawing:
    """A map that is drawn once, by whoever asks first; the others wait."""

    profiles: tuple[Profile, ...]
    options: dict[str, Any]
    lock: threading.Lock = field(default_factory=threading.Lock)
    drawn: HeightMap | None = None

    def map(self, on_progress: Callable[[Any], None] | None) -> HeightMap:
        def tell(seed: int, share: float) -> None:
            if on_progress is not None:
                on_progress(share)

        with self.lock:
            if self.drawn is None:
                maps = isotropic_maps(list(self.profiles), on_batch=tell, **self.options)
                self.drawn = next(iter(maps))
            return self.drawn


@lru_cache(maxsize=KEPT)
def _drawing(
    profiles: tuple[Profile, ...], seed: int, smallest: float, points: int, construction: str
) -> _Drawing:
    options = {
        "smallest_wavelength": smallest,
        "points": points,
        "construction": construction,
        "seeds": [seed],
    }
    return _Drawing(profiles, options)


def _profiles(surface: PreparedSurface) -> list[Profile]:
    if surface.measured is None or surface.measured.map is not None:
        raise InputError("a synthetic map is made from measured profiles; the surface has none")
    return surface.measured.cleaned
