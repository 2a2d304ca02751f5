"""An answer from files of two lines of a surface holds the truth as often as it says."""

import pytest

from tests.verification.known_surfaces import (
    FAMILIES_OF_MORE,
    MORE_SEEDS,
    UNSEEN,
    Judged,
    all_known,
    bias,
    by_family,
    covered,
    intermittent,
    judged,
    table,
)

pytestmark = pytest.mark.verification


@pytest.fixture(scope="module")
def results() -> dict[str, list[Judged]]:
    """168 surfaces of seventeen families, an hour of one core without the truths kept."""
    return judged(all_known() + all_known(FAMILIES_OF_MORE, MORE_SEEDS))


@pytest.mark.parametrize("name", ["area", "friction"])
def test_nine_of_ten_intervals_hold_the_truth(results: dict[str, list[Judged]], name: str) -> None:
    members = results[name]
    print(name, *table(members), sep="\n")
    assert len(members) == 168
    # measured: 164 and 152; the area's interval is wider than it must be
    assert 0.85 * 168 <= covered(members) <= 0.98 * 168
    assert max(r.half_widths for r in members) <= 2.0  # measured: 1.3 and 1.8
    unseen = [r for r in members if r.known.family in UNSEEN]
    assert covered(unseen) >= 0.85 * len(unseen)


@pytest.mark.parametrize("name", ["area", "friction"])
def test_no_family_is_missed(results: dict[str, list[Judged]], name: str) -> None:
    """Three quarters of every family: 6 of 8, or 18 of 24."""
    for family, members in by_family(results[name]).items():
        assert covered(members) >= 0.75 * len(members), family
        mean, width = bias(members)
        # a family that the law misses by its own scatter, 0.13, is no defect
        assert abs(mean) <= 0.6 * width, family


@pytest.fixture(scope="module")
def of_intermittent() -> dict[str, list[Judged]]:
    """Sixty surfaces of ten intermittent families, three rubbers, 0.03 to 10 bar."""
    return judged(intermittent())


@pytest.mark.parametrize("name", ["area", "friction"])
def test_intervals_hold_on_intermittent_surfaces(
    of_intermittent: dict[str, list[Judged]], name: str
) -> None:
    members = of_intermittent[name]
    print(name, *table(members), sep="\n")
    assert len(members) == 60
    assert 0.75 * 60 <= covered(members) <= 0.98 * 60
    assert max(r.half_widths for r in members) <= 2.5  # measured: 2.3, a strong cascade at 1 bar
    unseen = [r for r in members if r.known.family in UNSEEN]
    assert covered(unseen) >= 0.75 * len(unseen)
