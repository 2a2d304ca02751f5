"""Names follow the table of words in CONTRIBUTING."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import gripscale

CONTRIBUTING = Path(__file__).parents[2] / "CONTRIBUTING.md"
PACKAGE = Path(gripscale.__file__).parent


def refused_names() -> set[str]:
    text = CONTRIBUTING.read_text(encoding="utf-8")
    sentence = re.search(r"These words are never a name[^:]*: (.*?)\.\n", text, re.DOTALL)
    assert sentence is not None
    return set(re.findall(r"`(\w+)`", sentence[1]))


def names(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Yield every name that a module gives: definitions, arguments and variables."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.name, node.lineno
        elif isinstance(node, ast.arg):
            yield node.arg, node.lineno
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id, node.lineno


def test_the_sentence_lists_the_words() -> None:
    assert {"one", "found", "told"} <= refused_names()


def test_no_pronoun_or_participle_is_a_name() -> None:
    refused = refused_names()
    bad = [
        f"{path.relative_to(PACKAGE)}:{line} {name}"
        for path in sorted(PACKAGE.rglob("*.py"))
        for name, line in names(ast.parse(path.read_text(encoding="utf-8")))
        if name in refused
    ]
    assert not bad
