"""A number that is not known: anywhere between two ends, one of a few, or one.

Between two ends it is spread evenly in its logarithm, as befits a factor that may be too large or
too small by as much: its reciprocal is then spread evenly, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from gripscale import checks
from gripscale.errors import InputError


@dataclass(frozen=True)
class Range:
    """Values a number may have.

    Parameters
    ----------
    values : tuple of float
        Above zero, rising.
    between : bool
        Whether the two values are ends, with anything between them; otherwise each of the values
        is as likely as the others.

    Raises
    ------
    InputError
        If there are no values, one is not above zero, they do not rise, or there are other than
        two ends.
    """

    values: tuple[float, ...]
    between: bool = True

    def __post_init__(self) -> None:
        found = tuple(checks.positive("each value of a range", value) for value in self.values)
        if not found or any(b <= a for a, b in pairwise(found)):
            raise InputError(f"a range must be rising values; got {checks.shown(self.values)}")
        if self.between and len(found) != 2:
            raise InputError(f"a range must have two ends; got {checks.shown(self.values)}")
        object.__setattr__(self, "values", found)

    @classmethod
    def about(cls, value: float, factor: float) -> Range:
        """Return the range from `value` / `factor` to `value` x `factor`."""
        return cls((value / factor, value * factor))

    @classmethod
    def read(cls, name: str, given: Any, quantity: Callable[[Any], float]) -> Range:
        """Return the range of a text such as `1 GPa:3 GPa` or `1 GPa,2 GPa`, a number or several.

        Two numbers in a tuple or a list are ends. `quantity` turns an entry into SI units and
        raises `InputError` for one that cannot be used.
        """
        if isinstance(given, Range):
            return given
        between = True
        if isinstance(given, str) and ":" in given:
            entries: list[Any] = given.split(":")
        elif isinstance(given, str):
            entries, between = given.split(","), False
        elif isinstance(given, Iterable):
            entries = list(given)
            between = len(entries) == 2
        else:
            entries, between = [given], False
        try:
            return cls(tuple(quantity(entry) for entry in entries), between)
        except InputError as error:
            raise InputError(f"{name}: {error}") from error

    def at(self, place: float) -> float:
        """Return the value below which a share `place` [0 to 1] of all lie."""
        if not self.between:
            return self.values[min(int(place * len(self.values)), len(self.values) - 1)]
        low, high = np.log(self.values)
        return float(np.exp(low + place * (high - low)))
