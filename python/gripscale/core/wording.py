"""Sentences that name keys of a case: Python and the command line word a key in their own way.

    Words("the heights have no unit; give ", CaseKey("z_unit"))

is a text that names the key as Python and a case file do, `z_unit`; the command line words the same
sentence with its option, `--z-unit`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self


@dataclass(frozen=True)
class CaseKey:
    """A key of a case, which is also an argument in Python, perhaps with a value."""

    name: str
    value: str = ""

    def __str__(self) -> str:
        return f'{self.name} = "{self.value}"' if self.value else self.name

    @property
    def option(self) -> str:
        """The key as an option of the command line."""
        return f"--{self.name.replace('_', '-')} {self.value}".rstrip()


class Words(str):
    """A text of parts, some of which are keys of a case."""

    parts: tuple[str | CaseKey, ...]

    def __new__(cls, *parts: str | CaseKey) -> Self:
        """Join the parts; those of parts that are `Words` themselves count."""
        words = super().__new__(cls, "".join(map(str, parts)))
        words.parts = tuple(
            inner for part in parts for inner in (part.parts if isinstance(part, Words) else [part])
        )
        return words

    def __getnewargs__(self) -> tuple[Any, ...]:
        return self.parts

    def with_keys(self, word: Callable[[CaseKey], str]) -> str:
        """Return the text with `word` of each key in place of its name."""
        return "".join(word(part) if isinstance(part, CaseKey) else part for part in self.parts)


def short_repr(value: Any) -> str:
    """Return a value as a message shows it: on one line of at most 80 characters."""
    if isinstance(value, int) and abs(value) >= 10**80:
        return "a whole number of more than 80 digits"
    if getattr(value, "shape", ()):
        return f"an array of shape {value.shape}"
    try:
        return shortened(" ".join(repr(value).split()), 80)
    except ValueError:
        return "whole numbers too long to print"


def shortened(text: str, most: int = 120) -> str:
    """Return text of a file as a message quotes it: printable, at most `most` characters."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in text)
    return plain if len(plain) <= most else f"{plain[: most - 3]}..."
