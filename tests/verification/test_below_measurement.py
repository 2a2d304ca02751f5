"""Octaves that were withheld and continued: the band holds the truth as often as it says.

Twelve lines of five kinds: a road, a machined surface, Gaussian lines, overlapping caps and
lognormal cascades. `python -m pytest -m verification -s` prints the table.
"""

import numpy as np
import pytest

from tests.verification.withheld_octaves import judged, measured_lines, synthetic_lines

pytestmark = pytest.mark.verification


def test_nine_of_ten_bands_hold_the_truth():
    """One to three octaves of twelve lines: 35 of 36 hold the friction, 35 the area.

    Were the bands of exactly 90 %, fewer than 29 would hold it in 4 of 100 such tests. No miss is
    beyond 1.3 half widths. In the mean over all lines the area is 3 % too large and the friction
    7 % too small. Stronger cascades are beyond the method: with a variance of 0.15 an octave, which
    gives slopes a kurtosis of 300, three withheld octaves leave half of the friction.
    """
    results = list(judged([*measured_lines(), *synthetic_lines()]))
    for r in results:
        print(f"{r.line:24} {r.octaves} {r.contact_fraction:.2f} {r.friction:.2f} {r.band:.2f}")
    assert len(results) == 36
    for name in ("friction", "contact_fraction"):
        logs = np.log([getattr(r, name) for r in results])
        print(name, sum(r.holds(name) for r in results), np.exp(logs.mean()))
        assert sum(r.holds(name) for r in results) >= 29, name
        assert max(np.abs(logs) / np.arcsinh([r.band for r in results])) <= 1.3, name
        assert abs(logs.mean()) < 0.10, name
    for octaves, band in ((1, 0.20), (2, 0.29), (3, 0.35)):
        assert all(r.band <= band for r in results if r.octaves == octaves)
