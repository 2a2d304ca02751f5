"""Maps whose lines, in every direction, have the statistics of measured lines.

Every statistic wants a correction c_j of the answers of a filter F_j along one direction
(`line_statistics`). The waves that come nearest to all of a batch are known wave by wave,

    dz(q) = sum_j conj(F_j(q . d_j)) c_j(q) / sum_j |F_j(q . d_j)|^2,

which is sliced optimal transport (J. Rabin et al., SSVM 2011, doi:10.1007/978-3-642-24785-9_37) of
line pieces, and texture synthesis by histograms of filters (D. J. Heeger & J. R. Bergen, SIGGRAPH
1995, doi:10.1145/218380.218446) with filters along lines. Directions are spread evenly over each
batch. Coarse squares come first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.surface.maps.line_statistics import LineStatistic, line_statistics
from gripscale.surface.maps.measured import MeasuredLine
from gripscale.surface.maps.square import ComplexArray, Square

BATCH = 16
"""Statistics corrected at once."""

STAGES = ((8, 250), (4, 250), (2, 120), (1, 60))
"""Steps of the square over the map's, and batches on it."""

STATISTICS = 192
"""Drawn for each square."""

SHARES = (1.5, 0.5)
"""Of the correction: more than all of it comes nearer in fewer batches; at the end less, because
what a batch corrects by chance is roughness."""

LAST = 0.3
"""Share of the batches on a square that are the end."""

_FLOOR = 1e-3
"""Of the sum of |F|^2, over its largest: waves hardly seen by a batch hardly move."""


@dataclass(frozen=True, eq=False)
class LineMatching:
    """The statistics of measured lines on every square, to draw maps from."""

    square: Square
    stages: list[tuple[Square, int, list[LineStatistic]]]

    @staticmethod
    def of(lines: Sequence[MeasuredLine], square: Square) -> LineMatching:
        """Return the statistics of the lines for maps on `square`; filters are always the same."""
        random = np.random.default_rng(0)
        stages = []
        for coarser, batches in STAGES:
            part = Square(square.points // coarser, square.length)
            stages.append((part, batches, line_statistics(lines, part, STATISTICS, random)))
        return LineMatching(square, stages)

    @property
    def batches(self) -> int:
        """Number of batches of a map."""
        return sum(batches for _, batches, _ in self.stages)

    def draw(
        self,
        waves: ComplexArray,
        random: np.random.Generator,
        on_batch: Callable[[int], None] | None = None,
    ) -> ComplexArray:
        """Return the half spectrum of a map, started from that of another."""
        before, done = self.square, 0
        for square, batches, statistics in self.stages:
            waves = before.onto(waves, square).astype(np.complex64)
            for number in range(batches):
                chosen = random.choice(len(statistics), BATCH, replace=False)
                share = SHARES[number >= (1.0 - LAST) * batches]
                waves = waves + share * _step(
                    square, waves, [statistics[at] for at in chosen], random
                )
                done += 1
                if on_batch is not None:
                    on_batch(done)
            before = square
        return waves


def _step(
    square: Square,
    waves: ComplexArray,
    statistics: list[LineStatistic],
    random: np.random.Generator,
) -> ComplexArray:
    """Return the change of the waves that corrects the statistics best."""
    wanted = np.zeros(waves.shape, dtype=np.complex64)
    seen = np.zeros(waves.shape, dtype=np.float32)
    for number, statistic in enumerate(statistics):
        angle = np.pi * (number + random.random()) / len(statistics)
        factor, correction = statistic.correction(square, waves, angle)
        wanted += np.conj(factor) * square.spectrum(correction)
        seen += np.abs(factor) ** 2
    return np.asarray(np.where(square.carried, wanted / (seen + _FLOOR * seen.max()), 0.0))
