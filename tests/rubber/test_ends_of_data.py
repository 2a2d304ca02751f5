"""Master curves that end where they should not: the last points, and what lies beyond.

Truths known at every frequency are cut in four ways and measured with 2 % noise.
"""

from itertools import product

import numpy as np
import pytest

from gripscale.rubber import fit_prony_report
from tests.rubber.truths import CUTS, TRUTHS

NOISE = 0.02
SAMPLES = 300


def beyond(omega, truth, low, high):
    """Return the largest factor by which E' or E'' leaves the band, less one."""
    below = [np.max(getattr(low, part) / getattr(truth, part)) for part in ("real", "imag")]
    above = [np.max(getattr(truth, part) / getattr(high, part)) for part in ("real", "imag")]
    return max(*below, *above) - 1.0


QUICK = {
    ("springpots", "whole"),
    ("fractional Zener", "no glass"),
    ("Havriliak-Negami", "no rubber"),
    ("Maxwell", "no glass"),
    ("filled", "flank"),
}
CASES = [
    pytest.param(*case, seed, marks=() if case in QUICK and seed == 0 else pytest.mark.verification)
    for case in product(TRUTHS, CUTS)
    for seed in range(3)
]


@pytest.mark.parametrize(("name", "cut", "seed"), CASES)
def test_the_ends_of_the_data(name, cut, seed):
    """Hold the fit of one truth, cut and measured, to its promises.

    - The five points of each end are met within the noise: the error of the fit (rms, E' and E''
      apart) is at most 1.5 times that of one point, and no finding says otherwise. It would be the
      noise itself if the fit ran through the points; over 200 curves it was 0.42 in the median,
      above the noise in 25 of 800 ends and moduli, 1.41 times it at most.
    - The truth lies in the band up to two decades beyond both ends, to half a per cent of it (the
      band is sought at single frequencies).
    - Within the data it leaves the band by no more than twice the noise: three standard deviations
      at the frequencies sought, less between them.
    """
    truth = TRUTHS[name]
    slowest, fastest = truth.cut(cut)
    master = truth.measured(slowest, fastest, NOISE, seed)
    rubber, fit = fit_prony_report(master)
    error = rubber.complex_modulus(master.angular_frequency)
    exact = truth.modulus(master.angular_frequency)
    for rows in (slice(None, 5), slice(-5, None)):
        for part in ("real", "imag"):
            ratio = getattr(error, part)[rows] / getattr(exact, part)[rows]
            assert np.sqrt(np.mean((ratio - 1.0) ** 2)) < 1.5 * NOISE
    for start, end, allowed in (
        (slowest / 100.0, slowest, 0.005),
        (slowest, fastest, 2.0 * NOISE),
        (fastest, 100.0 * fastest, 0.005),
    ):
        omega = np.geomspace(start, end, SAMPLES)
        band = rubber.complex_modulus_band(omega)
        assert beyond(omega, truth.modulus(omega), *band) < allowed
    assert fit.outlier_frequency.size == 0
    assert fit.consistent
    assert fit.slow_end is None
    assert fit.fast_end is None
