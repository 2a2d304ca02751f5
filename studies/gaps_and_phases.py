"""How much of what random phases change on a road comes from the lines that bridge its gaps.

    python -m studies.gaps_and_phases

A profile with missing heights is bridged by straight lines, steep where flanks are missing, and
`random_phases` spreads their roughness over the whole surface. The height difference correlation of
measured pairs does not hold it. Here random phases are drawn of a smooth spectrum,

    C_z(l) = 2 sum_k P_k (1 - cos q_k l),     log P piecewise linear in log q, four nodes a decade,

fitted once to C_z of the filled profile, which has to answer as `random_phases` does, and once to
C_z of measured pairs, both from the first consistent lag on. The shipped road and tread, 3 bar,
0.3 m/s; some five minutes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

import gripscale as gs
from gripscale.half_space import one_period
from gripscale.surface.resampling import fill_gaps
from gripscale.surface.sine_fit import first_consistent_lag
from studies.random_phases import random_phases
from studies.shipped import road, tread

Array = NDArray[np.float64]

NODES_PER_DECADE = 4
LARGEST_LAG = 30e-3
STIFFNESS = 0.03
"""Weight of the third differences of log P at the nodes: enough to settle what C_z leaves open."""

SEEDS = 3

AS_MEASURED = "as measured"


def smooth_spectrum(line: gs.Profile, smallest_lag: float) -> Array:
    """Return the variance of each mode of the line [m^2], as C_z tells it from a lag [m] on."""
    curve = gs.height_difference(line, max_lag=LARGEST_LAG)
    keep = curve.lag >= smallest_lag * (1.0 - 1e-9)
    wanted, mode = np.log(curve.value[keep]), np.arange(1, len(line) // 2 + 1)
    q = 2.0 * np.pi * mode / (len(line) * line.step)
    log_q, weight = np.log(q), 2.0 * (1.0 - np.cos(np.outer(curve.lag[keep], q)))
    count = 1 + int(NODES_PER_DECADE * (log_q[-1] - log_q[0]) / np.log(10.0))
    nodes = np.linspace(log_q[0], log_q[-1], count)

    def residual(levels: Array) -> Array:
        misfit = np.log(weight @ np.exp(np.interp(log_q, nodes, levels))) - wanted
        return np.append(misfit, STIFFNESS * np.diff(levels, 3))

    start = np.interp(nodes, log_q, np.log(1e-6 * mode**-2.6))
    found = least_squares(residual, start).x
    return np.asarray(np.exp(np.interp(log_q, nodes, found)), dtype=float)


def drawn(line: gs.Profile, variance: Array, seed: int) -> gs.Profile:
    """Return a periodic line with the variance of each mode [m^2] and random phases."""
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, variance.size)
    size = 0.5 * len(line) * np.sqrt(2.0 * variance)
    z = np.fft.irfft(np.append(0.0, size * np.exp(1j * phase)), len(line))
    return gs.Profile(line.x, z, name=f"{line.name}, smooth spectrum", source=f"seed {seed}")


def main() -> None:
    """Print a row for each cut-off, station and way to draw."""
    rubber, stations = tread(), (road(0), road(1))
    for cut_off in (0.4e-3, 0.1e-3):
        for number, line in enumerate(stations):
            _rows(rubber, line, f"station {number}", cut_off)


def _rows(rubber: gs.Rubber, line: gs.Profile, name: str, cut_off: float) -> None:
    first = first_consistent_lag(gs.height_difference(line))
    whole = gs.Profile(line.x, fill_gaps(line.z), name=line.name)
    of_filled, of_pairs = (smooth_spectrum(one, first) for one in (whole, line))
    ways = {
        AS_MEASURED: [line],
        "random phases": [random_phases(line, seed) for seed in range(SEEDS)],
        "smooth spectrum, C_z of filled": [drawn(line, of_filled, s) for s in range(SEEDS)],
        "smooth spectrum, C_z of measured pairs": [drawn(line, of_pairs, s) for s in range(SEEDS)],
    }
    for way, lines in ways.items():
        found = [
            gs.solve_rough_contact(
                rubber,
                one,
                pressure=3e5,
                speed=0.3,
                smallest_wavelength=cut_off,
                tolerance=0.05,
                periodic=way != AS_MEASURED,
            )
            for one in lines
        ]
        area = np.mean([one.contact_fraction for one in found])
        friction = np.mean([one.friction for one in found])
        slope = np.mean(
            [_slope(one_period(one) if way == AS_MEASURED else one, cut_off) for one in lines]
        )
        held = np.mean([one.missing_share for one in found])
        print(
            f"| {cut_off * 1e3:g} mm | {name} | {way} | {slope:.2f} | {area:.4f} | {friction:.3f} "
            f"| {held:.2f} |",
            flush=True,
        )


def _slope(line: gs.Profile, cut_off: float) -> float:
    """Return the rms slope of a periodic line without waves below the cut-off [m]."""
    q = 2.0 * np.pi * np.fft.rfftfreq(len(line), line.step)
    size = np.abs(np.fft.rfft(line.z)) / len(line)
    kept = q <= 2.0 * np.pi / cut_off * (1.0 + 1e-9)
    return float(np.sqrt(2.0 * np.sum((q * size)[kept] ** 2)))


if __name__ == "__main__":
    main()
