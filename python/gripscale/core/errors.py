"""The errors gripscale raises on purpose, each saying what was given and what was expected."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


class GripscaleError(Exception):
    """Base of every error gripscale raises on purpose."""

    see = ""
    """What explains it: a chapter of the documentation or a command; empty where nothing does."""


class InputError(GripscaleError, ValueError):
    """A value that cannot be used; the message names it, its place and what was expected."""


class ExtrapolationError(InputError):
    """A wave excites the rubber beyond what was measured, and extrapolation was to be refused."""

    see = "docs/reading-results.md#beyond-the-measured-band"


class FileError(GripscaleError, OSError):
    """A file that cannot be found, read, understood or written; the message names the path."""


class ConvergenceError(GripscaleError):
    """A wave has no trustworthy solution, so nothing after it may use its result."""


class RubberWarning(UserWarning):
    """A rubber made by hand that no rubber is like."""


@contextmanager
def about_keys(table: str) -> Iterator[None]:
    """Let errors say that the keys of a table of the case explain them, unless they say more."""
    try:
        yield
    except GripscaleError as error:
        error.see = error.see or f"`{f'gripscale keys {table}'.strip()}`"
        raise
