"""A rubber with a shift, two waves and a load that all tests of conditions share."""

import numpy as np

import gripscale as gs
from gripscale.rubber import WLF

RUBBER = gs.Rubber(
    5e6,
    np.geomspace(3e6, 3e8, 10),
    np.geomspace(1e-1, 1e-9, 10),
    reference_temperature=293.15,
    shift=WLF(c1=8.86, c2=101.6),
)
SINES = gs.SineStack([4e-3, 1e-3], [2e-4, 6e-5])
LOAD = {"pressure": 3e5, "speed": 1.0, "footprint": 0.05}
