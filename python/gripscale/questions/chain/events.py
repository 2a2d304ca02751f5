"""What happens while a case runs, as data: one event for each step, one line of JSON an event.

`run_case` reports to its caller by these events and nothing else. `gripscale run` prints them as
sentences; with `--progress json` it writes each as a line for another program, such as

    {"event": "WaveSolved", "prediction": "dynamic", "number": 1, "count": 4, ...}

All numbers are in SI units; NaN and infinity are `null`. A reader ignores events it does not know.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from gripscale.chain.prediction import ChainResult

PASSES = "passes"  # detail of the waves of a prediction whose rubber and contact were iterated


class Event:
    """What happens while a case runs."""


@dataclass(frozen=True)
class RunStarted(Event):
    """The inputs of the case are read and fitted; the waves follow."""

    predictions: tuple[str, ...]  # names of the predictions the case asks for, in order
    waves: int  # waves of each prediction
    iterated: bool  # whether rubber and contact are solved in passes until they agree


@dataclass(frozen=True)
class ResultsReplaced(Event):
    """Results of an earlier run are about to be replaced."""

    message: str  # what is replaced, in a sentence


@dataclass(frozen=True)
class WaveSolved(Event):
    """One more wave of a prediction is solved."""

    prediction: str
    # Pass of the prediction, from 1; more than one where rubber and contact are iterated.
    pass_number: int
    number: int  # number of the wave, from 1
    count: int  # waves of the prediction
    wavelength: float  # [m]
    speed: float  # sliding speed [m/s]; zero at rest
    contact_fraction: float
    friction: float
    status: str
    message: str  # the status in words
    seconds: float  # time it took to solve [s]
    stored: bool  # whether an earlier run of the same case solved it
    # The prediction down to this wave; not in the line of JSON.
    so_far: ChainResult | None = field(default=None, repr=False, compare=False)

    @classmethod
    def last_of(
        cls, so_far: ChainResult, prediction: str, pass_number: int, seconds: float, *, stored: bool
    ) -> WaveSolved:
        """Return the event of the last wave of a prediction."""
        wave = so_far.scales[-1]
        names = ("wavelength", "speed", "contact_fraction", "friction", "status")
        values = {name: getattr(wave, name) for name in names}
        values |= {"message": wave.why, "seconds": seconds, "stored": stored, "so_far": so_far}
        return cls(prediction, pass_number, len(so_far.scales), so_far.planned, **values)


@dataclass(frozen=True)
class PredictionFinished(Event):
    """A prediction is complete, or ended at a wave without solution."""

    prediction: str
    converged: bool
    message: str  # `converged`, or why it is not
    passes: int | None  # passes until rubber and contact agreed, where they are iterated
    contact_fraction: float
    friction: float

    @classmethod
    def of(
        cls, solved: ChainResult, prediction: str, failure: Exception | None
    ) -> PredictionFinished:
        """Return the event of a prediction, with what ended it early."""
        last = solved.scales[-1]
        passes = last.details.get(PASSES)
        return cls(
            prediction,
            converged=failure is None and last.converged,
            message=last.why if failure is None else str(failure),
            passes=None if passes is None else int(passes),
            contact_fraction=solved.contact_fraction,
            friction=solved.friction,
        )


@dataclass(frozen=True)
class AnswerSolved(Event):
    """The answer of the case is solved: friction and contact area of the measured surface."""

    converged: bool
    contact_fraction: float
    friction: float


@dataclass(frozen=True)
class FileWritten(Event):
    """A result file is complete."""

    path: str


@dataclass(frozen=True)
class RunFinished(Event):
    """The run came to its end and every prediction converged."""

    exit_code: int = 0


@dataclass(frozen=True)
class RunFailed(Event):
    """The run ended early, or a prediction did not converge."""

    message: str
    exit_code: int


OnEvent: TypeAlias = Callable[[Event], None]


def event_to_json(event: Event) -> str:
    """Return an event as one line of JSON."""
    values = {name: value for name, value in vars(event).items() if name != "so_far"}
    infinite = {k for k, v in values.items() if isinstance(v, float) and not math.isfinite(v)}
    values |= dict.fromkeys(infinite)
    return json.dumps({"event": type(event).__name__, **values}, allow_nan=False)


def event_from_json(line: str) -> Event | None:
    """Return the event of a line of JSON, or None if the line is none that this version knows."""
    kinds = {kind.__name__: kind for kind in Event.__subclasses__()}
    try:
        values = json.loads(line)
        kind = kinds[values.pop("event")]
        types = {name: of for name, of in kind.__annotations__.items() if name in values}
        for name, value in values.items():
            if isinstance(value, list):
                values[name] = tuple(value)
            elif value is None and types.get(name) == "float":
                values[name] = math.nan
        return kind(**{name: values[name] for name in types})
    except (ValueError, KeyError, AttributeError, TypeError):  # no JSON, or another event
        return None
