"""The height difference correlation of measured profiles.

    C_z(l) = < (z(x + l) - z(x))^2 >                                        [LW eq. 5]

averaged over all pairs of points a lag l apart in which both heights are valid. Rubber touches the
upper part of a surface only; where that differs from the valleys, C_z of the upper part alone is
nearer to what the rubber meets (`upper_share`).
[LW] Lind & Wangenheim, ASME IMECE2014-37998.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.surface.profile import FloatArray, Profile, of_one_step

BAND_LEVEL = 0.95
"""Nominal confidence level of the band."""

WIDEST_BAND = 20.0
"""Half width in log C_z beyond which there is no band: too few blocks hold pairs."""

FEWEST_PAIRS = 16
"""Pairs a lag must have to be kept."""


@dataclass(frozen=True, eq=False)
class HeightDifference:
    """Mean squared height difference against lag.

    Parameters
    ----------
    lag : array_like, shape (lags,)
        Lag [m], positive, strictly increasing.
    value : array_like, shape (lags,)
        C_z [m^2], not negative.
    pairs : array_like of int, shape (lags,), optional
        Number of pairs averaged; zeros if not known.
    lower, upper : array_like, shape (lags,), optional
        Band of 95 % nominal confidence [m^2]; NaN if not known.
    carried : float, optional
        Shortest wavelength [m] that the measurement behind the curve carries, where it is known.

    Raises
    ------
    InputError
        If the lengths differ, lags do not increase from above zero, or a value is negative.
    """

    lag: FloatArray
    value: FloatArray
    pairs: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    lower: FloatArray = field(default_factory=lambda: np.zeros(0))
    upper: FloatArray = field(default_factory=lambda: np.zeros(0))
    carried: float | None = None

    def __post_init__(self) -> None:
        lag = checks.positive_vector("lag", self.lag, unit="m")
        value = checks.vector("value", self.value, unit="m^2")
        if lag.size == 0 or lag.size != value.size:
            raise InputError(
                f"lag and value must have the same length, at least 1; "
                f"got {lag.size} and {value.size}"
            )
        if (np.diff(lag) <= 0.0).any():
            at = int(np.argmax(np.diff(lag) <= 0.0)) + 1
            raise InputError(f"lag must increase; got {lag[at]:g} m at index {at}")
        if (value < 0.0).any():
            at = int(np.argmax(value < 0.0))
            raise InputError(f"value must not be negative; got {value[at]:g} m^2 at index {at}")
        self._keep("lag", lag)
        self._keep("value", value)
        self._keep("pairs", np.array(self.pairs, dtype=np.int64), unknown=0)
        for name in ("lower", "upper"):
            band = checks.vector(name, getattr(self, name), unit="m^2", missing=True)
            self._keep(name, band, unknown=np.nan)
        if self.carried is not None:
            checks.positive("carried", self.carried, unit="m")

    def _keep(self, name: str, array: NDArray[Any], unknown: float = np.nan) -> None:
        """Store a read-only array, or `unknown` for each lag if it was not given."""
        size = np.size(self.lag)
        if array.size == 0:
            array = np.full(size, unknown, dtype=array.dtype)
        if array.size != size:
            raise InputError(f"{name} must have {size} entries as lag; got {array.size}")
        array.flags.writeable = False
        object.__setattr__(self, name, array)

    def __len__(self) -> int:
        return int(self.lag.size)


def height_difference(
    profile: Profile | Sequence[Profile],
    *,
    upper_share: float = 1.0,
    max_lag: float | None = None,
    lags_per_decade: int = 20,
    band_blocks: int = 16,
) -> HeightDifference:
    """Return the height difference correlation of one profile, or of several pooled.

    Lags are whole multiples of the step, spaced evenly in log l. Each is summed directly over its
    pairs: with a number of lags that grows as log N this costs O(N log N) like a Fourier transform,
    but keeps full relative accuracy at small lags, where C_z is many decades below its plateau
    and a transform's rounding error is not.

    The band is a delete-one-block jackknife of log C_z (Efron & Stein 1981,
    doi:10.1214/aos/1176345462): the profile is cut into `band_blocks` contiguous blocks, pairs go
    to the block of their first point, C_z is found anew without each block, and the spread of
    log C_z times Student's t for 95 % gives the band. Heights of one asperity are not independent,
    but blocks longer than the correlation length are nearly so: the band is to be trusted at lags
    well below the block length (length / `band_blocks`), and is too narrow above it, where
    neighbouring blocks share heights. Of more profiles than blocks, such as the lines of a map, as
    many neighbours as there are to each block go together: lines side by side are not independent.

    Parameters
    ----------
    profile : Profile or sequence of Profile
        Cleaned profiles. Several must have the same step (within 0.1 %); their pairs are pooled.
    upper_share : float, optional
        Share of each profile's heights that counts, from the highest down: 0.5 leaves out pairs
        with a point below the median height.
    max_lag : float, optional
        Largest lag [m]; a quarter of the shortest profile's length by default.
    lags_per_decade : int, optional
        Lags per decade, where the step allows as many.
    band_blocks : int, optional
        Blocks in all for the confidence band.

    Returns
    -------
    HeightDifference
        Lags with at least 16 pairs. The band is NaN where the blocks do not determine it.

    Raises
    ------
    InputError
        If the steps differ, `upper_share` is not above 0 and at most 1, `max_lag` is below one step
        or beyond a profile, or no lag has pairs.
    """
    blocks = checks.whole("band_blocks", band_blocks, least=4, most=1000)
    sums = block_sums(
        profile,
        blocks,
        upper_share=upper_share,
        max_lag=max_lag,
        lags_per_decade=lags_per_decade,
    )
    return replace(_curve(sums.lag, sums.squares, sums.pairs), carried=sums.carried)


@dataclass(frozen=True, eq=False)
class BlockSums:
    """What each block of the profiles adds to C_z: whoever draws blocks needs no pairs again.

    Parameters
    ----------
    lag : array, shape (lags,)
        Lag [m].
    squares, pairs : array, shape (blocks, lags)
        Sum of squared height differences [m^2] and number of pairs whose first point is in a block.
    carried : float
        Shortest wavelength [m] that the measurement carries.
    """

    lag: FloatArray
    squares: FloatArray
    pairs: FloatArray
    carried: float

    def drawn(self, blocks: NDArray[np.intp]) -> HeightDifference:
        """Return C_z of these blocks only, some perhaps several times, without a band."""
        squares, pairs = self.squares[blocks].sum(axis=0), self.pairs[blocks].sum(axis=0)
        kept = (pairs >= FEWEST_PAIRS) & (squares > 0.0)
        return HeightDifference(
            self.lag[kept],
            squares[kept] / pairs[kept],
            pairs[kept].astype(np.int64),
            carried=self.carried,
        )


def block_sums(
    profile: Profile | Sequence[Profile],
    blocks: int,
    *,
    upper_share: float = 1.0,
    max_lag: float | None = None,
    lags_per_decade: int = 20,
) -> BlockSums:
    """Return the sums behind C_z, block by block; arguments and errors as `height_difference`."""
    profiles = of_one_step(profile, "pooled")
    per_decade = checks.whole("lags_per_decade", lags_per_decade, least=1, most=1000)
    step = float(np.mean([p.step for p in profiles]))
    shifts = _lag_steps(profiles, step, max_lag, per_decade)
    share = checks.positive("upper_share", upper_share)
    if share > 1.0:
        raise InputError(f"upper_share must be at most 1; got {share:g}")
    centred = [_upper(p.z - np.nanmean(p.z), share) for p in profiles]
    sums, counts = _block_sums(centred, block_starts([z.size for z in centred], blocks), shifts)
    if len(profiles) > blocks:
        first = np.linspace(0, len(sums), blocks, endpoint=False).astype(int)
        sums, counts = (np.add.reduceat(values, first, axis=0) for values in (sums, counts))
    keep = counts.sum(axis=0) >= FEWEST_PAIRS
    if not keep.any():
        raise InputError(
            f"profile must have a lag with at least {FEWEST_PAIRS} pairs of heights; got at most "
            f"{int(counts.sum(axis=0).max())}"
        )
    carried = max(p.carried for p in profiles)
    return BlockSums(step * shifts[keep], sums[:, keep], counts[:, keep], carried)


def require_positive(hdc: HeightDifference) -> None:
    """Raise `InputError` where the curve is not above zero: its logarithm is fitted."""
    if (hdc.value <= 0.0).any():
        at = int(np.argmin(hdc.value))
        raise InputError(
            "the height difference correlation must be positive at every lag; "
            f"got {hdc.value[at]:g} m^2 at {hdc.lag[at]:g} m"
        )


def _upper(z: FloatArray, share: float) -> FloatArray:
    """Return heights with all but the highest `share` of them missing."""
    return np.where(z >= np.nanquantile(z, 1.0 - share), z, np.nan)


def _lag_steps(
    profiles: list[Profile], step: float, max_lag: float | None, per_decade: int
) -> NDArray[np.int64]:
    """Return the distinct whole numbers nearest to evenly spaced log lags."""
    shortest = min(p.length for p in profiles)
    longest = shortest / 4.0 if max_lag is None else checks.positive("max_lag", max_lag, unit="m")
    most_length = max(p.length for p in profiles)
    if not step <= longest * (1.0 + 1e-9) or longest > most_length:
        raise InputError(
            f"max_lag must be at least one step, {step:g} m, and within the profile, "
            f"{most_length:g} m; got {longest:g} m"
        )
    most = int(np.floor(longest / step + 1e-6))
    count = int(np.ceil(per_decade * np.log10(max(most, 1)))) + 1
    return np.unique(np.rint(np.geomspace(1, most, count)).astype(np.int64))


def block_starts(sizes: list[int], blocks: int) -> list[NDArray[np.int64]]:
    """Cut each profile into its share of the blocks; return their first indices."""
    total = sum(sizes)
    shares = [max(1, round(blocks * size / total)) for size in sizes]
    return [
        np.linspace(0, size, share, endpoint=False).astype(np.int64)
        for size, share in zip(sizes, shares, strict=True)
    ]


def _block_sums(
    heights: list[FloatArray], starts: list[NDArray[np.int64]], shifts: NDArray[np.int64]
) -> tuple[FloatArray, FloatArray]:
    """Return sums of squared differences and numbers of pairs, both (blocks, lags)."""
    shape = (sum(s.size for s in starts), shifts.size)
    sums, counts = np.zeros(shape), np.zeros(shape)
    row = 0
    for z, start in zip(heights, starts, strict=True):
        for column, shift in enumerate(shifts):
            if shift >= z.size:
                continue
            squares = np.square(z[shift:] - z[:-shift])
            valid = np.isfinite(squares)
            begins = start[start < squares.size]
            rows = slice(row, row + begins.size)
            sums[rows, column] = np.add.reduceat(np.where(valid, squares, 0.0), begins)
            counts[rows, column] = np.add.reduceat(valid.astype(float), begins)
        row += start.size
    return sums, counts


def _curve(lag: FloatArray, sums: FloatArray, counts: FloatArray) -> HeightDifference:
    total, pairs = sums.sum(axis=0), counts.sum(axis=0)
    value = total / pairs
    spread = _jackknife_spread(total - sums, pairs - counts, counts > 0)
    return HeightDifference(
        lag, value, pairs.astype(np.int64), value * np.exp(-spread), value * np.exp(spread)
    )


def _jackknife_spread(sums: FloatArray, pairs: FloatArray, used: NDArray[np.bool_]) -> FloatArray:
    """Return the half width of the band in log C_z from the sums without each block."""
    from scipy.stats import t

    usable = used & (pairs > 0) & (sums > 0.0)
    n = usable.sum(axis=0)
    logs = np.log(np.where(usable, sums, 1.0) / np.where(usable, pairs, 1.0))
    mean = logs.sum(axis=0, where=usable) / np.maximum(n, 1)
    scatter = np.square(logs - mean).sum(axis=0, where=usable)
    deviation = np.sqrt((n - 1) / np.maximum(n, 1) * scatter)
    quantile = t.ppf(0.5 + BAND_LEVEL / 2.0, np.maximum(n - 1, 1))
    spread = quantile * deviation
    return np.where((n >= 2) & (spread < WIDEST_BAND), spread, np.nan)


# The plateau of a height difference correlation: where it begins and how high it is.
#
# Beyond the longest wavelength of a surface, heights a lag apart are unrelated and C_z is twice the
# variance. The plateau begins at the first lag at which C_z reaches 90 % of its own mean over all
# larger lags: a curve that still rises stays far below that mean, one that has settled scatters
# about it. A tenth is left for a measured plateau, which is finite and drifts by as much.

REACHED = 0.9
"""Fraction of the mean over all larger lags at which the plateau begins."""

SHORTEST_PLATEAU = 2.0
"""Ratio of the largest lag to the plateau's first lag below which it is not called a plateau."""


