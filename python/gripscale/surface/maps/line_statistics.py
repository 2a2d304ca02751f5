"""What the lines of a map must share with measured lines: distributions of filter answers.

Half of the filters are sums of terms (what goes with what); the others are slopes and curvatures,
each by class of the height smoothed about them (where the roughness sits). Widths are drawn evenly
in their logarithm, from the step of the map to an eighth of its length.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.surface.maps.line_filter import BELL, CURVATURE, SLOPE, LineFilter, Term, scaled
from gripscale.surface.maps.measured import MeasuredLine
from gripscale.surface.maps.square import ComplexArray, Square
from gripscale.surface.maps.transport import Distribution
from gripscale.surface.profile import FloatArray

SMALLEST_WIDTH = 0.8
"""Of a filter, over the step of the map."""

LARGEST_WIDTH = 0.125
"""Of a filter, over the length of the map."""


@dataclass(frozen=True, eq=False)
class LineStatistic:
    """The distribution of a filter's answers on measured lines, by class of another's or of all."""

    filter: LineFilter
    beside: LineFilter | None
    wanted: Distribution

    @staticmethod
    def of(
        lines: Sequence[MeasuredLine], one: LineFilter, beside: LineFilter | None
    ) -> LineStatistic:
        """Return the statistic of measured lines."""
        other = None if beside is None else beside.on_lines(lines)
        return LineStatistic(one, beside, Distribution.of(one.on_lines(lines), other))

    def correction(
        self, square: Square, waves: ComplexArray, angle: float
    ) -> tuple[ComplexArray, FloatArray]:
        """Return the filter's factors, and what its answers along `angle` lack [rms of one]."""
        factor = self.filter.along(square, angle)
        answers = square.heights(factor * waves)
        other = None
        if self.beside is not None:
            other = square.heights(self.beside.along(square, angle) * waves)
        return factor, self.wanted.correction(answers, other)


def line_statistics(
    lines: Sequence[MeasuredLine], square: Square, number: int, random: np.random.Generator
) -> list[LineStatistic]:
    """Return `number` statistics of measured lines, of filters drawn for a map's square."""
    widths = _Widths(square, random)
    found = []
    for place in range(number):
        if place % 2:
            terms = (_together if random.random() < 0.6 else _several)(widths, lines, random)
            found.append(LineStatistic.of(lines, scaled(terms, lines), None))
        else:
            beside, term = _by_height(widths, random)
            one = scaled([term], lines)
            found.append(LineStatistic.of(lines, one, LineFilter((beside,))))
    return found


@dataclass(frozen=True)
class _Widths:
    """Draws widths of filters [m]."""

    square: Square
    random: np.random.Generator

    @property
    def least(self) -> float:
        return SMALLEST_WIDTH * self.square.step

    def draw(self, most: float | None = None) -> float:
        """Return a width up to `most`, at least twice the least."""
        largest = LARGEST_WIDTH * self.square.length
        ends = np.log([self.least, max(min(most or largest, largest), 2.0 * self.least)])
        return float(np.exp(self.random.uniform(*ends)))


def _by_height(widths: _Widths, random: np.random.Generator) -> tuple[Term, Term]:
    """Return a bell, and a slope or curvature no wider, mostly at its middle."""
    bell = widths.draw()
    width = widths.draw(bell)
    distance = 2.0 * width * random.standard_normal() * (random.random() < 0.4)
    return Term(BELL, bell), Term(int(random.choice((SLOPE, CURVATURE))), width, distance)


def _together(
    widths: _Widths, lines: Sequence[MeasuredLine], random: np.random.Generator
) -> list[Term]:
    """Return a bell with a slope or curvature, either of which may be nearly alone."""
    width = widths.draw()
    bell = Term(BELL, widths.draw())
    order = int(random.choice((SLOPE, CURVATURE)))
    other = Term(order, width, 1.4 * width * random.standard_normal())
    return [
        _weighted(bell, 1.0, lines),
        _weighted(other, random.choice((-1, 1)) * np.exp(1.5 * random.standard_normal()), lines),
    ]


def _several(
    widths: _Widths, lines: Sequence[MeasuredLine], random: np.random.Generator
) -> list[Term]:
    """Return one to three slopes and curvatures side by side."""
    drawn = [widths.draw() for _ in range(int(random.integers(1, 4)))]
    terms = []
    for place, width in enumerate(drawn):
        order = int(random.choice((SLOPE, CURVATURE)))
        distance = 2.0 * max(drawn) * random.standard_normal() * (place > 0)
        weight = random.choice((-1, 1)) * np.exp(0.5 * random.standard_normal())
        terms.append(_weighted(Term(order, width, distance), weight, lines))
    return terms


def _weighted(term: Term, weight: float, lines: Sequence[MeasuredLine]) -> Term:
    """Return the term that answers with rms `weight` on the lines."""
    rms = scaled([term], lines).scale
    return Term(term.order, term.width, term.distance, float(weight / rms))
