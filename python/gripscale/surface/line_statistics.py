"""What the lines of a map must share with measured lines: distributions of filter answers.

Half of the filters are sums of terms (what goes with what); the others are slopes and curvatures,
each by class of the height smoothed about them (where the roughness sits). Widths are drawn evenly
in their logarithm, from the step of the map to an eighth of its length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.core.arrays import Array, Mask
from gripscale.core.errors import InputError
from gripscale.surface.profile import Profile
from gripscale.surface.resampling import filled

# Moving values to a wanted distribution, over all of them or class by class of another value.
#
# The optimal transport in one dimension keeps the order: the value of rank r goes to the wanted
# quantile of rank r (C. Villani, Topics in Optimal Transportation (2003), sec. 2.2).

_TAIL = np.geomspace(2e-5, 4e-3, 12)
RANKS = np.concatenate((_TAIL, np.linspace(5e-3, 1.0 - 5e-3, 500), 1.0 - _TAIL[::-1]))
"""Of the quantiles a distribution is kept as."""

CLASS_ENDS = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.94, 0.97, 0.99])
"""Ranks between the classes: finer at the top, which touches."""

CLASSES = CLASS_ENDS.size + 1

_NODES = 2**12
"""Between lowest and highest value, where ranks are counted: sorting a map would take ten times."""

_NARROWEST = 1e-30

ClassArray = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Distribution:
    """Quantiles at `RANKS`, one row for each class of the values beside (one row: of all)."""

    quantiles: Array

    @staticmethod
    def of(values: Array, beside: Array | None = None) -> Distribution:
        """Return the distribution of values, by class of those `beside` if given."""
        if beside is None:
            return Distribution(_quantiles(values)[None, :])
        classes = height_class(beside)
        rows = [_quantiles(values[classes == number]) for number in range(CLASSES)]
        return Distribution(np.stack(rows))

    def correction(self, values: Array, beside: Array | None = None) -> Array:
        """Return what has to be added to values (any shape) for them to have this distribution.

        Exact to the distance of the nodes, 1/4096 of their range.
        """
        nodes, places = _counted(values)
        cells = places
        if beside is not None:
            cells = places + np.int32(_NODES) * height_class(beside).astype(np.int32)
        counts = np.bincount(cells.reshape(-1), minlength=self.quantiles.shape[0] * _NODES)
        ranks = _ranks(counts.reshape(-1, _NODES))
        wanted = [np.interp(r, RANKS, q) for r, q in zip(ranks, self.quantiles, strict=True)]
        table = (np.stack(wanted) - nodes).astype(values.dtype)
        return np.asarray(table.reshape(-1)[cells])


def height_class(values: Array) -> ClassArray:
    """Return the class of each value by its rank."""
    _, places = _counted(values)
    ranks = _ranks(np.bincount(places.reshape(-1), minlength=_NODES))
    return np.asarray(np.searchsorted(CLASS_ENDS, ranks).astype(np.uint8)[places])


def _quantiles(values: Array) -> Array:
    ordered = np.sort(values, axis=None)
    return np.interp(RANKS * ordered.size - 0.5, np.arange(ordered.size), ordered)


def _counted(values: Array) -> tuple[Array, NDArray[np.int32]]:
    """Return nodes from the lowest to the highest value, and the nearest to each value."""
    low, high = float(values.min()), float(values.max())
    scale = (_NODES - 1) / max(high - low, _NARROWEST)
    places = (values - low) * scale + 0.5
    return np.linspace(low, high, _NODES), np.asarray(places.astype(np.int32))


def _ranks(counts: NDArray[np.int64]) -> Array:
    """Return the rank of the middle of each node's values, along the last axis."""
    total = np.maximum(counts.sum(axis=-1, keepdims=True), 1)
    return np.asarray((np.cumsum(counts, axis=-1) - 0.5 * counts) / total)


# The square of equal steps an isotropic map is made on, one period of it, and its waves.

