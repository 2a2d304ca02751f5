"""The measurements that are shipped, as the studies take them."""

from __future__ import annotations

from pathlib import Path

import gripscale as gs

DATA = Path(__file__).resolve().parents[1] / "examples" / "data"
PLATES = (0.12, 1.78)
"""Between the reference plates of the measured road [m]."""


def road(station: int) -> gs.Profile:
    """Return a station of the road, cleaned."""
    name = f"20211011_aylesbury_dec_station_{station}.dat"
    return gs.clean(gs.read_profile(DATA / "road" / name), crop=PLATES)[0]


def tread() -> gs.Rubber:
    """Return the filled tread rubber."""
    curve = gs.read_master_curve(DATA / "rubber/measured_dma.txt", reference_temperature=293.15)
    return gs.fit_prony(curve)
