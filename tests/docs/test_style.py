"""Pages can be read: few numbers, short sentences, a figure, each fact in one place."""

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

MOST_NUMBERS = 0.0605
"""Of the words of the prose, outside Evidence."""
MOST_WORDS = 20.05
"""Of a sentence, in the mean of a page."""
MOST_RUNS = 5
"""Runs of ten words that two pages share."""


@pytest.mark.parametrize("page", PAGES)
def test_sentences_are_short_and_few_words_are_numbers(page):
    text = page_text(page)
    assert words_a_sentence(text) < MOST_WORDS
    assert page in PARTS["Evidence"] or number_share(text) < MOST_NUMBERS


def test_pages_that_explain_have_a_figure():
    assert list(PARTS) == ["Start", "Understand", "Do", "Reference", "Evidence"]
    pages = [*PARTS["Start"], *PARTS["Understand"]]
    assert not [page for page in pages if not figures(page_text(page))]


def test_each_fact_stands_in_one_place():
    assert not {pair for pair, count in shared_runs(PAGES).items() if count > MOST_RUNS}


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


def test_prose_is_measured_without_tables_code_and_headings():
    assert sentences(SAMPLE) == [
        "Two stones weigh 3 kg.",
        "They cost code each, see page 7.",
        "First item has 9 lives",
        "Second item",
    ]
    assert number_share(SAMPLE) == pytest.approx(3 / 19)
    assert words_a_sentence(SAMPLE) == pytest.approx(19 / 4)
    assert figures(SAMPLE) == ["figures/a.png"]
