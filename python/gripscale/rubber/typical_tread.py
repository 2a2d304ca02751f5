"""Softening of a typical tread: of a filled rubber whose strain sweeps were not measured.

    ln f = m_f(e, T) + d s_f(e),      ln g = m_g(e, T) + d s_g(e)

with m the mean of treads, s their scatter and d the deviation of the rubber from the mean. Both
logarithms move together: from 0.5 % of strain on their correlation between compounds is above 0.98.
The treads are S100, S120, S140 (1 Hz; 0, 10, 30 and 50 C) and R60 (one temperature, taken as 30 C;
up to 15 % of strain). Four compounds are few: s is that of the 90 % interval of a further one.
`studies/typical_tread.py` computes the numbers from `examples/data/friction`. Whether the sweeps
are in tension or in shear is not stated there.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Checked, checked, checks
from gripscale.rubber.softening import SofteningFactors, SofteningTable
from gripscale.rubber.strain_sweeps import DEFORMATIONS, Deformation

STRAIN = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.236)
"""Single amplitudes [-]; at the first the modulus is that of the master curve."""
SWEPT = (273.15, 323.15)
"""Ends of the mean, which is linear in the temperature between them [K]."""
# Mean factors at both temperatures, and the standard deviations of their logarithms.
MEAN_STORAGE = (
    (1.000, 0.916, 0.784, 0.680, 0.565, 0.398, 0.278, 0.169),
    (1.000, 0.960, 0.883, 0.814, 0.729, 0.577, 0.434, 0.272),
)
MEAN_LOSS = (
    (1.000, 1.019, 0.997, 0.911, 0.774, 0.574, 0.414, 0.205),
    (1.000, 1.023, 1.015, 0.962, 0.872, 0.727, 0.590, 0.348),
)
STORAGE_SCATTER = (0.000, 0.032, 0.073, 0.113, 0.158, 0.226, 0.265, 0.334)
LOSS_SCATTER = (0.000, 0.012, 0.040, 0.092, 0.174, 0.307, 0.390, 0.532)


class TypicalTread(Checked):
    """Mean softening of four treads with published strain sweeps, or a deviation from it.

    Beyond the largest strain and the temperatures of the sweeps their ends are held and flagged.
    """

    kind: ClassVar[str] = "typical_tread"

    deviation: float = checked(checks.number, default=0.0)
    """Standard deviations from the mean of treads [-]; above zero the rubber is harder."""
    deformation: Deformation | None = checked(checks.one_of, choices=DEFORMATIONS, default=None)
    """Kind of the strains; None: not stated, as by the publisher of the sweeps."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        Without a temperature that of the middle of the sweeps, 25 C, is taken.
        """
        kelvin = sum(SWEPT) / len(SWEPT) if temperature is None else temperature
        return _table(self.deviation, self.deformation).factors(strain, kelvin)

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **self.__dict__}


@lru_cache(maxsize=16)
def _table(deviation: float, deformation: Deformation | None) -> SofteningTable:
    storage, loss = (
        (np.array(mean) * np.exp(deviation * np.array(scatter))).tolist()
        for mean, scatter in ((MEAN_STORAGE, STORAGE_SCATTER), (MEAN_LOSS, LOSS_SCATTER))
    )
    return SofteningTable([STRAIN] * 2, storage, loss, STRAIN[0], deformation, SWEPT)


TYPICAL_TREAD = TypicalTread()
"""The mean."""
HARDER_TREAD, SOFTER_TREAD = TypicalTread(1.0), TypicalTread(-1.0)
"""One standard deviation from it."""
