"""[load] of a case: how hard, how fast and over what length.

Lengths in m, pressures in Pa, speeds in m/s and times in s once read.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import BeforeValidator

from gripscale.case.expected import Words
from gripscale.case.quantity import Length, Pressure, Speed
from gripscale.case.table import Table
from gripscale.model import NominalLoad
from gripscale.units import parse_quantity

LOAD_TIME = '"passage", "infinite" or a time such as "1 s"'


def _load_time(value: Any) -> float | str:
    """Accept "passage", "infinite" or a time."""
    if value == "passage":
        return "passage"
    if value in ("infinite", math.inf):
        return math.inf
    try:
        seconds = parse_quantity(value, "time")
    except ValueError as error:
        raise ValueError(f'{error}, or "passage", or "infinite"') from error
    if seconds <= 0.0:
        raise ValueError("expected a time greater than zero")
    return seconds


class Load(Table):
    """How hard, how fast and over what length the rubber is pressed and slid."""

    pressure: Pressure
    """Nominal pressure."""
    speed: Speed
    """Sliding speed; 0 is the relaxed rubber at rest."""
    footprint: Length
    """Length of the nominal contact: how long the largest wave is loaded."""
    static: bool = False
    """The relaxed rubber at rest, too."""
    load_time: Annotated[Any, BeforeValidator(_load_time), Words(LOAD_TIME)] = "passage"
    """How long a wave is loaded: while the contact above it passes, for ever, or a time."""

    @property
    def nominal(self) -> NominalLoad:
        """The load on the whole surface, at the speed stated."""
        return NominalLoad(self.pressure, self.speed, self.footprint, self.load_time)
