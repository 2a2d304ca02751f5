"""An answer from files of two lines of a surface holds the truth as often as it says."""

import pytest

from tests.verification.known_surfaces import (
    UNSEEN,
    Judged,
    all_known,
    bias,
    by_family,
    covered,
    judged,
    table,
)

pytestmark = pytest.mark.verification


@pytest.fixture(scope="module")
def results() -> dict[str, list[Judged]]:
    """136 surfaces of seventeen families, an hour of one core without the truths kept."""
    return judged(all_known())


@pytest.mark.parametrize("name", ["area", "friction"])
def test_nine_of_ten_intervals_hold_the_truth(results: dict[str, list[Judged]], name: str) -> None:
    members = results[name]
    print(name, *table(members), sep="\n")
    assert len(members) == 136
    # measured: 132 and 122; the area's interval is wider than it must be
    assert 0.85 * 136 <= covered(members) <= 0.98 * 136
    assert max(r.half_widths for r in members) <= 2.0  # measured: 1.3 and 1.7
    unseen = [r for r in members if r.known.family in UNSEEN]
    assert covered(unseen) >= 0.85 * len(unseen)


@pytest.mark.parametrize("name", ["area", "friction"])
def test_no_family_is_missed(results: dict[str, list[Judged]], name: str) -> None:
    """Friction of mosaics and of peaky surfaces is held in 5 of 8, of every other family in 6."""
    for family, members in by_family(results[name]).items():
        assert covered(members) >= 5, family
        mean, width = bias(members)
        # a family that the law misses by its own scatter, 0.13, is no defect
        assert abs(mean) <= 0.6 * width, family
