"""The height difference correlation of measured profiles, its plateau and its power law.

    C_z(l) = < (z(x + l) - z(x))^2 >                                        [LW eq. 5]
    C_z(l) = xi_perp^2 (l / xi_par)^(2 H)  below xi_par, xi_perp^2 above     [LW eq. 6]

averaged over all pairs of points a lag l apart in which both heights are valid. The plateau begins
at the first lag at which C_z reaches 90 % of its own mean over all larger lags: a curve that still
rises stays far below that mean, and a measured plateau drifts by as much as a tenth.

[LW] Lind & Wangenheim, ASME IMECE2014-37998, eq. 6 after Klueppel & Heinrich, Rubber Chem. Technol.
73 (2000) 578.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

import gripscale
from gripscale.core import Array, Checked, InputError, Quantity, checked, checks
from gripscale.surface.low_pass import STEEPEST, followed_lines
from gripscale.surface.profile import HeightMap, Profile, of_one_step

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_LAGS_PER_DECADE = 20  # where the step allows as many
_BAND_BLOCKS = 16  # of all profiles, for the band
_BAND_LEVEL = 0.95  # nominal confidence level of the band
# Half width in log C_z beyond which there is no band: too few blocks hold pairs.
_WIDEST_BAND = 20.0
_FEWEST_PAIRS = 16  # pairs a lag must have to be kept
_HEIGHTS_AT_ONCE = 2**17  # of lines that are summed together, for a cache of a megabyte


class HeightDifference(Checked, eq=False):
    """Mean squared height difference against lag.

    Arrays have the shape (lags,). Raises `InputError` if their lengths differ, lags do not increase
    from above zero, or a value is negative.
    """

    lag: Array = checked(checks.increasing_vector, unit="m")
    """Lag [m], positive, strictly increasing."""
    value: Array = checked(checks.not_negative_vector, unit="m^2")
    """C_z [m^2], not negative."""
    pairs: NDArray[np.int64] = checked(lambda _, value: np.array(value, np.int64), default=None)
    """Number of pairs averaged; zeros if not known."""
    lower: Array = checked(checks.vector, unit="m^2", missing=True, default=None)
    upper: Array = checked(checks.vector, unit="m^2", missing=True, default=None)
    """Band of 95 % nominal confidence [m^2]; NaN if not known."""
    resolution_limit: float | None = checked(checks.positive, unit="m", default=None)
    """Shortest wavelength [m] that the measurement behind the curve resolves, if known."""

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.same_length(1, lag=self.lag, value=self.value)
        size = self.lag.size
        for name, unknown in (("pairs", 0), ("lower", np.nan), ("upper", np.nan)):
            values = getattr(self, name)
            if values is None:
                self._set(**{name: np.full(size, unknown)})
            elif values.size != size:
                raise InputError(f"{name} must have {size} entries as lag; got {values.size}")

    def plot(
        self,
        sines: Mapping[str, gripscale.SineStack] | None = None,
        self_affine: gripscale.SelfAffineFit | None = None,
    ) -> Figure:
        """Draw the curve with its band, with fitted waves by name and the self-affine fit."""
        return gripscale.questions.correlation_figure(self, sines or {}, self_affine)

    def __len__(self) -> int:
        return int(self.lag.size)


def height_difference(
    profile: Profile | Sequence[Profile] | HeightMap,
    *,
    top_height_fraction: float = 1.0,
    max_lag: Quantity | None = None,
    steepest: float = STEEPEST,
) -> HeightDifference:
    """Return the height difference correlation of one profile, or of several pooled.

    Lags are whole multiples of the step, spaced evenly in log l. Each is summed directly over its
    pairs: with a number of lags that grows as log N this costs O(N log N) like a Fourier transform,
    but keeps full relative accuracy at small lags, where C_z is many decades below its plateau
    and a transform's rounding error is not.

    The band is a delete-one-block jackknife of log C_z over 16 blocks: to be trusted at lags well
    below the block length (length / 16), too narrow above it (docs/derivations.md).

    Lags have at least 16 pairs. The band is NaN where the blocks do not determine it. Raises
    `InputError` if the steps differ, `top_height_fraction` is not above 0 and at most 1, `max_lag`
    is below one step or beyond a profile, or no lag has pairs.

        >>> gs.height_difference([road, other_road], max_lag="10 mm").lag[-1].item()
        0.01

    Parameters
    ----------
    profile : Profile, sequence of Profile or HeightMap
        Cleaned profiles, or a map for its lines along x. Several must have the same step (within
        0.1 %); their pairs are pooled.
    top_height_fraction : float, optional
        Share of each profile's heights that counts, from the highest down: 0.5 leaves out pairs
        with a point below the median height.
    max_lag : float, optional
        Largest lag [m]; a quarter of the shortest profile's length by default.
    steepest : float, optional
        Flanks above this slope [-] are filled first, since rubber does not follow them; infinity
        keeps them.
    """
    sums = block_sums(
        profile,
        _BAND_BLOCKS,
        top_height_fraction=top_height_fraction,
        max_lag=max_lag,
        steepest=steepest,
    )
    from scipy.special import stdtrit  # of scipy.stats, which takes half a second to import

    total, pairs = sums.squares.sum(axis=0), sums.pairs.sum(axis=0)
    squares, others = total - sums.squares, pairs - sums.pairs  # without each block
    usable = (sums.pairs > 0) & (others > 0) & (squares > 0.0)
    n = usable.sum(axis=0)
    logs = np.log(np.where(usable, squares, 1.0) / np.where(usable, others, 1.0))
    mean = logs.sum(axis=0, where=usable) / np.maximum(n, 1)
    scatter = np.square(logs - mean).sum(axis=0, where=usable)
    deviation = np.sqrt((n - 1) / np.maximum(n, 1) * scatter)
    # half width of the band in log C_z
    spread = stdtrit(np.maximum(n - 1, 1), 0.5 + _BAND_LEVEL / 2.0) * deviation
    spread = np.where((n >= 2) & (spread < _WIDEST_BAND), spread, np.nan)
    value = total / pairs
    band = value * np.exp(-spread), value * np.exp(spread)
    return HeightDifference(sums.lag, value, pairs.astype(np.int64), *band, sums.resolution_limit)


@dataclass(frozen=True, eq=False)
class BlockSums:
    """Contribution of each block of the profiles to C_z, for resampling of blocks."""

    lag: Array  # [m], shape (lags,)
    squares: Array  # sums of squared height differences [m^2], shape (blocks, lags)
    pairs: Array  # numbers of pairs whose first point is in a block, shape (blocks, lags)
    resolution_limit: float  # shortest wavelength that the measurement resolves [m]

    def drawn(self, blocks: NDArray[np.intp]) -> HeightDifference:
        """Return C_z of a selection of blocks, with repetitions, without a band."""
        squares, pairs = self.squares[blocks].sum(axis=0), self.pairs[blocks].sum(axis=0)
        kept = (pairs >= _FEWEST_PAIRS) & (squares > 0.0)
        lag, value, count = self.lag[kept], squares[kept] / pairs[kept], pairs[kept]
        limit = self.resolution_limit
        return HeightDifference(lag, value, count.astype(np.int64), resolution_limit=limit)


def block_sums(
    profile: Profile | Sequence[Profile] | HeightMap,
    blocks: int,
    *,
    top_height_fraction: float = 1.0,
    max_lag: float | None = None,
    steepest: float = STEEPEST,
) -> BlockSums:
    """Return the sums behind C_z, block by block; arguments and errors as `height_difference`."""
    profiles = of_one_step(followed_lines(profile, steepest), "pooled")
    step = float(np.mean([p.step for p in profiles]))
    shortest = min(p.length for p in profiles)
    limit = shortest / 4.0 if max_lag is None else checks.positive("max_lag", max_lag, unit="m")
    longest = max(p.length for p in profiles)
    if not step <= limit * (1.0 + 1e-9) or limit > longest:
        raise InputError(
            f"max_lag must be at least one step, {step:g} m, and within the profile, "
            f"{longest:g} m; got {limit:g} m"
        )
    share = checks.fraction("top_height_fraction", top_height_fraction)
    # the distinct whole numbers of steps nearest to evenly spaced log lags
    most = int(np.floor(limit / step + 1e-6))
    count = int(np.ceil(_LAGS_PER_DECADE * np.log10(max(most, 1)))) + 1
    shifts = np.unique(np.rint(np.geomspace(1, most, count)).astype(np.int64))
    heights = [p.z - np.nanmean(p.z) for p in profiles]
    if share < 1.0:
        heights = [np.where(z >= np.nanquantile(z, 1.0 - share), z, np.nan) for z in heights]
    starts = block_starts([z.size for z in heights], blocks)
    rows = sum(start.size for start in starts)
    sums, counts = np.zeros((rows, shifts.size)), np.zeros((rows, shifts.size))
    row = at = 0
    while at < len(heights):  # lines of one length together: their blocks begin alike
        start, size = starts[at], heights[at].size
        alike = heights[at : at + max(1, _HEIGHTS_AT_ONCE // size)]
        z = np.array([line for line in alike if line.size == size])
        if len(z) < len(alike):  # of several lengths
            z = z[:1]
        part = slice(row, row + len(z) * start.size)
        for column, shift in enumerate(shifts[shifts < size]):
            squares = z[:, shift:] - z[:, :-shift]
            np.square(squares, out=squares)
            valid = np.isfinite(squares)
            squares[~valid] = 0.0
            begins = start[start < squares.shape[1]]
            for all_blocks, values in ((sums, squares), (counts, valid)):
                of_lines = all_blocks[part, column].reshape(len(z), start.size)
                of_lines[:, : begins.size] = np.add.reduceat(values, begins, axis=1, dtype=float)
                all_blocks[part, column] = of_lines.ravel()
        row, at = part.stop, at + len(z)
    if len(profiles) > blocks:
        first = np.linspace(0, len(sums), blocks, endpoint=False).astype(int)
        sums, counts = (np.add.reduceat(values, first, axis=0) for values in (sums, counts))
    keep = counts.sum(axis=0) >= _FEWEST_PAIRS
    if not keep.any():
        raise InputError(
            f"profile must have a lag with at least {_FEWEST_PAIRS} pairs of heights; got at most "
            f"{int(counts.sum(axis=0).max())}"
        )
    resolution_limit = max(p.resolution_limit for p in profiles)
    return BlockSums(step * shifts[keep], sums[:, keep], counts[:, keep], resolution_limit)


def block_starts(sizes: list[int], blocks: int) -> list[NDArray[np.int64]]:
    """Cut each profile into its share of the blocks; return their first indices."""
    total = sum(sizes)
    shares = [max(1, round(blocks * size / total)) for size in sizes]
    return [
        np.linspace(0, size, share, endpoint=False).astype(np.int64)
        for size, share in zip(sizes, shares, strict=True)
    ]


def require_positive(hdc: HeightDifference) -> None:
    """Raise `InputError` where the curve is not above zero: its logarithm is fitted."""
    if not (hdc.value > 0.0).any():
        raise InputError("the heights must differ, a plane has no roughness; got the same ones")
    if (hdc.value <= 0.0).any():
        at = int(np.argmin(hdc.value))
        raise InputError(
            "the height difference correlation must be positive at every lag; "
            f"got {hdc.value[at]:g} m^2 at {hdc.lag[at]:g} m"
        )


_REACHED = 0.9  # fraction of the mean over all larger lags at which the plateau begins
# Ratio of the largest lag to the plateau's first lag below which it is not called a plateau.
_SHORTEST_PLATEAU = 2.0


class Plateau(NamedTuple):
    """The plateau of C_z: its first lag [m] and its level [m^2]."""

    lag: float
    level: float


def find_plateau(hdc: HeightDifference) -> Plateau | None:
    """Return the plateau, or None if it is not reached.

    Its level is the median, evenly weighted in log lag: the last of the rise hardly moves it.
    """
    weight = log_weights(hdc.lag)
    tail_mean = np.cumsum((weight * hdc.value)[::-1])[::-1] / np.cumsum(weight[::-1])[::-1]
    # The last lag equals its own mean: the ratio below excludes a curve that rises to its end.
    first = int(np.argmax(hdc.value >= _REACHED * tail_mean))
    if hdc.lag[-1] < _SHORTEST_PLATEAU * hdc.lag[first]:
        return None
    order = np.argsort(hdc.value[first:])
    share = np.cumsum(weight[first:][order])
    level = hdc.value[first:][order][np.searchsorted(share, 0.5 * share[-1])]
    return Plateau(float(hdc.lag[first]), float(level))


def log_weights(lag: Array) -> Array:
    """Return the width in log lag that each lag stands for, so that decades count alike."""
    if lag.size == 1:
        return np.ones(1)
    logs = np.log10(lag)
    edges = np.concatenate((logs[:1], 0.5 * (logs[1:] + logs[:-1]), logs[-1:]))
    return np.diff(edges)


_FEWEST_LAGS = 4  # lags a power law must cover
_SHORTEST_RANGE = 0.5  # and decades
_STRAIGHT = 0.02  # largest rms departure from a power law [decades of C_z]


class SelfAffineFit(Checked):
    """A power law up to a cut-off, and the plateau above it.

    Raises `InputError` if a value is not a number above zero; the residual may be zero.
    """

    hurst: float = checked(checks.positive)
    """Hurst exponent H [-]: half the slope of log C_z over log lag."""
    xi_parallel: float = checked(checks.positive, unit="m")
    """Cut-off lag [m], where the power law meets the plateau."""
    xi_perpendicular: float = checked(checks.positive, unit="m")
    """Root of the plateau [m]: the root mean square height times the root of 2."""
    lag_min: float = checked(checks.positive, unit="m")
    """Smallest lag over which C_z was found to be a power law [m]."""
    lag_max: float = checked(checks.positive, unit="m")
    """Largest lag over which it was [m]."""
    residual: float = checked(checks.not_negative)
    """Root mean square departure from the power law over that range, in decades of C_z."""

    @property
    def fractal_dimension(self) -> float:
        """Fractal dimension of the surface, D = 3 - H [-]."""
        return 3.0 - self.hurst

    def evaluate(self, lag: ArrayLike) -> Array:
        """Return C_z [m^2] at lags [m], same shape, by [LW eq. 6].

        Raises `InputError` unless the lags are above zero.
        """
        lags = checks.positive_vector("lag", lag, unit="m")
        below = np.minimum(lags / self.xi_parallel, 1.0)
        return np.asarray(self.xi_perpendicular**2 * below ** (2.0 * self.hurst))


def fit_self_affine(hdc: HeightDifference) -> SelfAffineFit:
    """Find the power law and the plateau of a height difference correlation.

    The range of the power law is the widest range of lags below the plateau over which a straight
    line in log C_z departs by no more than 0.02 decades rms. If none has half a decade, the
    straightest range of that width is taken, and `residual` exceeds this: the surface is then not
    self-affine. Raises `InputError` if C_z vanishes somewhere, does not reach a plateau or
    does not rise before it.

        >>> f"{gs.fit_self_affine(gs.height_difference(road)).hurst:.2f}"
        '0.74'
    """
    checks.instance("hdc", hdc, HeightDifference)
    require_positive(hdc)
    plateau = find_plateau(hdc)
    if plateau is None:
        raise InputError(
            "the height difference correlation must reach a plateau over a factor of two in lag; "
            f"it still rises at {hdc.lag[-1]:.4g} m, so use a longer profile or a larger max_lag"
        )
    rising = hdc.lag < plateau.lag * (1.0 + 1e-9)
    lag, value = hdc.lag[rising], hdc.value[rising]
    ranges = [
        (i, j)
        for i in range(lag.size)
        for j in range(i + _FEWEST_LAGS, lag.size + 1)
        if np.log10(lag[j - 1] / lag[i]) >= _SHORTEST_RANGE
    ]
    if not ranges:
        raise InputError(
            f"the height difference correlation must have {_FEWEST_LAGS} lags over "
            f"{_SHORTEST_RANGE:g} decades below its plateau; "
            f"got {lag.size} lags up to {lag[-1]:.4g} m"
        )
    residuals = [_line(lag[i:j], value[i:j])[2] for i, j in ranges]
    straight = [r for r, residual in zip(ranges, residuals, strict=True) if residual <= _STRAIGHT]
    first, last = ranges[int(np.argmin(residuals))]
    if straight:
        first, last = max(straight, key=lambda r: float(np.log10(lag[r[1] - 1] / lag[r[0]])))
    slope, at_one_metre, residual = _line(hdc.lag[first:last], hdc.value[first:last])
    if slope <= 0.0:
        raise InputError(
            "the height difference correlation must rise before its plateau; "
            f"got a slope of {slope:.3g}"
        )
    # The power law meets the plateau where at_one_metre + slope log10(l) = log10(level).
    cut_off = 10.0 ** ((np.log10(plateau.level) - at_one_metre) / slope)
    ends, root = (float(hdc.lag[first]), float(hdc.lag[last - 1])), float(np.sqrt(plateau.level))
    return SelfAffineFit(0.5 * slope, float(cut_off), root, *ends, residual)


def _line(lag: Array, value: Array) -> tuple[float, float, float]:
    """Return slope, log10 value at 1 m and rms departure of a line in log-log, decades alike."""
    x, y, weight = np.log10(lag), np.log10(value), log_weights(lag)
    weight = weight / weight.sum()
    dx, dy = x - weight @ x, y - weight @ y
    slope = float((weight * dx) @ dy / ((weight * dx) @ dx))
    residual = float(np.sqrt(weight @ np.square(dy - slope * dx)))
    return slope, float(weight @ y - slope * (weight @ x)), residual
