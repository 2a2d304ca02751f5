"""What the chain makes of all the stacks a height difference correlation does not tell apart.

    python -m studies.stacks_as_good

The shipped road and tread, 3 bar, 0.3 m/s, down to 0.1 mm, small strain; some ten minutes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import gripscale as gs
from gripscale.surface import sine_ambiguity
from studies.chain_and_direct.__main__ import small_strain_chain
from studies.shipped import road, tread

END = 0.1e-3
"""Last wave, or cut-off [m]."""

WAVES = 8


class Way(NamedTuple):
    """A way from heights to waves."""

    name: str
    top_height_fraction: float
    to_cut_off: bool


WAYS = (
    Way("all heights, last wave 0.1 mm", 1.0, False),
    Way("all heights, cut-off 0.1 mm", 1.0, True),
    Way("upper half, cut-off 0.1 mm", 0.5, True),
)


def main() -> None:
    """Print a row for each way."""
    stations = [road(0), road(1)]
    rubber = tread()
    for way in WAYS:
        curve = gs.height_difference(stations, top_height_fraction=way.top_height_fraction)
        if way.to_cut_off:
            fitted = gs.fit_sines(curve, scales=WAVES, cut_off=END)
        else:
            fitted = gs.fit_sines(curve, scales=WAVES, smallest_wavelength=END)
        found = sine_ambiguity(curve, fitted)
        parts = [_spans(rubber, found.stacks, classes) for classes in (1, 8)]
        print(f"| {way.name}, {len(found.stacks)} | {' | '.join(parts)} |", flush=True)


def _spans(rubber: gs.Rubber, stacks: tuple[gs.SineStack, ...], classes: int) -> str:
    """Return smallest and largest area and friction."""
    found = [small_strain_chain(rubber, stack, 0.3, classes) for stack in stacks]
    totals = np.array([(one.contact_fraction, one.friction) for one in found])
    (area, friction), (most_area, most_friction) = totals.min(axis=0), totals.max(axis=0)
    return f"{area:.3f} to {most_area:.3f} | {friction:.2f} to {most_friction:.2f}"


if __name__ == "__main__":
    main()
