"""Filters along a line, and what they answer on measured lines and on maps.

A filter is a sum of bells, their slopes and curvatures,

    F(k) = sum_j w_j (i k s_j)^(n_j) exp(-(k s_j)^2/2 + i k t_j),    n_j = 0, 1, 2,

of widths s_j at distances t_j along the line. On a map, along a direction d, it is F(q . d).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.surface.maps.measured import MeasuredLine
from gripscale.surface.maps.square import ComplexArray, Square
from gripscale.surface.profile import FloatArray

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

    def at(self, k: FloatArray) -> ComplexArray:
        """Return the factor of waves of wavenumber `k` along the line [rad/m]."""
        ks = k * self.width
        bell = self.weight * np.exp(-0.5 * ks**2 + 1j * k * self.distance)
        return np.asarray((1j * ks) ** self.order * bell)


@dataclass(frozen=True)
class LineFilter:
    """A sum of terms over a scale: that of its answers on the measured lines, once `scaled`."""

    terms: tuple[Term, ...]
    scale: float = 1.0

    def at(self, k: FloatArray) -> ComplexArray:
        """Return the factor of waves of wavenumber `k` along the line [rad/m]."""
        return np.asarray(sum(term.at(k) for term in self.terms) / self.scale)

    def on_lines(self, lines: Sequence[MeasuredLine]) -> FloatArray:
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
