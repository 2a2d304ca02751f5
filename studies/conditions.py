"""What the rubber's own heat does, slow and fast, and what the norm of the strain decides.

    python -m studies.conditions

The shipped road and tread, 3 bar. WLF shift and softening are assumed, no data of this tread are
known; two minutes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import gripscale as gs
from gripscale.chain.heat import WaveHeat
from gripscale.conditions import Conditions, ThermalProperties
from gripscale.rubber import WLF
from gripscale.rubber.softening import Kraus
from studies.shipped import road, tread

SHIFT = WLF(c1=8.86, c2=101.6)
"""Far from other data: 100 degrees above the glass transition of most rubbers."""
HEAT = Conditions(heat=ThermalProperties(conductivity=0.25, density=1150.0, specific_heat=1500.0))
SOFTENING = Kraus(0.3, 0.15, 0.02, 1e-3, "shear")
LOAD: dict[str, Any] = {"pressure": 3e5, "footprint": 0.1}
WAVES, END = 8, 1e-4
"""Of the chain, the last wave so long [m]."""
LINE = 16384
"""Points of the road in the direct contact."""
LOW, HIGH = 1e-4, 10.0
"""Speeds [m/s]."""
SPEEDS = (1e-3, 1e-2, 1e-1, 1.0)


def shifted_tread() -> gs.Rubber:
    """Return the tread with the assumed shift."""
    return replace(tread(), shift=SHIFT)


def road_waves() -> gs.SineStack:
    """Return the waves of the road."""
    curve = gs.height_difference([road(0), road(1)])
    return gs.fit_sines(curve, scales=WAVES, smallest_wavelength=END)


def line_of_road(points: int) -> gs.Profile:
    """Return the first points of the road."""
    whole = road(0)
    return gs.Profile(whole.x[:points], whole.z[:points])


def by_heat(model: Any, speed: float) -> tuple[Any, Any]:
    """Return what a model answers without and with its own heat."""
    return model(speed, None), model(speed, HEAT)


def main() -> None:
    """Print the tables."""
    rubber, sines, line = shifted_tread(), road_waves(), line_of_road(LINE)

    def chain(speed: float, conditions: Conditions | None) -> gs.ChainResult:
        return gs.solve_chain(rubber, sines, speed=speed, conditions=conditions, **LOAD)

    def direct(speed: float, conditions: Conditions | None) -> Any:
        return gs.solve_rough_contact(rubber, line, speed=speed, conditions=conditions, **LOAD)

    for row in heat_rows({"chain": chain, "direct": direct}):
        print(row, flush=True)
    print()
    for row in norm_rows(chain):
        print(row, flush=True)
    print()
    for row in depth_rows(chain(0.3, None)):
        print(row, flush=True)


def heat_rows(models: dict[str, Any]) -> Iterator[str]:
    """Return the table of what heat changes."""
    yield "| model | speed m/s | A cold | A | mu cold | mu | change of A | of mu |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, model in models.items():
        for speed in (LOW, HIGH):
            cold, hot = by_heat(model, speed)
            area = hot.contact_fraction / cold.contact_fraction - 1.0
            friction = hot.friction / cold.friction - 1.0
            yield (
                f"| {name} | {speed:g} | {cold.contact_fraction:.4f} | {hot.contact_fraction:.4f} "
                f"| {cold.friction:.4f} | {hot.friction:.4f} | {area:+.2%} | {friction:+.2%} |"
            )


def norm_rows(chain: Any) -> Iterator[str]:
    """Return the table of what the norm of the strain decides."""
    yield "| speed m/s | norm | strain, first and last wave | f | g | A | mu |"
    yield "|---|---|---|---|---|---|---|"
    for speed in SPEEDS:
        for norm in ("slope", "stretch"):
            found = chain(speed, Conditions(softening=SOFTENING, strain_norm=norm))
            first, last = (found.scales[at].details for at in (0, -1))
            ends = [
                f"{first[name]:.3f}, {last[name]:.3f}"
                for name in ("strain", "storage_modulus_ratio", "loss_modulus_ratio")
            ]
            yield (
                f"| {speed:g} | {norm} | {' | '.join(ends)} | {found.contact_fraction:.4f} | "
                f"{found.friction:.3f} |"
            )


def depth_rows(found: gs.ChainResult) -> Iterator[str]:
    """Return the table of how deep energy is lost, in the block and by the half-plane's formula."""
    yield "| wavelength mm | mean depth of the loss / wavelength | half-plane | ratio |"
    yield "|---|---|---|---|"
    for wave in found.scales:
        block = WaveHeat.of(wave, found.rubber).depth.mean / wave.wavelength
        without = replace(wave, loss_by_depth=None)
        plane = WaveHeat.of(without, found.rubber).depth.mean / wave.wavelength
        yield (f"| {1e3 * wave.wavelength:.3g} | {block:.4f} | {plane:.4f} | {block / plane:.3f} |")


if __name__ == "__main__":
    main()
