"""The interfacial shear stress of a tread on a dry road, from friction measured with others.

    ln tau_f = ln tau_0 - c log10(v/v_0)^2 + d s

with d the deviation of the tread from the mean and s the scatter between compounds. tau_f is
(mu - hysteresis) p_0 A_0/A_r, mu measured and the rest computed as an answer is
(`studies/dry_law.py`, from `examples/data/friction`). With each compound left out, all points lie
in the 90 % interval of the others.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, checked, checks

# tau_0 [Pa], c, v_0 [m/s] of the compounds S100, S120 and S140, and s of a further one: its 90 %
# interval by Student's t, as three are few.
DRY_STRESS_0, DRY_WIDTH, DRY_SPEED_0, STRESS_SCATTER = 1.86e6, 0.098, 0.140, 0.24
DRY_SPEEDS = (1e-4, 1.0)
"""Range of the measured speeds [m/s]; the stress is held beyond."""
DRY_ASSUMPTIONS = (
    "Dry road: shear stress of three treads of one maker without resin on one road, 0.1 mm/s to "
    "1 m/s, 3 bar and 20 C assumed; resin raised it by 9 to 24 %."
)


def sliding_speeds(speed: ArrayLike) -> Array:
    """Return speeds [m/s]; raise `InputError` if one is negative or not a number."""
    speeds = checks.real("speed", speed, unit="m/s")
    if (speeds < 0.0).any():
        raise InputError(f"speed must not be negative [m/s]; got {speeds.min():g}")
    return speeds


class DryTread(Checked):
    """Mean of treads without resin on a dry road, or a deviation from it; at any temperature."""

    kind: ClassVar[str] = "dry_tread"

    deviation: float = checked(checks.number, default=0.0)
    """Standard deviations of ln tau_f from the mean of treads [-]."""

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape; held beyond those measured."""
        decades = np.log10(np.clip(sliding_speeds(speed), *DRY_SPEEDS) / DRY_SPEED_0)
        log = self.deviation * STRESS_SCATTER - DRY_WIDTH * decades**2
        return np.asarray(DRY_STRESS_0 * np.exp(log))


DRY_TREAD = DryTread()
"""The mean."""
