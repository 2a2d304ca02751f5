"""The pictures that explain the model come from one script, and their pages quote its numbers."""

import re

import numpy as np
import pytest
from matplotlib.figure import Figure

from studies.book_figures import FIGURES, PICTURES, Shipped, answers, block, road, stack, wave
from tests.samples import DOCS


@pytest.fixture(scope="module")
def shipped() -> Shipped:
    return Shipped()


def rows(page: str) -> dict[str, list[str]]:
    """Return the cells of the rows of all tables of a page, by their first cell."""
    text = (DOCS / page).read_text(encoding="utf-8")
    cells = ([c.strip() for c in line.strip("|").split("|")] for line in text.splitlines()
             if line.startswith("|"))  # fmt: skip
    return {first.strip("*"): rest for first, *rest in cells}


ROWS = {
    "direct contact": "direct contact, measured surface",
    "Persson": "Persson, lines of an isotropic surface",
}
"""Names of models in the table of the comparison, where they are others than in the picture."""


def test_every_picture_is_written_and_shown_on_a_page() -> None:
    names = {f"book_{picture.__name__}" for picture in PICTURES}
    assert names == {path.stem for path in FIGURES.glob("book_*.png")}
    pages = " ".join(path.read_text(encoding="utf-8") for path in DOCS.glob("*.md"))
    assert names == set(re.findall(r"\(figures/(book_\w+)\.png\)", pages))


@pytest.mark.parametrize("picture", [block, wave, stack, road])
def test_a_picture_of_the_chain_is_drawn(picture, shipped: Shipped) -> None:
    figure = picture(shipped)
    assert isinstance(figure, Figure)
    drawn = [line for axes in figure.axes for line in axes.lines]
    assert any(np.isfinite(np.asarray(line.get_ydata(), dtype=float)).any() for line in drawn)


def test_the_friction_of_the_drawn_wave_is_that_of_the_chain(shipped: Shipped) -> None:
    """But for its load time, which is unlimited: it changes this wave by 0.03 %."""
    friction = shipped.wave(0.3).friction
    assert friction == pytest.approx(float(shipped.chain.friction[1]), rel=2e-3)


@pytest.mark.verification
def test_the_table_of_models_has_their_answers(shipped: Shipped) -> None:
    """To a unit of the last digit: the friction of the direct contact is 0.1668."""
    table = rows("which-model.md")
    for name, data in answers(shipped).items():
        area, friction = (
            float(table[ROWS.get(name, name)][column].strip("*")) for column in (0, 3)
        )
        assert area == pytest.approx(float(data.total_contact_fraction), abs=1.5e-4)
        assert friction == pytest.approx(float(data.total_friction), abs=1e-3)


def test_the_shares_by_slope_are_those_of_the_direct_contact(shipped: Shipped) -> None:
    table = rows("rubber-friction.md")
    load, friction = (
        shipped.direct[f"answer_{name}_by_slope"].values for name in ("load", "friction")
    )
    parts = {"below 0.5": slice(0, 2), "0.5 to 1": slice(2, 3), "above 1": slice(3, None)}
    for name, part in parts.items():
        shares = [float(cell.removesuffix(" %")) / 100.0 for cell in table[name]]
        assert shares == pytest.approx([load[part].sum(), friction[part].sum()], abs=0.006)


def test_the_answers_of_the_first_page_are_those_of_the_models(shipped: Shipped) -> None:
    table, direct = rows("rubber-friction.md"), shipped.direct
    expected = {
        "chain": (shipped.chain.total_contact_fraction, shipped.chain.total_friction),
        "direct contact": (direct.total_contact_fraction, direct.total_friction),
        "answer of `gripscale run`, with both corrections": (
            direct.answer_contact_fraction, direct.answer_friction),
    }  # fmt: skip
    for name, values in expected.items():
        assert [float(cell) for cell in table[name]] == [float(f"{float(v):.2g}") for v in values]
