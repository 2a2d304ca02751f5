"""What the chain makes of waves whose factors obey s_A = s_lambda^H, against a free fit.

    python -m studies.link_of_factors

The shipped road and tread, 3 bar, 0.3 m/s, last wave 0.1 mm, small strain; a minute.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

import gripscale as gs
from studies.chain_and_direct.__main__ import small_strain_chain
from studies.shipped import road, tread

END = 0.1e-3
"""Last wave [m]."""

NUMBERS = (4, 5, 6, 8, 10, 12)
FACTORS = (1.3, 12.0)
"""Between them the factor of wavelength is sought [-]."""


def linked(curve: gs.HeightDifference, waves: int, hurst: float) -> gs.SineStack:
    """Return the best stack of so many waves with s_A = s_lambda^H, the last END long."""

    def stack(log_factor: float) -> gs.SineStack:
        factor = float(np.exp(log_factor))
        return gs.fit_sines(
            curve,
            scales=waves,
            s_wavelength=factor,
            s_amplitude=factor**hurst,
            first_wavelength=END * factor ** (waves - 1),
        )

    def residual(log_factor: float) -> float:
        found = stack(log_factor).residual
        return np.inf if found is None else found

    low, high = np.log(FACTORS[0]), np.log(FACTORS[1])
    longest = np.log(0.2 / END) / (waves - 1)  # 0.2 m
    bounds = (low, float(min(high, longest)))
    return stack(float(minimize_scalar(residual, bounds=bounds, method="bounded").x))


def main() -> None:
    """Print a row for each number of waves."""
    curve = gs.height_difference([road(0), road(1)])
    hurst = gs.fit_self_affine(curve).hurst
    rubber = tread()
    print(f"H = {hurst:.3f}")
    print("| waves | free: log s_A / log s_lambda, residual, A, mu | linked: residual, A, mu |")
    print("|---|---|---|")
    for waves in NUMBERS:
        free = gs.fit_sines(curve, scales=waves, smallest_wavelength=END)
        tied = linked(curve, waves, hurst)
        one, other = (small_strain_chain(rubber, stack, 0.3, 1) for stack in (free, tied))
        ratio = _exponent(free)
        print(
            f"| {waves} | {ratio:.3f}, {free.residual:.3f}, {one.contact_fraction:.4f}, "
            f"{one.friction:.3f} | {tied.residual:.3f}, {other.contact_fraction:.4f}, "
            f"{other.friction:.3f} |",
            flush=True,
        )


def _exponent(stack: gs.SineStack) -> float:
    """Return log s_A / log s_lambda from the first and last wave."""
    amplitude, wavelength = stack.amplitude, stack.wavelength
    return float(np.log(amplitude[0] / amplitude[-1]) / np.log(wavelength[0] / wavelength[-1]))


if __name__ == "__main__":
    main()
