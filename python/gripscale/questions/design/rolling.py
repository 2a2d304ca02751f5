"""Rolling resistance of a compound: what a tyre loses at the frequencies and temperatures it meets.

A tyre is cooler before it has rolled for an hour, and each turn has harmonics. A compound made for
one frequency and temperature pays at their neighbours: held at 10 Hz and 60 C alone, the loss
factor of a design was 1.5 times today's at 40 C and at 50 Hz. At a stated strain losses follow
tan(delta), at a stated force the loss compliance J'' = E''/|E*|^2. Both are therefore kept over a
band, and the worst of them is the ratio that counts.
"""

from __future__ import annotations

from collections.abc import Sequence

from gripscale.core.units import ZERO_CELSIUS, celsius
from gripscale.questions.design.compound_limits import PointLimit
from gripscale.rubber import Rubber

# About one turn of a car's wheel at motorway speed, and its harmonics [Hz].
FREQUENCIES = (10.0, 50.0)
# Of a rolling tread, the usual one of the laboratory first [K].
TEMPERATURES = tuple(ZERO_CELSIUS + degrees for degrees in (60.0, 40.0, 50.0, 70.0))
_QUANTITIES = ("loss_factor", "loss_compliance")


def rolling_band(rubber: Rubber) -> tuple[PointLimit, ...]:
    """Return what stands for rolling resistance, at most today's; tan(delta) at 10 Hz first.

    A rubber without a temperature shift has the frequencies alone; where its shift ends, the
    nearest temperature stands for those beyond.
    """
    temperatures = (None,) if rubber.shift is None else TEMPERATURES
    points: dict[object, PointLimit] = {}
    for kelvin in temperatures:
        for frequency in FREQUENCIES:
            for quantity in _QUANTITIES:
                point = PointLimit(quantity, 0.0, 1.0, frequency, kelvin).within_shift(rubber)
                points.setdefault((quantity, frequency, point.temperature), point)
    return tuple(points.values())


def rolling_ratio(band: Sequence[PointLimit], rubber: Rubber, today: Rubber) -> float:
    """Return the rolling resistance of a compound over today's [-]: the worst of the band."""
    return max(point.value(rubber) / point.value(today) for point in band)


def band_in_words(band: Sequence[PointLimit]) -> str:
    """Return the conditions of a band, such as "10 to 50 Hz and 40 to 70 °C"."""
    kelvins = sorted(point.temperature for point in band if point.temperature is not None)
    where = "the temperature measured" if not kelvins else celsius(kelvins[0])
    if len(set(kelvins)) > 1:
        where = f"{kelvins[0] - ZERO_CELSIUS:g} to {celsius(kelvins[-1])}"
    beyond = " (the shift ends there)" if any(point.wanted for point in band) else ""
    return f"{FREQUENCIES[0]:g} to {FREQUENCIES[-1]:g} Hz and {where}{beyond}"
