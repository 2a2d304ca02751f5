"""Surfaces whose contact is known, to judge the answer from files of two of their lines.

    python -m tests.verification.known_surfaces [--kept] [--ridges]

Families of synthetic isotropic surfaces: the law of `gripscale.half_space.line_to_map` was fitted
to three of them (other seeds of studies/surface_families.py) and to nothing of the sixteen others.
The truth is the contact of the whole map with the same Gaussian cut-off. Two lines are written to
files with spikes and dropouts, as lasers leave them, and read, cleaned and answered as those of a
user. Three rubbers, one of them also softened, at 0.03 to 10 bar; speeds go from 1 cm/s to 10 m/s.

Truths are refined until their estimated error is 5 %, or they have a million points: half an hour
of one core. They are kept in results/known_surfaces, and so are the contacts of the lines: with
`--kept` a changed law is judged in a minute. Who changes the solver deletes them.
"""

import argparse
import json
import math
import tempfile
import zlib
from collections.abc import Iterable
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

import gripscale as gs
from gripscale.conditions.conditions import Conditions
from gripscale.core.status import Status
from gripscale.questions.answer.estimate import DIRECT, ESTIMATED, answer_of_samples
from gripscale.rubber import styrene_butadiene
from gripscale.rubber.softening import softening_of_sweeps
from gripscale.surface import HeightMap, Profile
from studies import shipped, surface_families
from studies.direct_samples import SMALL_STRAIN, direct_samples
from studies.treads import compound, sweeps
from tests.samples import ROOT
from tests.verification import known_families
from tests.verification.known_families import INTERMITTENT, LARGEST, RIDGED, SHAPE, STEP, surface

Array = NDArray[np.float64]

CUT_OFF = 0.8e-3
"""Cut-off [m]; a line crosses shorter waves, too."""
UNSEEN = (*known_families.FAMILIES, *INTERMITTENT)
"""Families that no law was fitted to; of the others seeds that it was not fitted to."""
FITTED = tuple(surface_families.FAMILIES)
MODULATED = ("cascade", "lognormal", "exposed")
"""Families of the fit that are intermittent."""
ISOTROPIC = (*UNSEEN, *MODULATED)
SEEDS = range(8)
FIRST_FITTED = 100
PRESSURES = np.geomspace(3e3, 1e6, 6)
SPEEDS = (1e-2, 10.0)
SOFTENED = "S100, softened"
RUBBERS = ("tread", "S100", "unfilled", "tread", SOFTENED, "unfilled", SOFTENED, "tread")
"""Of the seeds."""
SPIKES, DROPOUTS = 0.004, 0.01
"""Share of the points of a file."""
TOLERANCE, MOST_POINTS = 0.05, 2**20
"""Estimated relative error of a truth, and eight points in the smallest wave: where the error is
larger still, four times as many changed two areas by 0 and 2 %, the frictions by less than 1 %."""
SOLVED = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)
QUANTITIES = ("area", "friction")
ROUNDING = 1e-4
"""Half-width of full contact, whose interval has none: a grid tells no smaller difference."""
KEPT = ROOT / "results" / "known_surfaces"
TRUTHS, LINES = KEPT / "truths.json", KEPT / "lines.json"


class Known(NamedTuple):
    """A surface under a load."""

    family: str
    seed: int
    pressure: float
    speed: float
    rubber: str = "tread"

    @property
    def map(self) -> HeightMap:
        """The heights of the surface."""
        if self.family in FITTED:
            return surface_families.family_map(self.family, FIRST_FITTED + self.seed)
        return surface(self.family, self.seed)

    def key(self, whole: HeightMap) -> str:
        """What its numbers are kept by: heights and load."""
        load = f"{self.pressure:.4g} Pa, {self.speed:.4g} m/s"
        load += "" if self.rubber == "tread" else f", {self.rubber}"
        return f"{whole.name}, {load}, heights {zlib.crc32(whole.z.tobytes()):08x}"

    @property
    def conditions(self) -> Conditions | None:
        """Softening as measured on the rubber; None without."""
        if self.rubber != SOFTENED:
            return None
        law = softening_of_sweeps(list(sweeps("S100").values()), measured_at=1e-3)
        return Conditions(softening=law)

    def case(self, measured: Any, **options: Any) -> gs.Case:
        """A case of what was measured of the surface."""
        load = {"pressure": self.pressure, "speed": self.speed, "smallest_wavelength": CUT_OFF}
        return gs.Case(measured, rubber(self.rubber), **load, conditions=self.conditions, **options)


