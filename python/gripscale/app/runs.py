"""Runs of one visit: each is a `gripscale` command in its own process, which writes into a folder.

Each process writes its text to a file beside the results. Stopping a run ends the process and all
it started; what it finished stays.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import param

from gripscale.app.case import CaseState
from gripscale.core.errors import FileError, InputError
from gripscale.io.folders import write_text
from gripscale.questions.registry import Form, forms
from gripscale.questions.terminal import PROGRESS_LINES

COMMANDS = (Form("run", "Contact and friction", "The case as it is stated."), *forms())
REPORT = "report.html"  # the page of a result in its folder, as `gripscale report` names it
GRACE = 5.0  # seconds a process has to end before it is killed


@dataclass
class AppRun:
    """A process, its folder, and command and text of the case it runs."""

    name: str
    case: Path
    folder: Path
    text: str
    command: Form = COMMANDS[0]
    arguments: tuple[str, ...] = ()
    stopped: bool = field(default=False, init=False)
    _process: Any = field(default=None, init=False, repr=False)

    def start(self) -> None:
        """Start the process; its text goes into a file beside the results."""
        atexit.register(self.stop)
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / REPORT).unlink(missing_ok=True)
        command = [sys.executable, "-m", "gripscale", *self.words]
        process_group: dict[str, Any] = {"start_new_session": True} if os.name == "posix" else {}
        with self._log_file.open("wb") as log:
            self._process = subprocess.Popen(
                [*command, "--output", str(self.folder)],
                cwd=self.case.parent,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=os.environ | {"PYTHONUNBUFFERED": "1", "COLUMNS": "110", PROGRESS_LINES: "1"},
                **process_group,
            )

    @property
    def words(self) -> list[str]:
        """The command and its arguments, from the folder of the visit."""
        return [self.command.command, self.case.name, *self.arguments]

    @property
    def asked(self) -> tuple[str, ...]:
        """What it answers: the command, its arguments and the text of the case."""
        return (self.command.title, *self.arguments, self.text)

    def page(self) -> Path:
        """Return the page that the command wrote; raise `FileError` if it wrote none."""
        page = self.folder / REPORT
        if not page.is_file():
            ended = "it was stopped" if self.stopped else "it wrote none"
            raise FileError(self.failure() or ended)
        return page

    @property
    def pid(self) -> int:
        """Number of the process."""
        return int(self._process.pid)

    @property
    def running(self) -> bool:
        """Whether the process exists."""
        return self._process is not None and self._process.poll() is None

    @property
    def state(self) -> str:
        """State in a word: running, stopped, finished or failed."""
        if self.running:
            return "running"
        if self.stopped:
            return "stopped"
        finished = self._process is not None and self._process.returncode == 0
        return "finished" if finished else "failed"

    def stop(self) -> None:
        """End the process and all it started."""
        if not self.running:
            return
        self.stopped = True
        self._end(signal.SIGTERM)
        try:
            self._process.wait(GRACE)
        except subprocess.TimeoutExpired:
            self._end(signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
            self._process.wait()

    def _end(self, end_signal: signal.Signals) -> None:
        if os.name == "posix":
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.pid, end_signal)
        else:
            self._process.terminate()

    @property
    def _log_file(self) -> Path:
        return self.folder.with_name(f"{self.folder.name}.log.txt")

    def log(self) -> str:
        """Return the text the process printed so far."""
        if not self._log_file.exists():
            return ""
        return self._log_file.read_text(encoding="utf-8", errors="replace")

    def failure(self) -> str:
        """Return the sentence the process failed with; its last line if it broke off."""
        return self.how_far().removeprefix("error: ") if self.state == "failed" else ""

    def how_far(self) -> str:
        """Return what the process printed last."""
        return self.log().rstrip().rpartition("\n")[2].strip() or "starting"


class Runs(param.Parameterized):
    """All runs of a visit in order; `changes` counts whenever one starts or ends."""

    changes: int = param.Integer(0)  # type: ignore[assignment]

    def __init__(self, state: CaseState) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._state = state
        self.all: list[AppRun] = []

    @property
    def running(self) -> AppRun | None:
        """The run whose process exists."""
        return next((run for run in self.all if run.running), None)

    def start(
        self,
        command: Form = COMMANDS[0],
        values: Mapping[str, str] = MappingProxyType({}),
        others: Sequence[str] = (),
    ) -> AppRun:
        """Run a command on the case as it is now, with the values of its options by their labels.

        `others` are files of the visit beside the case, or names that gripscale knows. A finished
        run of the same is not repeated, a stopped one continues. Raises what is wrong with the case
        or with a name, and `InputError` while another run is running.
        """
        if self.running is not None:
            raise InputError(f"{self.running.name} is still running; stop it or wait for its end")
        file = self._state.file()
        if command.others and not others:
            raise InputError(f"{command.title}: expected other {command.others}; got none")
        for name in others:
            self._state.visit.require_name_inside(name, command.others)
        number, path = len(self.all) + 1, self._state.visit.path
        name, case = f"run-{number}", path / f"case-{number}.toml"
        arguments = tuple(command.arguments(values, others))
        run = AppRun(name, case, path / "runs" / name, file.text, command, arguments)
        earlier = [each for each in self.all if each.asked == run.asked]
        if earlier and earlier[-1].state in ("finished", "stopped"):
            run = earlier[-1]
        else:
            write_text(run.case, file.text)
            self.all.append(run)
        if run.state != "finished":
            run.stopped = False
            run.start()
        self.changes += 1
        return run

    def stop(self) -> None:
        """End whatever is running."""
        for run in self.all:
            run.stop()
        self.changes += 1
