"""Intervals of pieces and halves of maps against the whole map, seventeen families.

A piece of 51 x 26 mm is a usual scan. Whole maps and parts are solved on grids of the same step, so
that their difference is that of the surface. Two minutes of one core.
"""

import math
import zlib

import numpy as np
import pytest
from scipy.special import stdtrit

import gripscale as gs
from gripscale.half_space import RoughContact
from gripscale.half_space.sampling_error import PIECE, SamplingError, sampling_error
from gripscale.surface import HeightMap
from tests.verification.known_surfaces import FITTED, UNSEEN, known, rubber

pytestmark = pytest.mark.verification

CUT_OFF = 0.8e-3
SEED = 303
HALVES = (slice(0, 512), slice(0, 256)), (slice(512, 1024), slice(0, 256))
PIECES = (slice(0, 256), slice(0, 128)), (slice(512, 768), slice(128, 256))
MEASURES = {"contact_fraction": "contact_fraction", "friction": "friction_from_dissipation"}


def contact(part: HeightMap, pressure: float, speed: float, periodic: bool = False) -> RoughContact:
    return gs.solve_rough_contact(
        rubber("tread"), part, pressure=pressure, speed=speed, smallest_wavelength=CUT_OFF,
        periodic=periodic, tolerance=None, workers=1,
    )  # fmt: skip


def error_of(part: HeightMap, solved: RoughContact) -> SamplingError:
    waves = gs.fit_sines(gs.height_difference(part), scales=8, smallest_wavelength=CUT_OFF)
    return sampling_error(solved, PIECE * float(waves.wavelength[0]))


def test_intervals_of_parts_hold_the_whole_map() -> None:
    """Nine of ten are 31 of 34 pieces and 15 of 17 halves; less than 27 and 12 is chance of 3 %."""
    held: dict[str, list[bool]] = {f"{part} {name}": [] for part in "ph" for name in MEASURES}
    for family in (*UNSEEN, *FITTED):
        which = known(family, SEED)
        random = np.random.default_rng([SEED, zlib.crc32(family.encode()), 77])
        load = math.exp(random.uniform(math.log(3e4), math.log(1e6))), which.speed
        fine = which.map
        whole = HeightMap(fine.x[::2], fine.y[::2], fine.z[::2, ::2])
        true = contact(whole, *load, periodic=True)
        parts = [HeightMap(whole.x[a], whole.y[b], whole.z[a, b]) for a, b in (*PIECES, *HALVES)]
        solved = [contact(part, *load) for part in parts]
        errors = [error_of(*pair) for pair in zip(parts, solved, strict=True)]
        for name, measure in MEASURES.items():
            logs = [math.log(getattr(each, measure)) for each in solved]
            variances = [getattr(error, name) ** 2 for error in errors]
            freedoms = [error.pieces - 1.0 for error in errors]
            for log, variance, freedom in list(zip(logs, variances, freedoms, strict=True))[:2]:
                width = stdtrit(freedom, 0.95) * math.sqrt(variance)
                held[f"p {name}"].append(abs(log - math.log(getattr(true, measure))) <= width)
            both = sum(variances[2:])
            freedom = both**2 / sum(
                v**2 / n for v, n in zip(variances[2:], freedoms[2:], strict=True)
            )
            width = stdtrit(freedom, 0.95) * math.sqrt(both)
            held[f"h {name}"].append(abs(logs[2] - logs[3]) <= width)
    print({name: f"{sum(each)} of {len(each)}" for name, each in held.items()})
    for name, each in held.items():
        assert sum(each) >= (27 if name.startswith("p") else 12)
