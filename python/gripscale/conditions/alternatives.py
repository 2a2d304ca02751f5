"""How far typical laws may be off: conditions with one of them a standard error away.

A typical tread has the scatter between measured compounds, typical thermal constants that between
rubbers. Whether a strain sweep was made in tension or in shear is as likely one as the other, and
so is a single or a double amplitude that nothing states. A master curve of unknown strain was
measured at 0.04 to 0.3 %, two times in three.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from gripscale.conditions.conditions import Conditions
from gripscale.conditions.flash_temperature import THERMAL_SCATTER, ThermalProperties
from gripscale.rubber.softening import Kraus, SofteningTable
from gripscale.rubber.typical_tread import SOFTER_TREAD, TypicalTread

# What may not be known.
TREADS = "scatter between treads"
TENSION_OR_SHEAR = "sweeps in tension or in shear"
THERMAL_CONSTANTS = "typical thermal constants"
MASTER_CURVE_STRAIN = "strain of the master curve"
AMPLITUDE = "single or double amplitude of the sweeps"
MEASURED_LAWS = (Kraus, SofteningTable, TypicalTread)  # in tension or in shear


@dataclass(frozen=True)
class Alternative:
    """Conditions that may be true as well, or another warming by them."""

    label: str  # what is not known, in words
    conditions: Conditions
    warming: float = 1.0  # over that of the conditions as they are [-]
    # Standard error of the logarithm of a result over its change by these conditions [-].
    share: float = 1.0


def alternatives(conditions: Conditions) -> Iterator[Alternative]:
    """Yield what may be true as well, one for each thing that is not known."""
    softening, heat = conditions.softening, conditions.heat
    if isinstance(softening, TypicalTread):
        softer = replace(softening, deviation=softening.deviation + SOFTER_TREAD.deviation)
        yield Alternative(TREADS, replace(conditions, softening=softer))
    if isinstance(softening, MEASURED_LAWS) and softening.deformation is None:
        tension = replace(softening, deformation="tension")
        # either end is as likely, and the change is from the middle to one of them
        yield Alternative(TENSION_OR_SHEAR, replace(conditions, softening=tension))
    if isinstance(softening, SofteningTable):
        yield from _of_sweeps(conditions, softening)
    if heat == ThermalProperties():
        hotter = math.exp(THERMAL_SCATTER)
        yield Alternative(THERMAL_CONSTANTS, conditions, warming=hotter)


def _of_sweeps(conditions: Conditions, sweeps: SofteningTable) -> Iterator[Alternative]:
    """Yield what is not stated of the strains of a master curve and of sweeps."""
    if sweeps.measured_at is None:
        ends = [strains[0] for strains in sweeps.strain], [strains[-1] for strains in sweeps.strain]
        strain = min(max(math.e * sweeps.reference(0), *ends[0]), *ends[1])
        other = replace(sweeps, measured_at=strain)
        yield Alternative(MASTER_CURVE_STRAIN, replace(conditions, softening=other))
    if sweeps.amplitude_assumed:
        half = [[0.5 * strain for strain in strains] for strains in sweeps.strain]
        last = min(strains[-1] for strains in half)
        at = None if sweeps.measured_at is None else min(sweeps.measured_at, last)
        other = replace(sweeps, strain=half, measured_at=at)
        # one end is assumed: the change is from it to the other
        yield Alternative(AMPLITUDE, replace(conditions, softening=other), share=0.5)
