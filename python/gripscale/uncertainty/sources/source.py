"""What every source of uncertainty looks like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from gripscale.errors import InputError
from gripscale.uncertainty.inputs import Inputs


class Coordinate(NamedTuple):
    """A number that says what a source drew: its unit and meaning.

    A factor is told by its logarithm, and is `logarithm` then; any other number is above zero and
    its logarithm is taken where the effect of a source is estimated.
    """

    unit: str
    long_name: str
    logarithm: bool = False


class Source(Protocol):
    """Something that is not known, and draws of it.

    Whatever it draws is a function of `place` and `random` alone, so that the sources are
    independent of each other; and of the inputs it changes what is its own.
    """

    name: ClassVar[str]
    label: ClassVar[str]
    """In words, for tables and figures."""
    models: ClassVar[tuple[str, ...]]
    """Names of the models it has an effect on."""
    coordinates: ClassVar[Mapping[str, Coordinate]]

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with one draw, and the coordinates of the draw.

        `place`, above 0 and below 1, is spread evenly over all samples; `random` is this sample's
        own.
        """


@dataclass(frozen=True)
class Stated:
    """What the user says: the values of one source, the length of a block, what predicts."""

    values: Any = None
    block_length: float | None = None
    models: Sequence[str] = ()


class NotHere(InputError):
    """A source has nothing to draw in a case; the message says why."""
