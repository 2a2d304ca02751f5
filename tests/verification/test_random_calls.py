"""Random arguments, within reason and beyond: an answer, or one sentence, never NaN that converged.

`GRIPSCALE_CALLS` sets how many of each function; a failure names its seed.
"""

import os
import random
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import gripscale as gs
from gripscale import theory
from gripscale.core.errors import ConvergenceError, InputError, RubberWarning

MANY = int(os.environ.get("GRIPSCALE_CALLS", "3000"))
FEW = 12
SLOW = ("sines",)
"""A tenth of a second a call: a tenth as many are drawn."""
LONGEST = 10.0
"""Seconds a call may take."""

Call = Callable[[random.Random], Any]


def number(chance: random.Random, usual: float) -> float:
    """Return a number near the usual one, decades away, or beyond reason."""
    decades = chance.choice([0.0, 0.0, 0.3, 0.3, 0.3, 1.0, 1.0, 3.0, 12.0, 60.0])
    odd = [0.0, -usual, float("nan"), float("inf"), 1e308, 1e-320, 1e100, 1e-100]
    if chance.random() < 0.02:
        return chance.choice(odd)
    return float(usual) * 10.0 ** chance.gauss(0.0, decades)


def scaled(size: float, shape: np.ndarray) -> np.ndarray:
    """Return a shape of a size, which may be beyond floating point: no warning of ours counts."""
    with np.errstate(all="ignore"):
        return np.asarray(size * shape)


def rubber(chance: random.Random) -> gs.Rubber:
    terms = chance.choice([0, 1, 3, 10])
    times = [number(chance, 1e-3) for _ in range(terms)]
    moduli = [number(chance, 1e6) for _ in range(terms)]
    bulk = number(chance, 1e9) if chance.random() < 0.5 else 1e3 * (1e6 + sum(moduli))
    with warnings.catch_warnings(action="ignore", category=RubberWarning):  # nearly no bulk modulus
        return gs.Rubber(number(chance, 1e6), moduli, times, bulk_modulus=bulk)


def pressed(chance: random.Random) -> dict[str, float]:
    return {"pressure": number(chance, 3e5), "speed": number(chance, 0.3)}


def sine(chance: random.Random) -> dict[str, float]:
    length = number(chance, 1e-3)
    return {"wavelength": length, "amplitude": number(chance, 0.1 * length)}


def half_plane(chance: random.Random) -> Any:
    options = {"points": chance.choice([16, 64, 200]), "load_time": number(chance, 1.0)}
    return theory.solve_half_plane(rubber(chance), **sine(chance), **pressed(chance), **options)


def rough_line(chance: random.Random) -> Any:
    step = number(chance, 1e-3)
    place = scaled(step, np.arange(64))
    shape = np.random.default_rng(chance.randrange(2**32)).normal(size=64).cumsum()
    height = scaled(number(chance, 0.1 * step), shape)
    if chance.random() < 0.3:
        height[chance.randrange(64) : chance.randrange(64)] = np.nan
    return gs.solve_rough_contact(
        rubber(chance),
        gs.Profile(place, height),
        **pressed(chance),
        periodic=chance.random() < 0.5,
        tolerance=chance.choice([None, 0.02, 0.3]),
        most_points=4096,
        time_limit=0.4 * LONGEST,  # very lossy rubber takes longer; threads of BLAS count, too
    )


def sines(chance: random.Random) -> Any:
    lag = scaled(number(chance, 1e-4), np.geomspace(1.0, 10.0 ** chance.uniform(0.1, 5.0), 30))
    knee, top = lag[chance.randrange(30)], number(chance, 1e-8)
    power = chance.uniform(-0.5, 3.0)
    scatter = np.exp([chance.gauss(0.0, chance.choice([0.0, 0.1, 2.0])) for _ in lag])
    with np.errstate(all="ignore"):
        value = scaled(top, np.minimum((lag / knee) ** power, 1.0) * scatter)
    given = {
        "scales": chance.choice([None, 1, 3, 8]),
        "s_wavelength": number(chance, 3.0),
        "smallest_wavelength": number(chance, lag[3]),
        "cut_off": number(chance, lag[3]),
        "s_amplitude": number(chance, 2.0),
        "first_amplitude": number(chance, top**0.5),
        "single_factor": chance.random() < 0.5,
        "smallest_lag": number(chance, lag[2]),
    }
    kept = dict(chance.sample(sorted(given.items()), chance.randint(1, 3)))
    return gs.fit_sines(gs.HeightDifference(lag, value), **kept)


def prony(chance: random.Random) -> Any:
    rows = chance.choice([1, 2, 5, 12])
    start, factor = number(chance, 1.0), 10.0 ** chance.uniform(0.0, 2.0)
    frequency = [start * factor**i for i in range(rows)]
    storage = [number(chance, 1e7) for _ in range(rows)]
    loss = [number(chance, 1e6) for _ in range(rows)]
    options = {
        "terms": chance.choice([None, 1, 4]),
        "smoothing": number(chance, 0.1),
        "extrapolate_decades": number(chance, 1.0),
    }
    kept = dict(chance.sample(sorted(options.items()), chance.randint(0, 2)))
    found = gs.fit_prony(gs.MasterCurve(frequency, storage, loss), **kept)
    assert np.isfinite(found.complex_modulus(2.0 * np.pi * np.array(frequency))).all()
    return found


CALLS: dict[str, Call] = {one.__name__: one for one in (half_plane, rough_line, sines, prony)}
TOLD = ("friction", "contact_fraction", "friction_from_dissipation")


def unknown(found: Any) -> list[str]:
    """Return which totals are NaN, though the result says that it converged."""
    if not getattr(found, "converged", False):
        return []
    return [name for name in TOLD if not np.isfinite(getattr(found, name, 0.0)).all()]


def faults(name: str, seeds: range) -> tuple[list[str], int]:
    """Return what is wrong with the answers, and how many answers there are."""
    wrong, answered = [], 0
    for seed in seeds:
        start = time.process_time()
        try:
            missing = unknown(CALLS[name](random.Random(seed)))
            answered += 1
            if missing:
                wrong.append(f"seed {seed}: converged with {', '.join(missing)} NaN")
        except (InputError, ConvergenceError) as error:
            if not str(error).isprintable() or len(str(error)) > 400:
                wrong.append(f"seed {seed}: no sentence: {str(error)[:500]!r}")
        except Exception as error:
            wrong.append(f"seed {seed}: {type(error).__name__}: {error}")
        if time.process_time() - start > LONGEST:
            wrong.append(f"seed {seed}: longer than {LONGEST} s")
    return wrong, answered


def judged(name: str, count: int) -> None:
    wrong, answered = faults(name, range(count))
    assert not wrong, f"{len(wrong)} of {count}:\n" + "\n".join(wrong[:12])
    assert 0 < answered < count


@pytest.mark.parametrize("name", CALLS)
def test_a_sample_of_random_calls(name: str) -> None:
    judged(name, FEW)


@pytest.mark.verification
@pytest.mark.parametrize("name", CALLS)
def test_random_calls(name: str) -> None:
    judged(name, MANY // 10 if name in SLOW else MANY)
