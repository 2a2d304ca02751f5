"""An estimate of a surface from two of its lines holds the truth as often as it says."""

import pytest

from tests.verification.known_surfaces import ISOTROPIC, SEEDS, bias, covered, judged, table

pytestmark = pytest.mark.verification


def test_nine_of_ten_intervals_hold_the_truth():
    """Forty maps of five families, on none of which the law was fitted.

    40 intervals of the area hold the truth and 39 of the friction; no miss is beyond 1.2
    half-widths. Were they of exactly 90 %, fewer than 33 would hold it in 4 of 100 such tests.
    Without the law the area is half too large. A minute of one core with the truths kept, four
    without.
    """
    for name, results in judged(list(ISOTROPIC), SEEDS).items():
        print(name, *table(results), sep="\n")
        assert len(results) == 40
        assert 33 <= covered(results) <= 40, name
        assert max(r.half_widths for r in results) <= 2.0, name
        for family in ISOTROPIC:
            mean, width = bias([r for r in results if r.family == family])
            # one draw of the scatter of the law from family to family, 0.12: the interval holds it
            assert abs(mean) <= 0.5 * width, (name, family)
