"""One run: `gripscale run` in a process of its own, which writes wave by wave into a folder.

To stop it is to end the process and all it started; the waves it finished stay, and a run of the
same case goes on from them.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gripscale.app.progress import Progress, progress_of

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
