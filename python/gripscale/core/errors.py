"""The errors gripscale raises on purpose; each message names the value and what was expected."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gripscale.core.wording import CaseKey, Words


class GripscaleError(Exception):
    """Base of every error gripscale raises on purpose."""

    see = ""
    """A chapter of the documentation or a command that explains it, or empty."""
    table = ""
    """Table of a case whose keys it is about, such as "conditions.heat", or empty."""

    def __init__(self, message: str = "", *, missing: str = "", key: str = "") -> None:
        self.words = Words(CaseKey(key), message) if key else Words(message)
        """The message, which may name keys of a case."""
        super().__init__(str(self.words))
        self.missing = missing
        """The key of a case, or argument of a reader, that was not stated and is needed."""
        self.choices: tuple[str | int, ...] = ()
        """Values that the missing key may have, where a file tells them."""
        self.key = key
        """Argument or key that the message is about, which then begins with it; or empty."""


class InputError(GripscaleError, ValueError):
    """A value that cannot be used; the message names it, its place and what was expected."""


class ExtrapolationError(InputError):
    """A wave excites the rubber beyond its measured band while extrapolation is refused."""

    see = "docs/reading-results.md#beyond-the-measured-band"


class FileError(GripscaleError, OSError):
    """A file that cannot be found, read, understood or written; the message names the path."""


class ConvergenceError(GripscaleError):
    """A wave has no trustworthy solution, so nothing after it may use its result."""


class RubberWarning(UserWarning):
    """A rubber with values that no rubber has, or a fit that leaves them open."""


def unstated(
    before: str, key: str, after: str = "", *, kind: type[FileError] | type[InputError] = InputError
) -> FileError | InputError:
    """Return the error of a missing `key` of a case or a reader, named between two texts."""
    return kind(Words(before, CaseKey(key), after), missing=key)


@contextmanager
def using_extra(
    extra: str, user: str, *libraries: str, kind: type[FileError] | type[InputError] = InputError
) -> Iterator[None]:
    """Say in one sentence which of the libraries of an extra of the package its user lacks."""
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in libraries:
            raise
        raise kind(
            f"{user} needs {error.name}, which is not installed; "
            f"install it with: pip install 'gripscale[{extra}]'"
        ) from error


@contextmanager
def about_keys(table: str) -> Iterator[None]:
    """Let errors refer to the keys of a table of the case, unless they refer to something else."""
    try:
        yield
    except GripscaleError as error:
        error.see = error.see or f"`{f'gripscale keys {table}'.strip()}`"
        error.table = error.table or table
        raise


@contextmanager
def about_file(
    path: Path | str, kind: type[FileError] | type[InputError] = FileError
) -> Iterator[None]:
    """Name the file in an `InputError` about values read from it, raised as a `FileError`.

    Or as an `InputError`, where they meet values of the caller, which may be wrong as well.
    """
    try:
        yield
    except InputError as error:
        located = kind(Words(f"{path}: ", error.words), missing=error.missing)
        located.see, located.table, located.choices = error.see, error.table, error.choices
        raise located from error
