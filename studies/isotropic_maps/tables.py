"""The tables of docs/isotropic-maps.md."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

import gripscale as gs
from studies.isotropic_maps.folder import Folder
from studies.isotropic_maps.map_factor import solve_map_and_lines
from studies.isotropic_maps.setting import (
    AREA,
    CONSTRUCTIONS,
    FRICTION,
    LOAD,
    STATIONS,
    TOLERANCE,
)
from studies.isotropic_maps.solved import OfMap, cut_off


def contacts(folder: Folder) -> Iterator[str]:
    """Yield contact and friction of lines and maps, and the factors between them."""
    yield "| station | maps | lines A | lines mu | map A | map mu | factor A | factor mu |"
    yield "|---|---|---|---|---|---|---|---|"
    for station in STATIONS:
        windows = folder.measured(station)["windows"]
        yield (
            f"| {station} | measured | {spread(windows[AREA])} "
            f"| {spread(windows[FRICTION])} | | | | |"
        )
        for construction in CONSTRUCTIONS:
            found = folder.maps(station, construction)
            cells = [spread(one["lines"][q] for one in found) for q in (AREA, FRICTION)]
            cells += [spread(one["map"][q] for one in found) for q in (AREA, FRICTION)]
            cells += [factor(found, q) for q in (AREA, FRICTION)]
            yield f"| {station} | {construction} | {' | '.join(cells)} |"


def factor(maps: list[OfMap], quantity: str) -> str:
    """Return mean over maps by mean over their lines, and its scatter from map to map."""
    whole, lines = (
        np.array([numbers[quantity] for numbers in part])
        for part in ([one["map"] for one in maps], [one["lines"] for one in maps])
    )
    return f"{whole.mean() / lines.mean():.2f} ± {np.std(whole / lines, ddof=1):.2f}"


def statistics(folder: Folder) -> Iterator[str]:
    """Yield what the lines of the maps share with the measured ones."""
    first = folder.measured(STATIONS[0])["statistics"]
    yield "| station | lines | " + " | ".join(first) + " |"
    yield "|---" * (len(first) + 2) + "|"
    for station in STATIONS:
        base = folder.measured(station)["statistics"]
        yield f"| {station} | measured | {row(base)} |"
        for construction in CONSTRUCTIONS:
            found = [one["statistics"] for one in folder.maps(station, construction)]
            means = {name: float(np.mean([one[name] for one in found])) for name in base}
            yield f"| {station} | {construction} | {row(means)} |"


def row(values: Mapping[str, float]) -> str:
    """Return statistics with their units, side by side."""
    return " | ".join(cell(name, value) for name, value in values.items())


def cell(quantity: str, value: float) -> str:
    """Return a statistic with its unit."""
    if quantity == "rms height":
        return f"{value * 1e3:.2f} mm"
    if quantity.startswith("C_z"):
        return f"{value * 1e6:.3g} mm²"
    return f"{value:.2f}"


def directions(folder: Folder) -> Iterator[str]:
    """Yield how much a map's answer depends on the way of sliding."""
    for station in STATIONS:
        found = folder.maps(station, "lines")
        for q in (AREA, FRICTION):
            turned = spread(one["map at 45 degrees"][q] / one["map"][q] for one in found)
            across = spread(one["between directions"][q] for one in found)
            yield f"station {station}, {q}: along x over y {across}, 45° {turned}"


def cut_maps(folder: Folder, rubber: gs.Rubber) -> Iterator[str]:
    """Yield the area of lines of a map that is cut off as it is solved, over that of its lines."""
    for station in STATIONS:
        for construction in ("spectrum", "lines"):
            cut = cut_off(folder.heights(station, construction))
            found = solve_map_and_lines(rubber, cut, tolerance=TOLERANCE, **LOAD).lines
            own = folder.maps(station, construction)[0]["lines"]
            yield f"station {station}, {construction}, cut off: {found[AREA] / own[AREA]:.3f}"


def spread(values: Iterable[float]) -> str:
    """Return mean and standard deviation as text."""
    known = np.array(list(values))
    return f"{known.mean():.3f} ± {known.std(ddof=1):.3f}"
