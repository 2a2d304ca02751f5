"""What has no numbers to be used, with what to do about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gripscale.core.status import Status
from gripscale.model import STATUS, status_words

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Failure:
    """A prediction, or a part of one, without numbers to be used."""

    sentence: str
    word: str = ""  # of its `Status`; empty if there is none

    @property
    def status(self) -> Status | None:
        """Its status, None if there is none."""
        return Status(self.word) if self.word in FAILURES else None

    def __str__(self) -> str:
        return self.sentence


FAILURES = set(Status) - {Status.CONVERGED}  # statuses that say why there are no numbers


def failures_in(data: xr.Dataset, name: str = STATUS) -> list[Failure]:
    """Return each status of a result that is not `converged`, in the order of its places."""
    pairs = zip(data[name].values.ravel(), status_words(data, name).values.ravel(), strict=True)
    return [Failure(str(text), str(word)) for text, word in pairs if text != Status.CONVERGED]


def explained(failure: Failure | Exception) -> str:
    """Return a failure with what to do about it, and what says more about it."""
    text = str(failure)
    status = getattr(failure, "status", None)
    see = getattr(failure, "see", "") or ("" if status is None else status.chapter)
    if not see:
        return text
    pointer = f"see {chapter_words(see)}"
    if status is None:
        return f"{text} S{pointer[1:]}" if text.endswith("?") else f"{text}; {pointer}"
    return f"{text.rstrip('.')}. {status.advice} S{pointer[1:]}"


def chapter_words(see: str) -> str:
    """Return the command that shows a chapter such as `docs/limits.md#discretisation`."""
    if see.startswith("`"):
        return see
    page, hash_sign, heading = see.removeprefix("docs/").partition("#")
    return f"`gripscale docs {page.removesuffix('.md')}{hash_sign}{heading}`"


def first_of(failed: Sequence[Failure], total: int, what: str) -> str:
    """Return how many of the `total` failed, with what to do about the first; empty if none."""
    if not failed:
        return ""
    return f"{len(failed)} of {total} {what} failed; the first: {explained(failed[0])}"
