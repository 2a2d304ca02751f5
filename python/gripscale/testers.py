"""Testers of skid resistance: the load and speed of their sliders and wheels, and their numbers.

What stands here is from public descriptions; of tyres the pressure is that of the air, and the
length of the patch the load over pressure and width of the tread. A pendulum reads the friction as

    PTV = 330 mu / (3 + mu),        mu = 3 PTV / (330 - PTV)

(C. G. Giles, B. E. Sabey & K. H. F. Cardew, Road Research Technical Paper 66 (1964)).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from gripscale.core import Finding, InputError, Severity, Topic, checks

KMH = 1.0 / 3.6  # A kilometre an hour [m/s]


@dataclass(frozen=True)
class Tester:
    """The load of a tester of skid resistance, and the number that it reads."""

    title: str
    slider: str  # what slides
    pressure: float  # [Pa]
    speed: float  # [m/s]
    footprint: float  # length over which the rubber is loaded [m]
    number: str = ""  # what it calls its number; empty where that is the friction


TesterName = Literal["pendulum", "dynamic_friction_tester", "reference_tyre", "locked_wheel"]
# Testers by the words of a case.
TESTERS: dict[str, Tester] = {
    # EN 13036-4: 22.2 N on an edge 76 mm wide and 2.4 mm long, over 126 mm
    "pendulum": Tester("pendulum, EN 13036-4", "slider 57 or 96", 1.2e5, 2.8, 0.126, "PTV"),
    # ASTM E1911: three sliders of 11.8 N and 150 kPa on a disc of 284 mm; its number at 20 km/h
    "dynamic_friction_tester": Tester(
        "dynamic friction tester, ASTM E1911", "slider", 1.5e5, 20.0 * KMH, 0.892, "DFT20"
    ),
    # ASTM F2493 and UN Regulation 117: 5.4 kN, 180 kPa, 170 mm, 65 km/h; 15 % slip at the peak
    "reference_tyre": Tester(
        "reference tyre, ASTM F2493", "tread", 1.8e5, 0.15 * 65.0 * KMH, 0.175
    ),
    # ASTM E274 and E501: 4.8 kN, 165 kPa, 149 mm, locked at 64 km/h
    "locked_wheel": Tester("locked-wheel trailer, ASTM E274", "tread", 1.65e5, 64.0 * KMH, 0.196),
}
TESTER = "tester"  # attribute of a result: the tester whose load it is for


def pendulum_value(friction: float) -> float:
    """Return the pendulum test value PTV of a friction [-]."""
    return 330.0 * friction / (3.0 + friction)


def friction_of_pendulum(value: float) -> float:
    """Return the friction [-] of a pendulum test value; `InputError` unless 0 <= PTV < 330."""
    if not 0.0 <= checks.number("PTV", value) < 330.0:
        raise InputError(f"PTV must be from 0 to below 330; got {value:g}")
    return 3.0 * value / (330.0 - value)


def tester_reading(name: str, friction: float, low: float, high: float) -> str:
    """Return what a tester reads at a friction with its interval; empty for other loads."""
    tester = TESTERS.get(name)
    if tester is None:
        return ""
    values = friction, low, high
    texts = [f"{x:.3g}" for x in values]
    if tester.number == "PTV":
        texts = [f"{pendulum_value(x):.0f}" for x in values]
    ends = f" ({texts[1]} to {texts[2]})" if math.isfinite(low) else ""
    return f"{tester.title}: {tester.number or 'μ'} {texts[0]}{ends}"


def tester_findings(name: str, rubber: str) -> Iterator[Finding]:
    """Yield what an answer under the load of a tester does not have of it."""
    if name in TESTERS:
        tester = TESTERS[name]
        text = (
            f"The rubber of the case, {rubber or 'without a name'}, stands in for that of the "
            f"{tester.slider} of the {tester.title}, which is not part of this package; the test "
            "is wet, the contact here has no water."
        )
        yield Finding(Severity.WARNING, text, topic=Topic.RUBBER)
