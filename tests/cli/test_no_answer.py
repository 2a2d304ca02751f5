"""Cases that allow no good answer: `run`, `compare` and the page say so before any number."""

import numpy as np
import pytest

from gripscale.surface import self_affine_profile
from tests.report.reading import Page
from tests.samples import (
    HALF_PLANE,
    case_text,
    write_master_curve,
    write_maxwell,
    write_road,
)

pytestmark = pytest.mark.usefixtures("undrawn")
SURFACE = 'files = ["road.txt"]\nscales = 4\nsmallest_wavelength = "0.8 mm"\nspikes = "iso13473"'
CASE = case_text(
    SURFACE, 'file = "dma.txt"\nterms = 6', HALF_PLANE + '\n\n[output]\nfolder = "results"'
)


@pytest.fixture
def case(tmp_path):
    """A rough road of 0.6 m and a rubber measured over all its frequencies."""
    write_maxwell(tmp_path / "dma.txt")
    road = self_affine_profile(0.8, 1e-2, 8e-4, length=0.6, step=2e-4, seed=1)
    write_road(tmp_path / "road.txt", road)
    (tmp_path / "case.toml").write_text(CASE)
    return tmp_path / "case.toml"


def replaced(case, old, new):
    text = case.read_text()
    assert old in text
    case.write_text(text.replace(old, new))


def test_the_first_line_says_that_there_is_no_answer(shell, case):
    replaced(case, "scales", 'crop = ["200 mm", "220 mm"]\nscales')
    result = shell("compare", case, "--models", "chain_half_plane,direct", columns=400)
    assert result.exit_code == 0, result.output
    lines = [line for line in result.stdout.splitlines() if line and line[0] not in "[gCS"]
    statement = "Answer: none to rely on. The measured surface is too small"
    assert lines[0].startswith(statement)
    (best,) = (line for line in lines if line.startswith("Best estimate"))
    assert best.endswith("; not to be relied on")
    page = Page(case.parent / "results" / "comparison" / "report.html")
    assert len([a for _, a in page.tags if a.get("role") == "alert"]) == 1
    assert "not to be relied on" in page.text, "in the cards"
    assert statement in page.text


def test_what_cannot_be_solved_is_an_error_before_all_else(shell, case):
    frequency = np.geomspace(1e-3, 1e3, 49)
    relaxed = 1j * frequency / (1.0 + 1j * frequency)
    write_master_curve(case.with_name("dma.txt"), frequency, 1e6 * relaxed + 1e3j * frequency)
    replaced(case, '"0.3 m/s"', "0")
    result = shell("run", case)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "the pressure squeezes the rubber, a melt at rest, flat" in result.stderr
    assert "must be at least 1/10 of the pressure, 3e+04; got" in result.stderr