@dataclass(frozen=True)
class Plateau:
    """Where C_z stops rising: its first lag [m] and its level [m^2]."""

    lag: float
    level: float


def find_plateau(hdc: HeightDifference) -> Plateau | None:
    """Return the plateau of a height difference correlation, or None if it is not reached.

    The level is the median of C_z over the plateau's lags, weighted evenly in log lag: neither the
    last of the rise nor a drift at the largest lags moves it much.
    """
    weight = log_weights(hdc.lag)
    tail_mean = np.cumsum((weight * hdc.value)[::-1])[::-1] / np.cumsum(weight[::-1])[::-1]
    # The last lag is its own mean, so a curve that rises to its end is caught by the ratio below.
    first = int(np.argmax(hdc.value >= REACHED * tail_mean))
    if hdc.lag[-1] < SHORTEST_PLATEAU * hdc.lag[first]:
        return None
    level = _weighted_median(hdc.value[first:], weight[first:])
    return Plateau(float(hdc.lag[first]), level)


def _weighted_median(values: FloatArray, weight: FloatArray) -> float:
    order = np.argsort(values)
    share = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(share, 0.5 * share[-1])])


def log_weights(lag: FloatArray) -> FloatArray:
    """Return the width in log lag that each lag stands for, so that decades count alike."""
    if lag.size == 1:
        return np.ones(1)
    logs = np.log10(lag)
    edges = np.concatenate((logs[:1], 0.5 * (logs[1:] + logs[:-1]), logs[-1:]))
    return np.diff(edges)
