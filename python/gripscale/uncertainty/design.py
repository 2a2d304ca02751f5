"""Where each sample lies: all sources at once, each spread evenly over its own values.

A Latin hypercube (M. D. McKay, R. J. Beckman & W. J. Conover, Technometrics 21 (1979) 239,
doi:10.1080/00401706.1979.10489755): of N samples one lies in each N-th of every source. Columns and
random numbers are a source's own, by its name, so that leaving out one source changes no draw of
the others.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from gripscale.errors import InputError
from gripscale.uncertainty.inputs import Inputs
from gripscale.uncertainty.sources.source import Source


class Drawn(NamedTuple):
    """One sample: its inputs, or why there are none, and the coordinates of what was drawn."""

    inputs: Inputs | None
    coordinates: dict[str, float]
    why_not: str = ""


def draws(case: Inputs, sources: Sequence[Source], samples: int, seed: int) -> Iterator[Drawn]:
    """Yield the samples of a case."""
    columns = {source.name: _column(source.name, samples, seed) for source in sources}
    for sample in range(samples):
        inputs, why_not = case, ""
        coordinates: dict[str, float] = {}
        for source in sources:
            random = np.random.default_rng([seed, _number(source.name), sample])
            try:
                inputs, told = source.draw(columns[source.name][sample], random, inputs)
            except InputError as error:
                told, why_not = dict.fromkeys(source.coordinates, np.nan), str(error)
            coordinates |= told
        yield Drawn(None if why_not else inputs, coordinates, why_not)


def _column(name: str, samples: int, seed: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the places of a source in all samples, above 0 and below 1."""
    random = np.random.default_rng([seed, _number(name)])
    return qmc.LatinHypercube(1, rng=random).random(samples)[:, 0]


def _number(name: str) -> int:
    return zlib.crc32(name.encode())
