"""Blocks of the measured profiles: another stretch of the same road might have been measured.

A block bootstrap (H. R. Kunsch, Ann. Stat. 17 (1989) 1217, doi:10.1214/aos/1176347265): of n blocks
n - 1 are drawn with replacement. The sums over pairs of their correlation C_z are added up. For the
direct contact they become new profiles, joined over half the largest wave: docs/derivations.md.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.core import Array, InputError, checks
from gripscale.surface import HeightDifference, Profile
from gripscale.surface.height_difference import BlockSums, block_starts, block_sums

Indices = NDArray[np.intp]

BLOCK_WAVES = 4.0  # length of a block in largest waves
_FEWEST_BLOCKS, WANTED_BLOCKS, MOST_BLOCKS = 4, 8, 1000
JOINT_WAVES = 0.5  # length over which one block goes over into the next, in largest waves


@dataclass(frozen=True, eq=False)
class ProfileBlocks:
    """Profiles cut into blocks, and what is drawn of them.

    Raises `InputError` if there are fewer than four blocks, or they are shorter than the largest
    wave.
    """

    profiles: Sequence[Profile]
    """Cleaned, of one step."""
    largest_wave: float
    """The longest wave that counts [m]."""
    block_length: float | None = None
    """[m]; four of the largest waves by default, less where the profiles then had fewer than eight
    blocks."""
    counted: Mapping[str, Any] = field(default_factory=dict)
    """`top_height_fraction` and `max_lag` of `height_difference`."""

    def __post_init__(self) -> None:
        if len(self) < _FEWEST_BLOCKS or self._wanted < self.largest_wave:
            raise InputError(
                f"the profiles must hold {_FEWEST_BLOCKS} blocks as long as the largest wave, "
                f"{self.largest_wave:.3g} m, to estimate their scatter; got {self._length:.3g} m "
                "in all (leave out the source profile, or state another block_length)"
            )

    @cached_property
    def _length(self) -> float:
        return sum(profile.length for profile in self.profiles)

    @cached_property
    def _wanted(self) -> float:
        """Length a block is to have [m]."""
        if self.block_length is not None:
            return checks.positive("block_length", self.block_length, unit="m")
        return min(BLOCK_WAVES * self.largest_wave, self._length / WANTED_BLOCKS)

    @cached_property
    def _sums(self) -> BlockSums:
        return block_sums(self.profiles, self._number, **self.counted)

    @property
    def _number(self) -> int:
        return min(max(int(self._length / self._wanted), 1), MOST_BLOCKS)

    def __len__(self) -> int:
        cuts = len(self._places)
        return min(cuts, self._number) if len(self.profiles) > self._number else cuts

    def draw(self, random: np.random.Generator) -> Indices:
        """Return which blocks are drawn, one fewer than there are."""
        return random.integers(len(self), size=len(self) - 1)

    def correlation(self, drawn: Indices) -> HeightDifference:
        """Return C_z of the drawn blocks."""
        return self._sums.drawn(drawn)

    def log_ratios(self, drawn: Indices) -> Array:
        """Return ln of C_z over the measured one, at short, middle and long lags.

        Means over thirds, in log lag, of the lags up to the largest wave.
        """
        whole, part = self._sums.drawn(np.arange(len(self))), self.correlation(drawn)
        lags = np.geomspace(whole.lag[0], max(self.largest_wave, 2.0 * whole.lag[0]), 24)
        curves = [np.interp(np.log(lags), np.log(c.lag), np.log(c.value)) for c in (part, whole)]
        return np.asarray((curves[0] - curves[1]).reshape(3, -1).mean(axis=1))

    def lines(self, drawn: Indices) -> tuple[Profile, ...]:
        """Return as many profiles as were measured, of the drawn blocks.

        Raises `InputError` as `require_lines` does.
        """
        self.require_lines()
        parts = np.array_split(drawn, min(len(self.profiles), len(drawn)))
        return tuple(self._line([self._places[block] for block in part]) for part in parts)

    def require_lines(self) -> None:
        """Raise `InputError` for more profiles than blocks, of which no lines can be made."""
        if len(self._places) != len(self):
            raise InputError(
                f"{len(self.profiles)} profiles must hold a block each for the direct contact of "
                f"drawn blocks; got {len(self)} blocks (state a smaller block_length, or leave out "
                "the source profile)"
            )

    @cached_property
    def _places(self) -> list[tuple[int, int, int]]:
        """Profile, first point and end of each block."""
        sizes = [len(profile) for profile in self.profiles]
        return [
            (number, int(first), int(end))
            for number, starts in enumerate(block_starts(sizes, self._number))
            for first, end in pairwise([*starts, sizes[number]])
        ]

    def _line(self, places: list[tuple[int, int, int]]) -> Profile:
        """Return the blocks one after the other, each going over into the next."""
        step = self.profiles[0].step
        joint = max(int(JOINT_WAVES * self.largest_wave / step), 1)
        angle = 0.5 * np.pi * (np.arange(joint) + 0.5) / joint
        pieces = []
        for number, first, end in places:
            profile = self.profiles[number]
            # with the joint behind the block, or before it at an end
            begin = max(min(first, len(profile) - joint - (end - first)), 0)
            pieces.append(profile.z[begin : begin + end - first + joint] - np.nanmean(profile.z))
        line = [pieces[0][:-joint]]
        for before, after in pairwise(pieces):
            met = np.cos(angle) * before[-joint:] + np.sin(angle) * after[:joint]
            line += [met, after[joint:-joint]]
        z = np.asarray(np.concatenate([*line, pieces[-1][-joint:]]), dtype=np.float64)
        return Profile(step * np.arange(z.size, dtype=np.float64), z, f"{len(places)} blocks")
