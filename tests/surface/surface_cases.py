"""Curves and profiles the surface tests share."""

import numpy as np

from gripscale.surface import HeightDifference, Profile, SineStack
from tests.samples import EXAMPLES

DATA = EXAMPLES / "data"
ROAD = [DATA / "road" / f"20211011_aylesbury_dec_station_{station}.dat" for station in (0, 1)]
ROAD_ONLY = (0.120, 1.780)  # m, between the reference plates (SOURCE.txt)


def geometric_stack(first, amplitude, s_wavelength, s_amplitude, waves):
    order = np.arange(waves)
    return SineStack(
        wavelength=first / s_wavelength**order, amplitude=amplitude / s_amplitude**order
    )


def exact_curve(stack, smallest, largest, lags=100):
    lag = np.geomspace(smallest, largest, lags)
    return HeightDifference(lag, stack.height_difference(lag))


def profile_of(z, step=1e-4):
    return Profile(step * np.arange(len(z)), z)
