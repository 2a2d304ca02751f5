"""The numbers and the figure of docs/isotropic-maps.md: synthetic maps against the measured lines.

Run as `python -m studies.isotropic_maps`; what is done is kept in the output folder, one file a
map, and not computed again. About half an hour of one core for six seeds.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from gripscale.rough import solve_map_and_lines, solve_windows, windows
from gripscale.surface import HeightMap, Profile, isotropic_maps
from gripscale.surface.maps.measured import measured_lines
from studies.isotropic_maps_figure import draw

DATA = Path(__file__).parents[1] / "examples/data"
STATIONS = (0, 1)
CONSTRUCTIONS = ("spectrum", "heights", "lines")
AREA, FRICTION = "contact_fraction", "friction_from_dissipation"
SMALLEST, POINTS = 0.4e-3, 512
LENGTH = POINTS * SMALLEST / 4
LOAD = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": SMALLEST}
LAGS = (0.2e-3, 0.8e-3, 3.2e-3, 12.8e-3)
TOLERANCE = 0.05

Numbers = dict[str, float]
Lines = NDArray[np.float64]
"""Shape (lines, points) [m]."""


def road(station: int) -> Profile:
    """Return a station of the shipped road, cleaned."""
    path = DATA / "road" / f"20211011_aylesbury_dec_station_{station}.dat"
    cleaned = gs.clean(gs.read_profile(path), crop=(0.12, 1.78))[0]
    return Profile(cleaned.x, cleaned.z, f"station {station}")


def tread() -> gs.Rubber:
    """Return the shipped tread rubber."""
    return gs.fit_prony(gs.read_master_curve(DATA / "rubber/measured_dma.txt"))


def statistics(lines: Lines, step: float) -> Numbers:
    """Return heights, slopes and C_z of lines without the waves that the contact does not see."""
    waves = np.fft.rfft(lines - lines.mean(), axis=1)
    q = 2.0 * np.pi * np.fft.rfftfreq(lines.shape[1], step)
    waves[:, q > 2.0 * np.pi / SMALLEST * (1.0 + 1e-9)] = 0.0
    z = np.fft.irfft(waves, lines.shape[1], axis=1)
    slope = np.fft.irfft(1j * q * waves, lines.shape[1], axis=1)
    high = z >= np.quantile(z, 0.9, axis=1, keepdims=True)
    found = {
        "rms height": float(z.std()),
        "skewness": float(np.mean(z**3) / z.std() ** 3),
        "rms slope": float(slope.std()),
        "rms slope, top tenth": float(slope[high].std()),
    }
    for lag in LAGS:
        moved = np.fft.irfft(waves * np.exp(1j * q * lag), lines.shape[1], axis=1)
        found[f"C_z({lag * 1e3:g} mm)"] = float(np.mean((moved - z) ** 2))
    return found


def measured(rubber: gs.Rubber, station: int) -> dict[str, object]:
    """Return contacts and statistics of the windows of a station."""
    profile = road(station)
    contacts = solve_windows(rubber, profile, LENGTH, tolerance=TOLERANCE, **LOAD)
    joined = []
    for window in windows(profile, LENGTH):
        known = np.isfinite(window.z)
        z = np.interp(window.x, window.x[known], window.z[known])
        joined.append(z - np.linspace(z[0], z[-1], z.size))
    # a window has no mean of its own: heights are those of the whole line that maps are made from
    heights = measured_lines([profile], LENGTH)[0].heights[None, :]
    whole = statistics(heights, profile.step)
    of_windows = statistics(np.array(joined), profile.step)
    own = {name: whole[name] for name in ("rms height", "skewness")}
    return {
        "windows": {name: contacts.values(name).tolist() for name in (AREA, FRICTION)},
        "statistics": of_windows | own,
    }


def of_map(rubber: gs.Rubber, surface: HeightMap, *, turned: bool) -> dict[str, object]:
    """Return contacts and statistics of a map and its lines; of it turned by 45 degrees, too."""
    contact = solve_map_and_lines(rubber, surface, tolerance=TOLERANCE, **LOAD)
    lines = np.concatenate([surface.z[:, ::16].T, surface.z[::16, :]])
    found: dict[str, object] = {
        "map": contact.whole,
        "lines": contact.lines,
        "between directions": contact.between_directions,
        "statistics": statistics(lines, surface.step[0]),
    }
    if turned:
        diagonal = gs.solve_rough_contact(
            rubber, turned_by_45_degrees(surface), periodic=True, tolerance=None, **LOAD
        )
        found["map at 45 degrees"] = {
            name: float(getattr(diagonal, name)) for name in (AREA, FRICTION)
        }
    return found


def turned_by_45_degrees(surface: HeightMap) -> HeightMap:
    """Return the same periodic surface along its diagonals: a square of twice the area."""
    points = surface.z.shape[0]
    waves = np.fft.fftshift(np.fft.fft2(surface.z))
    waves[0, :] = waves[:, 0] = 0.0  # the highest waves have no phase
    finer = np.fft.ifft2(np.fft.ifftshift(np.pad(waves, points // 2))).real * 4.0
    along, across = np.meshgrid(np.arange(2 * points), np.arange(2 * points), indexing="ij")
    z = finer[(along + across) % (2 * points), (along - across) % (2 * points)]
    x = np.arange(2 * points) * surface.step[0] / np.sqrt(2.0)
    return HeightMap(x, x, z, surface.name)


def of_cut_maps(folder: Path) -> Iterator[str]:
    """Yield the area of lines of a map that is cut off as it is solved, over that of its lines."""
    rubber = tread()
    for station in STATIONS:
        for construction in ("spectrum", "lines"):
            z = np.load(folder / f"{station}_{construction}.npy").astype(float)
            q = 2.0 * np.pi * np.fft.fftfreq(POINTS, LENGTH / POINTS)
            seen = np.hypot(q[:, None], q) <= 2.0 * np.pi / SMALLEST * (1.0 + 1e-9)
            x = LENGTH / POINTS * np.arange(POINTS)
            cut = HeightMap(x, x, np.fft.ifft2(np.where(seen, np.fft.fft2(z), 0.0)).real)
            found = solve_map_and_lines(rubber, cut, tolerance=TOLERANCE, **LOAD).lines
            own = kept(name(folder, station, construction, 0))["lines"]
            yield f"station {station}, {construction}, cut off: {found[AREA] / own[AREA]:.3f}"


def kept(path: Path) -> dict[str, object] | None:
    """Return what is in a file, or None."""
    return json.loads(path.read_text()) if path.exists() else None


def compute(folder: Path, seeds: int) -> None:
    """Compute what is not in the folder yet, the seeds one after the other."""
    rubber = tread()
    for station in STATIONS:
        path = folder / f"{station}_measured.json"
        if not path.exists():
            path.write_text(json.dumps(measured(rubber, station)))
    pairs = [(station, construction) for station in STATIONS for construction in CONSTRUCTIONS]
    maps = {pair: missing(folder, *pair, number(pair[1], seeds)) for pair in pairs}
    while maps:
        for pair in list(maps):
            seed, surface = next(maps[pair], (None, None))
            if surface is None:
                del maps[pair]
                continue
            found = of_map(rubber, surface, turned=pair[1] == "lines")
            name(folder, *pair, seed).write_text(json.dumps(found))
            print(*pair, seed, found["map"], found["lines"], flush=True)


def number(construction: str, seeds: int) -> int:
    """Return how many maps are made: half as many of those that miss what matters."""
    return seeds if construction == "lines" else (seeds + 1) // 2


def name(folder: Path, station: int, construction: str, seed: int) -> Path:
    """Return the file of a map's numbers."""
    return folder / f"{station}_{construction}_{seed}.json"