ComplexArray = NDArray[Any]


@dataclass(frozen=True)
class Square:
    """A periodic square.

    Attributes
    ----------
    points
        Each way, even.
    length
        Period each way [m].
    """

    points: int
    length: float

    @property
    def step(self) -> float:
        """Distance between points [m]."""
        return self.length / self.points

    @cached_property
    def axes(self) -> tuple[Array, Array]:
        """Wavenumbers along x and y [rad/m], broadcastable to a half spectrum (`rfft2`)."""
        number = 2.0 * np.pi / self.length
        x = number * np.rint(np.fft.fftfreq(self.points, 1.0 / self.points))
        return x[:, None], number * np.arange(self.points // 2 + 1.0)[None, :]

    @cached_property
    def wavenumber(self) -> Array:
        """|q| over a half spectrum [rad/m]."""
        return np.asarray(np.hypot(*self.axes))

    @property
    def resolved(self) -> Mask:
        """Which waves a map has: above the mean, below the highest in every direction."""
        q = self.wavenumber
        return np.asarray((q > 0.0) & (q < np.pi / self.step * (1.0 - 1e-9)))

    def heights(self, spectrum: ComplexArray) -> Array:
        """Return the heights [m] of a half spectrum."""
        from scipy.fft import irfft2

        return np.asarray(irfft2(spectrum, s=(self.points, self.points)))

    def spectrum(self, heights: Array) -> ComplexArray:
        """Return the half spectrum of heights [m]."""
        from scipy.fft import rfft2

        return np.asarray(rfft2(heights))

    def noise(self, random: np.random.Generator) -> Array:
        """Return white noise, of variance one."""
        return random.standard_normal((self.points, self.points))

    def onto(self, spectrum: ComplexArray, other: Square) -> ComplexArray:
        """Return the half spectrum on another square of the same length: waves of both."""
        kept = min(self.points, other.points) // 2
        out = np.zeros((other.points, other.points // 2 + 1), dtype=spectrum.dtype)
        out[:kept, :kept] = spectrum[:kept, :kept]
        out[1 - kept :, :kept] = spectrum[1 - kept :, :kept]
        scale = (other.points / self.points) ** 2
        return np.asarray(np.where(other.resolved, scale * out, 0.0))


# Measured profiles as one period each, without waves longer than a map holds.
#
# Missing heights are filled linearly and the straight line through the ends is taken out, as the
# direct contact does.

LONGEST = 2.0
"""Longest wave kept, over the period of the map: those up to twice as long appear in its first."""

FEWEST_PERIODS = 4
"""Periods of the map all profiles together must be long."""


@dataclass(frozen=True, eq=False)
class MeasuredLine:
    """The waves of one profile (`rfft`), their wavenumbers [rad/m] and its number of points."""

    waves: ComplexArray
    wavenumber: Array
    points: int

    @property
    def heights(self) -> Array:
        """Heights [m]."""
        return np.asarray(np.fft.irfft(self.waves, self.points))


def measured_lines(profiles: Sequence[Profile], length: float) -> list[MeasuredLine]:
    """Return the profiles for a map of period `length` [m].

    Raises
    ------
    InputError
        If they are too short for it.
    """
    total = sum(profile.length for profile in profiles)
    if total < FEWEST_PERIODS * length:
        raise InputError(
            f"profiles must be {FEWEST_PERIODS} times as long as a map together, "
            f"{FEWEST_PERIODS * length:.4g} m; got {total:.4g} m"
        )
    return [_line(profile, length) for profile in profiles]


def _line(profile: Profile, length: float) -> MeasuredLine:
    z = filled(profile.z)
    z = z - np.linspace(z[0], z[-1], z.size)
    waves = np.fft.rfft(z)
    q = np.asarray(2.0 * np.pi * np.fft.rfftfreq(z.size, profile.step), dtype=np.float64)
    waves[q < 2.0 * np.pi / (LONGEST * length)] = 0.0
    return MeasuredLine(waves, q, z.size)


# Filters along a line, and what they answer on measured lines and on maps.
#
# A filter is a sum of bells, their slopes and curvatures,
#
#     F(k) = sum_j w_j (i k s_j)^(n_j) exp(-(k s_j)^2/2 + i k t_j),    n_j = 0, 1, 2,
#
# of widths s_j at distances t_j along the line. On a map, along a direction d, it is F(q . d).

BELL, SLOPE, CURVATURE = 0, 1, 2

_TABLE = 2**14
"""Entries of the table a filter is looked up in on a map."""


@dataclass(frozen=True)
class Term:
    """One bell or derivative: its order, width [m], distance along the line [m] and weight."""

    order: int
    width: float
    distance: float = 0.0
    weight: float = 1.0

    def at(self, k: Array) -> ComplexArray:
        """Return the factor of waves of wavenumber `k` along the line [rad/m]."""
        ks = k * self.width
        bell = self.weight * np.exp(-0.5 * ks**2 + 1j * k * self.distance)
        return np.asarray((1j * ks) ** self.order * bell)


@dataclass(frozen=True)
class LineFilter:
    """A sum of terms over a scale: that of its answers on the measured lines, once `scaled`."""

    terms: tuple[Term, ...]
    scale: float = 1.0

    def at(self, k: Array) -> ComplexArray:
        """Return the factor of waves of wavenumber `k` along the line [rad/m]."""
        return np.asarray(sum(term.at(k) for term in self.terms) / self.scale)

    def on_lines(self, lines: Sequence[MeasuredLine]) -> Array:
        """Return the answers on measured lines, walked both ways: a road has no forward."""
        answers = []
        for line in lines:
            factor = self.at(line.wavenumber)
            for one in (factor, np.conj(factor)):
                answers.append(np.fft.irfft(one * line.waves, line.points))
        return np.concatenate(answers)

    def along(self, square: Square, angle: float) -> ComplexArray:
        """Return the factors of the waves of a map, along the direction at `angle` [rad] to x."""
        x, y = square.axes
        most = np.pi / square.step * np.sqrt(2.0)
        table = self.at(np.linspace(-most, most, _TABLE)).astype(np.complex64)
        place = (x * np.cos(angle) + y * np.sin(angle)) * ((_TABLE - 1) / (2.0 * most))
        return np.asarray(table[np.rint(place + 0.5 * (_TABLE - 1)).astype(np.int32)])


def scaled(terms: Sequence[Term], lines: Sequence[MeasuredLine]) -> LineFilter:
    """Return the filter whose answers on the measured lines are of rms one."""
    raw = LineFilter(tuple(terms))
    power = sum(
        2.0 * float(np.sum(np.abs(raw.at(line.wavenumber) * line.waves) ** 2)) / line.points
        for line in lines
    )
    return LineFilter(raw.terms, float(np.sqrt(power / sum(line.points for line in lines))))


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
    ) -> tuple[ComplexArray, Array]:
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


# Maps whose lines, in every direction, have the statistics of measured lines.
#
# Every statistic wants a correction c_j of the answers of a filter F_j along one direction
# (`line_statistics`). The waves that come nearest to all of a batch are known wave by wave,
#
#     dz(q) = sum_j conj(F_j(q . d_j)) c_j(q) / sum_j |F_j(q . d_j)|^2,
#
# which is sliced optimal transport (J. Rabin et al., SSVM 2011, doi:10.1007/978-3-642-24785-9_37)
# of line pieces, and texture synthesis by histograms of filters (D. J. Heeger & J. R. Bergen,
# SIGGRAPH 1995, doi:10.1145/218380.218446) with filters along lines. Directions are spread evenly
# over each batch. Coarse squares come first.

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
    return np.asarray(np.where(square.resolved, wanted / (seen + _FLOOR * seen.max()), 0.0))