def known(family: str, seed: int) -> Known:
    """Return a surface with its load; the speed is random.

    The pressures begin anew with each family, at another one.
    """
    random = np.random.default_rng([seed, zlib.crc32(family.encode()), 1])
    speed = math.exp(random.uniform(*np.log(SPEEDS)))
    at = (seed + zlib.crc32(family.encode())) % len(PRESSURES)
    return Known(family, seed, float(PRESSURES[at]), speed, RUBBERS[seed % len(RUBBERS)])


def all_known(families: Iterable[str] = ISOTROPIC, seeds: Iterable[int] = SEEDS) -> list[Known]:
    """Return surfaces of each family, eight of each isotropic one if nothing is said."""
    return [known(family, seed) for seed, family in product(seeds, families)]


@cache
def rubber(name: str) -> gs.Rubber:
    """Return the filled tread rubber, compound S100 or the unfilled one."""
    if name.startswith("S100"):
        return compound("S100")
    if name == "unfilled":
        return styrene_butadiene()
    return shipped.tread()


def kept(path: Path) -> dict[str, Any]:
    """Return what a file keeps."""
    entries: dict[str, Any] = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    return entries


def keep(path: Path, key: str, entry: Any) -> None:
    """Add an entry to a file, or replace it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(kept(path) | {key: entry}, indent=1), encoding="utf-8")


def truth(which: Known, path: Path = TRUTHS) -> dict[str, float]:
    """Return area and friction of a map; what is solved is kept."""
    whole = which.map
    key = which.key(whole)
    if key not in kept(path):
        solved = gs.solve_rough_contact(
            rubber(which.rubber),
            whole,
            pressure=which.pressure,
            speed=which.speed,
            smallest_wavelength=CUT_OFF,
            periodic=True,
            workers=1,
            tolerance=TOLERANCE,
            most_points=MOST_POINTS,
            conditions=which.conditions,
        )
        assert solved.status in SOLVED, f"{whole.name}: {solved.status}"
        numbers = (solved.contact_fraction, solved.friction_from_dissipation)
        keep(path, key, dict(zip(QUANTITIES, numbers, strict=True)))
    return dict(kept(path)[key])


def two_lines(whole: HeightMap, seed: int) -> list[Profile]:
    """Return two lines at random places, a largest wave apart at least."""
    random, width = np.random.default_rng([seed, 2]), SHAPE[1]
    apart = round(LARGEST / STEP)
    first = int(random.integers(width))
    second = (first + int(random.integers(apart, width - apart))) % width
    return [Profile(whole.x, whole.z[:, column]) for column in (first, second)]


def as_lasers_measure(line: Profile, random: np.random.Generator) -> Array:
    """Return heights with spikes of one to three samples and with gaps behind falling sides."""
    z = line.z.copy()
    for _ in range(int(SPIKES * z.size)):
        first, width = int(random.integers(z.size - 3)), int(random.integers(1, 4))
        z[first : first + width] += random.choice([-1.0, 1.0]) * random.uniform(0.5e-3, 4e-3)
    steepest = np.argsort(np.diff(line.z))[: int(0.25 * DROPOUTS * z.size)]
    for edge in steepest:
        z[edge + 1 : edge + 1 + int(random.integers(2, 7))] = np.nan
    return z


def written(which: Known, whole: HeightMap, folder: Path) -> list[Path]:
    """Write the files of two lines [mm]."""
    random = np.random.default_rng([which.seed, zlib.crc32(which.family.encode()), 3])
    files = []
    for number, line in enumerate(two_lines(whole, which.seed)):
        path = folder / f"line_{number}.txt"
        columns = 1e3 * np.stack([line.x, as_lasers_measure(line, random)], axis=1)
        np.savetxt(path, columns, fmt="%.6f", header="x [mm]  z [mm]")
        files.append(path)
    return files


def lines_from_files(which: Known, anew: bool = True, path: Path = LINES) -> xr.Dataset:
    """Return the direct contacts of two lines, from their files; those that are kept unless `anew`.

    Without alternatives: errors of the series of the rubber and of its softening, which the truth
    has, too, would widen the interval by what cannot go wrong here.
    """
    key = which.key(which.map)
    if anew or key not in kept(path):
        with tempfile.TemporaryDirectory() as folder:
            profiles = [gs.read_profile(file) for file in written(which, which.map, Path(folder))]
        samples = direct_samples(which.case(profiles, cleaning={}))
        lines = [name for name in samples.data_vars if samples[name].dims == ("sample",)]
        keep(path, key, samples[lines].to_dict())
    return xr.Dataset.from_dict(kept(path)[key])


def judged(surfaces: Iterable[Known], anew: bool = True) -> dict[str, pd.DataFrame]:
    """Return estimates and truths of all surfaces, by quantity; lines that are kept or anew.

    `miss` is ln(estimate / truth), `half_width` that of the interval with 90 % confidence in
    ln(value), `off` the magnitude of the miss in half-widths.
    """
    rows: dict[str, list[dict[str, Any]]] = {quantity: [] for quantity in QUANTITIES}
    for which in surfaces:
        true, lines = truth(which), lines_from_files(which, anew)
        best = answer_of_samples(lines.expand_dims(model=[DIRECT]), [SMALL_STRAIN])
        for quantity, name in zip(QUANTITIES, ESTIMATED, strict=True):
            miss = float(np.log(best[f"answer_{name}"] / true[quantity]))
            width = float(np.arcsinh(best[f"answer_{name}_half_width"]))
            numbers = {"miss": miss, "half_width": width, "off": abs(miss) / max(width, ROUNDING)}
            rows[quantity].append(which._asdict() | {"truth": true[quantity]} | numbers)
        misses = ", ".join(f"{name} {rows[name][-1]['off']:.2f}" for name in QUANTITIES)
        print(f"{which.family} {which.seed}: {misses}", flush=True)
    frames = {quantity: pd.DataFrame(found) for quantity, found in rows.items()}
    return {quantity: frame.assign(held=frame.off <= 1.0) for quantity, frame in frames.items()}


def table(results: pd.DataFrame) -> str:
    """Return a row for each family, pressure and rubber, for those never fitted to, and for all."""
    unseen = results.family.isin(UNSEEN).map({True: "never fitted to", False: "fitted to"})
    everything = results.family.map(lambda _: "all")
    groups = [results.family, results.pressure, results.rubber, unseen, everything]
    means = {"miss": ["mean", "std"], "half_width": "mean", "held": ["sum", "size"], "off": "max"}
    tables = [results.groupby(by).agg({"truth": ["min", "max"], **means}) for by in groups]
    return pd.concat(tables).round(3).to_string()


def main() -> None:
    """Print a table for area and friction."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ridges", action="store_true", help="surfaces with ridges at 3 bar")
    parser.add_argument("--kept", action="store_true", help="contacts of lines of the last run")
    options = parser.parse_args()
    surfaces = all_known()
    if options.ridges:
        loads = product(RIDGED, range(4))
        surfaces = [Known(family, seed, 3e5, 0.3) for family, seed in loads]
    for name, results in judged(surfaces, anew=not options.kept).items():
        print(name, table(results), sep="\n", end="\n\n")


if __name__ == "__main__":
    main()
