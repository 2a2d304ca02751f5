"""Maps whose lines, in every direction, have the statistics of measured lines.

A filter along a line is a sum of bells, their slopes and curvatures,

    F(k) = sum_j w_j (i k s_j)^(n_j) exp(-(k s_j)^2/2 + i k t_j),    n_j = 0, 1, 2,

of widths s_j at distances t_j along the line. On a map, along a direction d, it is F(q . d). The
statistics are distributions of filter answers. Half of the filters are sums of terms (which shapes
occur together); the others are slopes and curvatures by class of the height smoothed about them
(where the roughness lies). Widths are drawn evenly in their logarithm, from the step of the map to
an eighth of its length.

Answers are brought to a distribution by optimal transport, which keeps the order in one dimension:
the value of rank r goes to the measured quantile of rank r (C. Villani, Topics in Optimal
Transportation (2003), sec. 2.2). Every statistic asks for a correction c_j of the answers of a
filter F_j along one direction. The waves that come nearest to all corrections of a batch are, wave
by wave,

    dz(q) = sum_j conj(F_j(q . d_j)) c_j(q) / sum_j |F_j(q . d_j)|^2,

which is sliced optimal transport (J. Rabin et al., SSVM 2011, doi:10.1007/978-3-642-24785-9_37)
of line pieces, and texture synthesis by histograms of filters (D. J. Heeger & J. R. Bergen,
SIGGRAPH 1995, doi:10.1145/218380.218446) with filters along lines. Directions are spread evenly
over each batch. Coarse squares come first.
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
from gripscale.surface.low_pass import followed_lines
from gripscale.surface.profile import Profile
from gripscale.surface.resampling import fill_gaps

Waves = NDArray[Any]
"""Complex factors of the waves of a line or map, in single or double precision."""

_TAIL = np.geomspace(2e-5, 4e-3, 12)
RANKS = np.concatenate((_TAIL, np.linspace(5e-3, 1.0 - 5e-3, 500), 1.0 - _TAIL[::-1]))
"""Ranks of the quantiles that represent a distribution."""

CLASS_ENDS = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.94, 0.97, 0.99])
"""Ranks between the classes of height: finer at the top, which touches."""

CLASSES = CLASS_ENDS.size + 1

_NODES = 2**12
"""Nodes from lowest to highest value at which ranks are counted, ten times faster than sorting."""

_NARROWEST = 1e-30

ClassArray = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Distribution:
    """Quantiles at `RANKS`, one row for all values or one for each class of reference values."""

    quantiles: Array

    @staticmethod
    def of(values: Array, reference: Array | None = None) -> Distribution:
        """Return the distribution of values, by class of `reference` values if there are any."""
        groups = [values]
        if reference is not None:
            classes = height_class(reference)
            groups = [values[classes == number] for number in range(CLASSES)]
        quantiles = []
        for group in groups:
            ordered = np.sort(group, axis=None)
            ranks = RANKS * ordered.size - 0.5
            quantiles.append(np.interp(ranks, np.arange(ordered.size), ordered))
        return Distribution(np.stack(quantiles))

    def correction(self, values: Array, reference: Array | None = None) -> Array:
        """Return the addition to values (any shape) that gives them this distribution.

        Exact to the distance of the nodes, 1/4096 of their range.
        """
        nodes, nearest = _counted(values)
        if reference is not None:
            nearest = nearest + np.int32(_NODES) * height_class(reference).astype(np.int32)
        counts = np.bincount(nearest.reshape(-1), minlength=self.quantiles.shape[0] * _NODES)
        ranks = _ranks(counts.reshape(-1, _NODES))
        moved = [np.interp(r, RANKS, q) for r, q in zip(ranks, self.quantiles, strict=True)]
        table = (np.stack(moved) - nodes).astype(values.dtype)
        return np.asarray(table.reshape(-1)[nearest])


def height_class(values: Array) -> ClassArray:
    """Return the class of each value by its rank."""
    _, nearest = _counted(values)
    ranks = _ranks(np.bincount(nearest.reshape(-1), minlength=_NODES))
    return np.asarray(np.searchsorted(CLASS_ENDS, ranks).astype(np.uint8)[nearest])


def _counted(values: Array) -> tuple[Array, NDArray[np.int32]]:
    """Return nodes from the lowest to the highest value, and the nearest to each value."""
    low, high = float(values.min()), float(values.max())
    scale = (_NODES - 1) / max(high - low, _NARROWEST)
    nearest = (values - low) * scale + 0.5
    return np.linspace(low, high, _NODES), np.asarray(nearest.astype(np.int32))


def _ranks(counts: NDArray[np.int64]) -> Array:
    """Return the rank of the middle of each node's values, along the last axis."""
    total = np.maximum(counts.sum(axis=-1, keepdims=True), 1)
    return np.asarray((np.cumsum(counts, axis=-1) - 0.5 * counts) / total)


