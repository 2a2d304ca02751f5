"""One run: `gripscale run` in a process of its own, which writes wave by wave into a folder.

To stop it is to end the process and all it started; the waves it finished stay, and a run of the
same case goes on from them.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import param

from gripscale.app.case import CaseState
from gripscale.case import CaseFile, folder
from gripscale.case.results import planned
from gripscale.core.errors import InputError

# How far a run is, by what its process prints.
#
# How many predictions and waves there are is known; how many passes rubber and contact need until
# they agree, and how long direct contact, effects and figures take after the waves, is not.

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


GRACE = 5.0
"""Seconds a process has to end before it is killed."""


@dataclass
class Run:
    """A process, its folder, and the text of the case it runs."""

    name: str
    case: Path
    folder: Path
    text: str
    predictions: int = 1
    """How many the case asks for."""
    passing: bool = False
    """Whether rubber and contact are solved in passes until they agree."""
    stopped: bool = field(default=False, init=False)
    _process: Any = field(default=None, init=False, repr=False)

    def start(self) -> None:
        """Start the process; what it says goes into files beside the results."""
        atexit.register(self.stop)
        self.folder.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-m", "gripscale", "run", self.case.name]
        own_group: dict[str, Any] = {"start_new_session": True} if os.name == "posix" else {}
        with self._log("out").open("wb") as out, self._log("err").open("wb") as err:
            self._process = subprocess.Popen(
                [*command, "--output", str(self.folder)],
                cwd=self.case.parent,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                env=os.environ | {"PYTHONUNBUFFERED": "1", "COLUMNS": "110"},
                **own_group,
            )

    @property
    def pid(self) -> int:
        """Number of the process."""
        return int(self._process.pid)

    @property
    def going(self) -> bool:
        """Whether the process is still there."""
        return self._process is not None and self._process.poll() is None

    @property
    def state(self) -> str:
        """How it stands, in a word."""
        if self.going:
            return "running"
        if self.stopped:
            return "stopped"
        return (
            "finished" if self._process is not None and self._process.returncode == 0 else "failed"
        )

    def stop(self) -> None:
        """End the process and what it started."""
        if not self.going:
            return
        self.stopped = True
        self._end(signal.SIGTERM)
        try:
            self._process.wait(GRACE)
        except subprocess.TimeoutExpired:
            self._end(signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
            self._process.wait()

    def _end(self, how: signal.Signals) -> None:
        if os.name == "posix":
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.pid, how)
        else:
            self._process.terminate()

    def said(self) -> str:
        """Return what the process printed so far."""
        return self._read("out")

    def complaint(self) -> str:
        """Return the last sentence of what went wrong, or nothing."""
        lines = [line for line in self._read("err").splitlines() if line.strip()]
        errors = [line for line in lines if line.startswith("error: ")]
        last = errors[-1:] or (lines[-1:] if self.state == "failed" else [])
        return last[0].removeprefix("error: ") if last else ""

    def progress(self) -> Progress:
        """Return how far it is."""
        return progress_of(self.said(), self.predictions, passing=self.passing)

    def _log(self, name: str) -> Path:
        return self.folder.with_name(f"{self.folder.name}.{name}.txt")

    def _read(self, name: str) -> str:
        path = self._log(name)
        return path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""


# The runs of one visit.


class Runs(param.Parameterized):
    """All runs in order; `changes` counts whenever one starts or ends."""

    changes: int = param.Integer(0)  # type: ignore[assignment]

    def __init__(self, state: CaseState) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._state = state
        self.all: list[Run] = []

    @property
    def going(self) -> Run | None:
        """The run whose process is there."""
        return next((run for run in self.all if run.going), None)

    def start(self) -> Run:
        """Run the case as it is now; a stopped run of the same text goes on.

        Raises what is wrong with the case, and `InputError` while another run is going.
        """
        if self.going is not None:
            raise InputError(f"{self.going.name} is still going; stop it or wait for its end")
        file = self._state.file()
        text = file.text
        run = next((one for one in self.all if one.stopped and one.text == text), None)
        if run is None:
            run = self._new(file)
            self.all.append(run)
        run.stopped = False
        run.start()
        self.changes += 1
        return run

    def stop(self) -> None:
        """End whatever is going."""
        for run in self.all:
            run.stop()
        self.changes += 1

    def _new(self, file: CaseFile) -> Run:
        """Return a run of a case, saved beside the files it names."""
        name = f"run-{len(self.all) + 1}"
        place = self._state.place.path
        case = folder.write_text(place / f"{name}.toml", file.text)
        return Run(
            name,
            case,
            place / "runs" / name,
            file.text,
            predictions=len(list(planned(file.case.load))),
            passing=file.case.conditions.iterated,
        )