def missing(
    folder: Path, station: int, construction: str, seeds: int
) -> Iterator[tuple[int, HeightMap]]:
    """Yield the maps whose numbers are not in the folder; keep the heights of the first."""
    to_do = [
        seed for seed in range(seeds) if not name(folder, station, construction, seed).exists()
    ]
    maps = isotropic_maps(
        road(station), smallest_wavelength=SMALLEST, construction=construction, seeds=to_do
    )
    for seed, surface in zip(to_do, maps, strict=True):
        if seed == 0:
            np.save(folder / f"{station}_{construction}.npy", surface.z.astype(np.float32))
        yield seed, surface


def spread(values: list[float]) -> str:
    """Return mean and standard deviation as text."""
    return f"{np.mean(values):.3f} ± {np.std(values, ddof=1):.3f}"


def tables(folder: Path, seeds: int) -> Iterator[str]:
    """Yield the lines of the page's tables."""
    yield "| station | maps | lines A | lines mu | map A | map mu | factor A | factor mu |"
    yield "|---|---|---|---|---|---|---|---|"
    for station in STATIONS:
        base = kept(folder / f"{station}_measured.json")
        yield (
            f"| {station} | measured | {spread(base['windows'][AREA])} "
            f"| {spread(base['windows'][FRICTION])} | | | | |"
        )
        for construction in CONSTRUCTIONS:
            found = [
                kept(name(folder, station, construction, seed))
                for seed in range(number(construction, seeds))
            ]
            cells = [
                spread([f[part][q] for f in found])
                for part in ("lines", "map")
                for q in (AREA, FRICTION)
            ]
            for q in (AREA, FRICTION):
                mean = np.mean([f["map"][q] for f in found]) / np.mean(
                    [f["lines"][q] for f in found]
                )
                each = np.std([f["map"][q] / f["lines"][q] for f in found], ddof=1)
                cells.append(f"{mean:.2f} ± {each:.2f}")
            yield f"| {station} | {construction} | {' | '.join(cells)} |"
    yield ""
    yield from statistics_table(folder, seeds)
    yield ""
    yield from directions(folder, seeds)


