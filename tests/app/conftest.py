"""A small case with its files, and the folder of a visit."""

import pytest

from tests.samples import HALF_PLANE, case_text, write_short_road

pytest.importorskip("panel", reason="needs pip install 'gripscale[app]'")

CASE = "# a short road\n" + case_text(
    'files = ["../elsewhere/road.txt"]  # dropped with the case\n'
    'scales = 3\nsmallest_wavelength = "1 mm"',
    'file = "dma.txt"\nterms = 4',
    HALF_PLANE,
)


def validation_message(state):
    """Return what is wrong with a case, in a sentence; empty if nothing is."""
    return "" if state.problem is None else state.problem.sentence


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    """Return a folder with case.toml, road.txt and dma.txt, side by side as they are dropped."""
    folder = tmp_path_factory.mktemp("small")
    write_short_road(folder)
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def dropped(small):
    """Return the same by name, as the page gets them."""
    names = ("case.toml", "road.txt", "dma.txt")
    return {name: (small / name).read_bytes() for name in names}
