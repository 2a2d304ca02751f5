"""Measures of the pages: share of numbers, length of sentences, figures, runs of words in common.

`python -m tests.docs.style` prints them for every page of the site and the README.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from itertools import combinations

import yaml

from tests.samples import DOCS, ROOT

RUN = 10
"""Words of a run."""
FENCE = re.compile(r"^(```|\$\$).*?^\1$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"(?:\A|\n\n)(?: {4}.*\n?)+")
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
FIGURE = re.compile(r"!\[([^\]]*)\]\(([^)]+)\)")
LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
CODE = re.compile(r"`[^`\n]+`|<code>.*?</code>")
ITEM = re.compile(r"^\s*(?:[-*]|\d+\.)\s+", re.MULTILINE)
END = re.compile(r"(?<!sec\.)(?<!eq\.)(?<!Fig\.)(?<=[.!?])[\"”*)]*\s+(?=[\"“*(\[]*[A-ZÀ-Ý0-9`μλω])")
NUMBER = re.compile(r"^[^\w]*\d")


def parts() -> dict[str, list[str]]:
    """Return the pages of each part of the site, as paths in `docs`, where no notebook is."""
    nav = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"]
    titled = [item for part in nav for item in part.items()]
    return {title: list(_pages(entries)) for title, entries in titled if title != "Notebooks"}


def _pages(entries: object) -> Iterator[str]:
    if isinstance(entries, str):
        yield entries
    elif isinstance(entries, dict):
        yield from _pages(list(entries.values()))
    elif isinstance(entries, list):
        for entry in entries:
            yield from _pages(entry)


def page_text(page: str) -> str:
    folder = ROOT if page == "README.md" else DOCS
    return (folder / page).read_text(encoding="utf-8")


def prose(text: str) -> str:
    """Return a page without code, equations, headings, tables and figures; links by their words."""
    text = FENCE.sub("", COMMENT.sub("", text))
    text = FIGURE.sub("", INDENTED.sub("\n\n", text))
    lines = (line for line in text.splitlines() if not line.startswith(("#", "|", ":::")))
    return CODE.sub("code", LINK.sub(r"\1", "\n".join(lines)))


def number_share(text: str) -> float:
    """Return the share of the words of the prose that begin with a digit, signs aside."""
    words = [word for word in prose(text).split() if re.search(r"\w", word)]
    return sum(bool(NUMBER.match(word)) for word in words) / max(len(words), 1)


def sentences(text: str) -> list[str]:
    """Return the sentences of the prose; a paragraph and an item of a list end one."""
    blocks = re.split(r"\n\s*\n", ITEM.sub("\n\n", prose(text)))
    pieces = (piece for block in blocks for piece in END.split(" ".join(block.split())))
    return [piece for piece in pieces if re.search(r"\w", piece)]


def words_a_sentence(text: str) -> float:
    whole = sentences(text)
    return sum(len(sentence.split()) for sentence in whole) / max(len(whole), 1)


def figures(text: str) -> list[str]:
    return [target for _, target in FIGURE.findall(text)]


def runs(text: str) -> set[tuple[str, ...]]:
    """Return all runs of `RUN` words of a page, tables included, code and equations not."""
    text = LINK.sub(r"\1", FIGURE.sub("", FENCE.sub("", COMMENT.sub("", text))))
    words = re.findall(r"[\w']+", text.lower())
    return set(zip(*(words[i:] for i in range(RUN)), strict=False))


def shared_runs(pages: list[str]) -> Counter[tuple[str, str]]:
    """Return the number of runs in common of each pair of pages that has any."""
    own = {page: runs(page_text(page)) for page in pages}
    counts = {pair: len(own[pair[0]] & own[pair[1]]) for pair in combinations(sorted(own), 2)}
    return Counter({pair: count for pair, count in counts.items() if count})


def main() -> None:
    """Print the measures of every page."""
    for part, pages in parts().items():
        print(part)
        for page in pages:
            text = page_text(page)
            numbers, length = 100 * number_share(text), words_a_sentence(text)
            count = len(figures(text))
            print(f"  {page:32} {numbers:5.1f} % numbers {length:5.1f} words {count} figures")
    everything = ["README.md", *(page for pages in parts().values() for page in pages)]
    for (first, second), count in shared_runs(everything).most_common():
        print(f"{count:4} runs: {first} and {second}")


if __name__ == "__main__":
    main()