def statistics_table(folder: Path, seeds: int) -> Iterator[str]:
    """Yield what the lines of the maps share with the measured ones."""
    first = kept(folder / f"{STATIONS[0]}_measured.json")["statistics"]
    yield "| station | lines | " + " | ".join(first) + " |"
    yield "|---" * (len(first) + 2) + "|"
    for station in STATIONS:
        base = kept(folder / f"{station}_measured.json")["statistics"]
        yield f"| {station} | measured | " + " | ".join(cell(k, v) for k, v in base.items()) + " |"
        for construction in CONSTRUCTIONS:
            found = [
                kept(name(folder, station, construction, seed))["statistics"]
                for seed in range(number(construction, seeds))
            ]
            means = {k: float(np.mean([one[k] for one in found])) for k in base}
            row = " | ".join(cell(k, v) for k, v in means.items())
            yield f"| {station} | {construction} | {row} |"


def cell(quantity: str, value: float) -> str:
    """Return a statistic with its unit."""
    if quantity == "rms height":
        return f"{value * 1e3:.2f} mm"
    if quantity.startswith("C_z"):
        return f"{value * 1e6:.3g} mm²"
    return f"{value:.2f}"


def directions(folder: Path, seeds: int) -> Iterator[str]:
    """Yield how much a map's answer depends on the way of sliding."""
    for station in STATIONS:
        found = [kept(name(folder, station, "lines", seed)) for seed in range(seeds)]
        for q in (AREA, FRICTION):
            turned = [f["map at 45 degrees"][q] / f["map"][q] for f in found]
            across = [f["between directions"][q] for f in found]
            yield f"station {station}, {q}: along x over y {spread(across)}, 45° {spread(turned)}"


def main() -> None:
    """Compute, print the tables and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("results/isotropic_maps"))
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--figure", type=Path, help="file; in the output folder by default")
    asked = parser.parse_args()
    asked.output.mkdir(parents=True, exist_ok=True)
    compute(asked.output, asked.seeds)
    print("\n".join(tables(asked.output, asked.seeds)))
    print("\n".join(of_cut_maps(asked.output)))
    maps = {c: np.load(asked.output / f"0_{c}.npy").astype(float) for c in CONSTRUCTIONS}
    draw(road(0), maps, LENGTH, asked.figure or asked.output / "isotropic_maps.png")


if __name__ == "__main__":
    main()
