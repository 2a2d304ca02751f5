"""The shipped case on a dry road runs, coarse, with each of its conditions and without it."""

from __future__ import annotations

from pathlib import Path

import pytest

from gripscale.case_file import read_case
from gripscale.half_space.model import DirectContact
from gripscale.questions import Study
from tests.samples import EXAMPLES

EXAMPLE = EXAMPLES / "road_and_tread" / "case.toml"
COARSE = """
[solver]
model = "half_plane"
points = 128
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example with two waves, the last 5 mm long, on small strain and a quarter of the road."""
    text = EXAMPLE.read_text(encoding="utf-8")
    for old, new in (
        ('"1780 mm"', '"520 mm"'),
        ("scales = 8", "scales = 2"),
        ('"0.1 mm"', '"5 mm"'),
        ('# interface = "dry"', 'interface = "dry"'),
        ('"../data', f'"{EXAMPLE.parents[1] / "data"}'),
    ):
        assert old in text
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("conditions") / "case.toml"
    path.write_text(text + COARSE, encoding="utf-8")
    return path


def test_effects_in_chain_and_direct_contact(case: Path) -> None:
    results = read_case(case)
    models = results.chain, DirectContact(tolerance=None, conditions=results.conditions)
    for model in models:
        selections = ["all", "no temperature", "no softening", "no heat", "none"]
        found = Study(results, {"effects": selections}, model=model).run()
        assert (found.prediction_status == "converged").all()
        # 20 C is colder than the master curve, 40 C: without it the rubber touches more;
        # strain and heat soften it.
        area = found.total_contact_fraction
        assert area[1] > area[0]
        assert (area[2:4] < area[0]).all()
        assert (found.total_adhesive_friction > 0.0).all()
