"""How far a run is, by what its process prints.

How many predictions and waves there are is known; how many passes rubber and contact need until
they agree, and how long direct contact, effects and figures take after the waves, is not.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

WAVE = re.compile(r" +wave (\d+) of (\d+):")
PASS = re.compile(r" +pass (\d+)$")
AGREED = re.compile(r" +rubber and contact (agree|do not agree)\b")


@dataclass(frozen=True)
class Progress:
    """The wave that was solved last, of which pass of which prediction."""

    predictions: int
    """How many the run was asked for."""
    passing: bool
    """Whether a prediction is solved in passes."""
    prediction: int = 0
    """Number of it, from 1; 0 before the first wave."""
    passes: int = 0
    """Of this prediction, begun so far."""
    wave: int = 0
    waves: int = 0
    settled: bool = False
    """Whether the passes of this prediction have ended."""

    def after(self, line: str) -> Progress:
        """Return how far the run is once it printed `line`, too."""
        if PASS.match(line):
            return replace(self, passes=self.passes + 1, wave=0)
        if AGREED.match(line):
            return replace(self, settled=True)
        found = WAVE.match(line)
        if found is None:
            return self
        wave, waves = int(found[1]), int(found[2])
        if (wave == 1 and self.wave > 0) or self.prediction == 0:  # and no pass was begun
            number = self.prediction + 1
            return Progress(self.predictions, self.passing, number, 1, wave, waves)
        return replace(self, wave=wave, waves=waves)

    @property
    def solved(self) -> bool:
        """Whether all waves of all predictions are solved."""
        ended = self.settled or not self.passing
        return ended and 0 < self.waves == self.wave and self.prediction == self.predictions

    @property
    def share(self) -> float | None:
        """Of the waves that are solved, from 0 to 1; None where it is not known what is left."""
        if self.passing or self.solved:
            return None
        before = max(self.prediction - 1, 0)
        return (before + (self.wave / self.waves if self.waves else 0.0)) / self.predictions

    @property
    def words(self) -> str:
        """How far the run is, in words."""
        return ", ".join(self._parts())

    def _parts(self) -> Iterator[str]:
        if not self.waves:
            yield "reading and fitting"
            return
        if self.solved:
            yield "all waves are solved; direct contact, effects and figures follow"
            return
        if self.predictions > 1:
            yield f"prediction {self.prediction} of {self.predictions}"
        if self.passing:
            yield f"pass {self.passes} until rubber and contact agree"
        yield f"wave {self.wave} of {self.waves}"


def progress_of(said: str, predictions: int, *, passing: bool) -> Progress:
    """Return how far a run is that printed `said`."""
    progress = Progress(predictions, passing)
    for line in said.splitlines():
        progress = progress.after(line)
    return progress