@dataclass(frozen=True)
class Square:
    """One period of an isotropic map, with equal steps each way, and its waves."""

    points: int
    """Each way, an even number."""
    length: float
    """Period each way [m]."""

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
        """Waves of a map: those above the mean, below the highest in every direction."""
        q = self.wavenumber
        return np.asarray((q > 0.0) & (q < np.pi / self.step * (1.0 - 1e-9)))

    def heights(self, spectrum: Waves) -> Array:
        """Return the heights [m] of a half spectrum."""
        from scipy.fft import irfft2

        return np.asarray(irfft2(spectrum, s=(self.points, self.points)))

    def spectrum(self, heights: Array) -> Waves:
        """Return the half spectrum of heights [m]."""
        from scipy.fft import rfft2

        return np.asarray(rfft2(heights))

    def noise(self, random: np.random.Generator) -> Array:
        """Return white noise of unit variance."""
        return random.standard_normal((self.points, self.points))

    def onto(self, spectrum: Waves, other: Square) -> Waves:
        """Return the half spectrum on another square of the same length, with the waves of both."""
        half = min(self.points, other.points) // 2
        out = np.zeros((other.points, other.points // 2 + 1), dtype=spectrum.dtype)
        out[:half, :half] = spectrum[:half, :half]
        out[1 - half :, :half] = spectrum[1 - half :, :half]
        scale = (other.points / self.points) ** 2
        return np.asarray(np.where(other.resolved, scale * out, 0.0))


LONGEST = 2.0
"""Longest wave kept of a profile, over the period of the map, in whose first wave it appears."""

FEWEST_PERIODS = 4
"""Least length of all profiles together, in periods of the map."""


@dataclass(frozen=True, eq=False)
class MeasuredLine:
    """The waves of one profile (`rfft`), their wavenumbers [rad/m] and its number of points."""

    waves: Waves
    wavenumber: Array
    points: int

    @property
    def heights(self) -> Array:
        """Heights [m]."""
        return np.asarray(np.fft.irfft(self.waves, self.points))


def periodic_lines(profiles: Sequence[Profile], length: float) -> list[MeasuredLine]:
    """Return profiles as one period each, without waves longer than a map of period `length` [m].

    Steep flanks and gaps are filled and ends joined as in the direct contact. Raises `InputError`
    if they are too short for the map.
    """
    total = sum(profile.length for profile in profiles)
    if total < FEWEST_PERIODS * length:
        raise InputError(
            f"profiles must be {FEWEST_PERIODS} times as long as a map together, "
            f"{FEWEST_PERIODS * length:.4g} m; got {total:.4g} m"
        )
    lines = []
    for profile in followed_lines(profiles):
        z = fill_gaps(profile.z)
        z = z - np.linspace(z[0], z[-1], z.size)
        waves = np.fft.rfft(z)
        q = np.asarray(2.0 * np.pi * np.fft.rfftfreq(z.size, profile.step), dtype=np.float64)
        waves[q < 2.0 * np.pi / (LONGEST * length)] = 0.0
        lines.append(MeasuredLine(waves, q, z.size))
    return lines


BELL, SLOPE, CURVATURE = 0, 1, 2

_TABLE = 2**14
"""Entries of the table of a filter from which its factors on a map are taken."""


@dataclass(frozen=True)
class Term:
    """One bell or derivative: its order, width [m], distance along the line [m] and weight."""

    order: int
    width: float
    distance: float = 0.0
    weight: float = 1.0

    def at(self, k: Array) -> Waves:
        """Return the factor of waves of wavenumber `k` along the line [rad/m]."""
        ks = k * self.width
        bell = self.weight * np.exp(-0.5 * ks**2 + 1j * k * self.distance)
        return np.asarray((1j * ks) ** self.order * bell)


@dataclass(frozen=True)
class BellFilter:
    """A sum of terms over a scale: the rms of its answers on the measured lines, once `scaled`."""

    terms: tuple[Term, ...]
    scale: float = 1.0

    def at(self, k: Array) -> Waves:
        """Return the factor of waves of wavenumber `k` along the line [rad/m]."""
        return np.asarray(sum(term.at(k) for term in self.terms) / self.scale)

    def on_lines(self, lines: Sequence[MeasuredLine]) -> Array:
        """Return the answers on measured lines, in both directions: a road has no forward."""
        answers = []
        for line in lines:
            forward = self.at(line.wavenumber)
            for factor in (forward, np.conj(forward)):
                answers.append(np.fft.irfft(factor * line.waves, line.points))
        return np.concatenate(answers)

    def along(self, square: Square, angle: float) -> Waves:
        """Return the factors of the waves of a map, along the direction at `angle` [rad] to x."""
        x, y = square.axes
        most = np.pi / square.step * np.sqrt(2.0)
        table = self.at(np.linspace(-most, most, _TABLE)).astype(np.complex64)
        entry = (x * np.cos(angle) + y * np.sin(angle)) * ((_TABLE - 1) / (2.0 * most))
        return np.asarray(table[np.rint(entry + 0.5 * (_TABLE - 1)).astype(np.int32)])


def scaled(terms: Sequence[Term], lines: Sequence[MeasuredLine]) -> BellFilter:
    """Return the filter whose answers on the measured lines have an rms of one."""
    raw = BellFilter(tuple(terms))
    power = sum(
        2.0 * float(np.sum(np.abs(raw.at(line.wavenumber) * line.waves) ** 2)) / line.points
        for line in lines
    )
    return BellFilter(raw.terms, float(np.sqrt(power / sum(line.points for line in lines))))


SMALLEST_WIDTH = 0.8
"""Smallest width of a filter, over the step of the map."""

LARGEST_WIDTH = 0.125
"""Largest width of a filter, over the length of the map."""


@dataclass(frozen=True, eq=False)
class LineStatistic:
    """The distribution of a filter's answers on measured lines, of all or by class of another's."""

    filter: BellFilter
    reference: BellFilter | None
    measured: Distribution

    @staticmethod
    def of(
        lines: Sequence[MeasuredLine], answering: BellFilter, reference: BellFilter | None
    ) -> LineStatistic:
        """Return the statistic of measured lines."""
        classes = None if reference is None else reference.on_lines(lines)
        distribution = Distribution.of(answering.on_lines(lines), classes)
        return LineStatistic(answering, reference, distribution)

    def correction(self, square: Square, waves: Waves, angle: float) -> tuple[Waves, Array]:
        """Return the filter's factors and the correction of its answers along `angle` [rms 1]."""
        factor = self.filter.along(square, angle)
        answers = square.heights(factor * waves)
        classes = None
        if self.reference is not None:
            classes = square.heights(self.reference.along(square, angle) * waves)
        return factor, self.measured.correction(answers, classes)


def line_statistics(
    lines: Sequence[MeasuredLine], square: Square, number: int, random: np.random.Generator
) -> list[LineStatistic]:
    """Return `number` statistics of measured lines, of filters drawn for a map's square."""
    least, largest = SMALLEST_WIDTH * square.step, LARGEST_WIDTH * square.length

    def draw_width(most: float = largest) -> float:
        ends = np.log([least, max(min(most, largest), 2.0 * least)])
        return float(np.exp(random.uniform(*ends)))

    def draw_order() -> int:
        return int(random.choice((SLOPE, CURVATURE)))

    def weighted(term: Term, weight: float) -> Term:
        rms = scaled([term], lines).scale
        return Term(term.order, term.width, term.distance, float(weight / rms))

    statistics = []
    for at in range(number):
        if at % 2 == 0:
            # a slope or curvature by class of a wider bell, mostly at its middle
            bell = draw_width()
            width = draw_width(bell)
            distance = 2.0 * width * random.standard_normal() * (random.random() < 0.4)
            answering = scaled([Term(draw_order(), width, distance)], lines)
            reference = BellFilter((Term(BELL, bell),))
            statistics.append(LineStatistic.of(lines, answering, reference))
            continue
        if random.random() < 0.6:
            # a bell with a slope or curvature, either of which may be nearly alone
            width = draw_width()
            middle = Term(BELL, draw_width())
            other = Term(draw_order(), width, 1.4 * width * random.standard_normal())
            weight = random.choice((-1, 1)) * np.exp(1.5 * random.standard_normal())
            terms = [weighted(middle, 1.0), weighted(other, weight)]
        else:
            # one to three slopes and curvatures side by side
            widths = [draw_width() for _ in range(int(random.integers(1, 4)))]
            terms = []
            for index, width in enumerate(widths):
                order = draw_order()
                distance = 2.0 * max(widths) * random.standard_normal() * (index > 0)
                weight = random.choice((-1, 1)) * np.exp(0.5 * random.standard_normal())
                terms.append(weighted(Term(order, width, distance), weight))
        statistics.append(LineStatistic.of(lines, scaled(terms, lines), None))
    return statistics


BATCH = 16
"""Number of statistics corrected together."""

STAGES = ((8, 250), (4, 250), (2, 120), (1, 60))
"""Steps of each square over those of the map, and batches on it."""

STATISTICS = 192
"""Number of statistics drawn for each square."""

SHARES = (1.5, 0.5)
"""Shares of the correction that are applied: more than all for fewer batches, less at the end,
because chance corrections of a batch are roughness."""

LAST = 0.3
"""Share of the batches on a square that counts as the end."""

_FLOOR = 1e-3
"""Least sum of |F|^2, over its largest: waves that a batch hardly sees hardly move."""


@dataclass(frozen=True, eq=False)
class LineMatching:
    """The statistics of measured lines on every square, from which maps are drawn."""

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
        waves: Waves,
        random: np.random.Generator,
        on_share: Callable[[float], None] | None = None,
    ) -> Waves:
        """Return the half spectrum of a map, started from that of another.

        `on_share` gets the share that is done: all batches, and the way back to heights.
        """
        before, done = self.square, 0
        for square, batches, statistics in self.stages:
            waves = before.onto(waves, square).astype(np.complex64)
            for number in range(batches):
                batch = random.choice(len(statistics), BATCH, replace=False)
                share = SHARES[number >= (1.0 - LAST) * batches]
                pull = np.zeros(waves.shape, dtype=np.complex64)
                seen = np.zeros(waves.shape, dtype=np.float32)
                for at, index in enumerate(batch):
                    angle = np.pi * (at + random.random()) / BATCH
                    factor, correction = statistics[index].correction(square, waves, angle)
                    pull += np.conj(factor) * square.spectrum(correction)
                    seen += np.abs(factor) ** 2
                change = np.where(square.resolved, pull / (seen + _FLOOR * seen.max()), 0.0)
                waves = waves + share * change
                done += 1
                if on_share is not None:
                    on_share(done / (self.batches + 1))
            before = square
        return waves
