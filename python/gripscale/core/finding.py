"""A finding: what a reader must know about a result, carried as data and ranked once."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import IntEnum, StrEnum
from typing import ClassVar

from gripscale.core.wording import CaseKey, Words


class Severity(StrEnum):
    """How much a finding weighs."""

    ERROR = "error"
    """There are no numbers to be used."""
    DOUBT = "doubt"
    """The numbers may be those of another road, rubber or load."""
    WARNING = "warning"
    """The numbers may change."""
    GOOD = "good"
    """The numbers passed a check."""


class Topic(IntEnum):
    """What a finding is about; findings without a known effect stand in this order."""

    MEASURED = -1
    """Measured friction beside the answer: it judges the answer, and stands first."""
    SOLUTION = 0
    LOAD = 1
    RUBBER = 2
    SURFACE = 3
    SOURCE = 4


FILLED = "rubber.filled"  # key of the finding that nothing states whether a rubber is filled


@dataclass(frozen=True)
class Finding:
    """Something that may change a result, or leaves none."""

    severity: str
    """One of `Severity`."""
    sentence: str
    friction: float = field(default=math.nan, compare=False)
    """Relative change of the friction that it may cause [-]; NaN if that is not known."""
    area: float = field(default=math.nan, compare=False)
    """Relative change of the contact area that it may cause [-]."""
    topic: Topic = Topic.SOLUTION
    key: str = ""
    """Key of a case that cures it, such as "rubber.reference_temperature"; empty if none does."""
    kind: ClassVar[str] = "notice"
    """Element of a page that shows it."""

    def __str__(self) -> str:
        return self.sentence

    def about(self, name: str) -> Finding:
        """Return the finding with the name of what it is about before its sentence."""
        return replace(self, sentence=Words(f"{name}: ", self.sentence)) if name else self

    @property
    def effect(self) -> float:
        """The larger of its relative changes [-]; infinite for a doubt, 0 if neither is known."""
        if self.severity == Severity.DOUBT:
            return math.inf
        changes = (abs(change) for change in (self.friction, self.area) if not math.isnan(change))
        return max(changes, default=0.0)

    def exceeds(self, widths: Mapping[str, float]) -> bool:
        """Whether it may change `friction` or `area` by more than its relative half width [-].

        An unknown width is none; a finding without a known effect exceeds no known one.
        """
        if self.effect == math.inf or self.severity == Severity.ERROR:
            return True
        changes = {"friction": self.friction, "area": self.area}
        return not widths or any(abs(changes[name]) > width for name, width in widths.items())


def ranked(findings: Iterable[Finding]) -> list[Finding]:
    """Return measurements and errors first, then by effect, then those without a known effect."""

    def rank(finding: Finding) -> tuple[bool, bool, float, Topic]:
        measured, error = finding.topic == Topic.MEASURED, finding.severity == Severity.ERROR
        return not measured, not error, -finding.effect, finding.topic

    return sorted(findings, key=rank)


def doubt(*parts: str | CaseKey, topic: Topic = Topic.SOURCE) -> Finding:
    """Return a doubt, whose sentence may name keys of a case."""
    return Finding(Severity.DOUBT, Words(*parts), topic=topic)


def sentences(findings: Iterable[Finding]) -> str:
    """Return the sentences of findings as one text."""
    return " ".join(finding.sentence for finding in findings)


def to_json(findings: Iterable[Finding]) -> str:
    """Return findings as the text of an attribute of a result."""
    return json.dumps([asdict(finding) for finding in findings], ensure_ascii=False)


def from_json(text: str) -> Sequence[Finding]:
    """Return the findings of `to_json`; none of an empty text."""
    entries = json.loads(text) if text else []
    return [Finding(**{**entry, "topic": Topic(entry["topic"])}) for entry in entries]
