"""The folder in which finished numbers are kept: one file a station, one a map."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from gripscale.surface import HeightMap
from studies.isotropic_maps.construction import isotropic_maps
from studies.isotropic_maps.setting import CONSTRUCTIONS, SMALLEST, STATIONS
from studies.isotropic_maps.solved import OfLines, OfMap, of_lines, of_map
from studies.shipped import road


@dataclass(frozen=True)
class Folder:
    """Numbers of the measured lines and of `seeds` maps, solved once and then read."""

    path: Path
    seeds: int

    def measured(self, station: int) -> OfLines:
        """Return the numbers of a station's lines."""
        found: OfLines = _read(self._of_station(station))
        return found

    def maps(self, station: int, construction: str) -> list[OfMap]:
        """Return the numbers of the maps of a station, one for each seed."""
        return [
            _read(self._of_map(station, construction, seed)) for seed in self._seeds(construction)
        ]

    def heights(self, station: int, construction: str) -> NDArray[np.float64]:
        """Return the heights [m] of the first map."""
        return np.asarray(np.load(self._of_heights(station, construction)), dtype=np.float64)

    def fill(self, rubber: gs.Rubber) -> None:
        """Solve what is not in the folder yet, the seeds one after the other."""
        self.path.mkdir(parents=True, exist_ok=True)
        for station in STATIONS:
            if not self._of_station(station).exists():
                _write(self._of_station(station), of_lines(rubber, station))
        pairs = [(station, construction) for station in STATIONS for construction in CONSTRUCTIONS]
        missing = {pair: self._missing(*pair) for pair in pairs}
        while missing:
            for pair in list(missing):
                following = next(missing[pair], None)
                if following is None:
                    del missing[pair]
                    continue
                seed, surface = following
                found = of_map(rubber, surface, turned=pair[1] == "lines")
                _write(self._of_map(*pair, seed), found)
                print(*pair, seed, found["map"], found["lines"], flush=True)

    def _missing(self, station: int, construction: str) -> Iterator[tuple[int, HeightMap]]:
        """Yield the maps whose numbers are not there; keep the heights of the first."""
        to_do = [
            seed
            for seed in self._seeds(construction)
            if not self._of_map(station, construction, seed).exists()
        ]
        maps = isotropic_maps(
            road(station), smallest_wavelength=SMALLEST, construction=construction, seeds=to_do
        )
        for seed, surface in zip(to_do, maps, strict=True):
            if seed == 0:
                np.save(self._of_heights(station, construction), surface.z.astype(np.float32))
            yield seed, surface

    def _seeds(self, construction: str) -> range:
        """Return half as many of those that miss what matters."""
        return range(self.seeds if construction == "lines" else (self.seeds + 1) // 2)

    def _of_station(self, station: int) -> Path:
        return self.path / f"{station}_measured.json"

    def _of_map(self, station: int, construction: str, seed: int) -> Path:
        return self.path / f"{station}_{construction}_{seed}.json"

    def _of_heights(self, station: int, construction: str) -> Path:
        return self.path / f"{station}_{construction}.npy"


def _read(path: Path) -> Any:
    return json.loads(path.read_text(encoding="utf-8"))


def _write(path: Path, numbers: OfLines | OfMap) -> None:
    path.write_text(json.dumps(numbers), encoding="utf-8")
