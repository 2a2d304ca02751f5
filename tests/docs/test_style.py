"""Pages can be read: few numbers in the prose, short sentences, a figure, each fact in one place.

A page above a limit stands in a table below with its value. It may not get worse, and its line goes
once it is within the limit: the tables only shrink.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.docs.style import (
    figures,
    number_share,
    page_text,
    parts,
    sentences,
    shared_runs,
    words_a_sentence,
)

PARTS = parts()
PAGES = ["README.md", *(page for pages in PARTS.values() for page in pages)]

MOST_NUMBERS = 6.0
"""Per cent of the words of the prose, outside Evidence."""
TOO_MANY_NUMBERS: dict[str, float] = {}
MOST_WORDS = 20.0
"""Of a sentence, in the mean of a page."""
TOO_LONG_SENTENCES: dict[str, float] = {}
WITHOUT_FIGURE: set[str] = set()
"""Pages of Start and Understand."""
MOST_RUNS = 5
"""Runs of ten words that two pages share."""
SHARED_RUNS: dict[tuple[str, str], int] = {}


def assert_ratchet(
    pages: list[str], measure: Callable[[str], float], limit: float, above: dict[str, float]
) -> None:
    """Assert that pages are within a limit, those in `above` not beyond their values there."""
    values = {page: round(measure(page_text(page)), 1) for page in pages}
    worse = {p: v for p, v in values.items() if v > above.get(p, limit)}
    assert not worse, "beyond the limit"
    assert not [page for page in above if values[page] <= limit], "within the limit: take them out"


def test_few_words_are_numbers() -> None:
    pages = ["README.md", *(p for part in PARTS if part != "Evidence" for p in PARTS[part])]
    assert_ratchet(pages, lambda text: 100 * number_share(text), MOST_NUMBERS, TOO_MANY_NUMBERS)


def test_sentences_are_short() -> None:
    assert_ratchet(PAGES, words_a_sentence, MOST_WORDS, TOO_LONG_SENTENCES)


def test_pages_that_explain_have_a_figure() -> None:
    pages = [*PARTS["Start"], *PARTS["Understand"]]
    assert {page for page in pages if not figures(page_text(page))} == WITHOUT_FIGURE


def test_each_fact_stands_in_one_place() -> None:
    counts = shared_runs(PAGES)
    worse = {pair: n for pair, n in counts.items() if n > SHARED_RUNS.get(pair, MOST_RUNS)}
    assert not worse
    assert not [pair for pair in SHARED_RUNS if counts[pair] <= MOST_RUNS], "take them out"


def test_parts_are_five() -> None:
    assert list(PARTS) == ["Start", "Understand", "Do", "Reference", "Evidence"]


SAMPLE = """# Title of 3 words

Two stones weigh 3 kg. They cost `5` each, see [page 7](x.md).

| 1 | 2 |

- First item has 9 lives
- Second item

![A figure](figures/a.png)

```sh
10 11 12
```
"""


def test_prose_is_measured_without_tables_code_and_headings() -> None:
    assert sentences(SAMPLE) == [
        "Two stones weigh 3 kg.",
        "They cost code each, see page 7.",
        "First item has 9 lives",
        "Second item",
    ]
    assert number_share(SAMPLE) == pytest.approx(3 / 19)
    assert words_a_sentence(SAMPLE) == pytest.approx(19 / 4)
    assert figures(SAMPLE) == ["figures/a.png"]
