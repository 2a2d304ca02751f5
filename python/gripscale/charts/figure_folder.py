"""Folders of figures, drawn in this process or in another while this one computes.

matplotlib takes half a second to import and holds Python's lock as it draws. A process of its own
gets the description of each figure, which needs no matplotlib, and draws on the second core.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.charts.draw import Drawing
from gripscale.core.errors import FileError
from gripscale.io.folders import write_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class FigureFolder:
    """A folder of figures and what they are written as."""

    path: Path
    kinds: Sequence[str] = ("png",)  # out of `gripscale.charts.paper.KINDS`

    def save(self, figure: Drawing | Figure, name: str) -> None:
        """Write a figure or what describes it; `FileError` if that fails."""
        self.write(self.rendered(figure), name)

    def rendered(self, figure: Drawing | Figure) -> dict[str, bytes]:
        """Return the content of each file of a figure."""
        from gripscale.charts.paper import figure_file

        drawn = figure.on_paper() if isinstance(figure, Drawing) else figure
        return {kind: figure_file(drawn, kind) for kind in self.kinds}

    def write(self, files: Mapping[str, bytes], name: str) -> None:
        """Write the files of a figure; `FileError` if that fails."""
        for kind, content in files.items():
            write_bytes(self.path / f"{name}.{kind}", content)


class FigureProcess:
    """A folder of figures that another process draws, in the order in which they are saved."""

    def __init__(self, folder: FigureFolder) -> None:
        command = [sys.executable, "-m", "gripscale.charts"]
        pipe = subprocess.PIPE
        # of another session: Ctrl-C reaches this process alone, which ends the other
        self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, start_new_session=True)
        self._turn = threading.Lock()
        self._send(folder)

    def save(self, figure: Drawing, name: str) -> None:
        """Hand over the description of a figure; what goes wrong is raised by `close`."""
        self._send((figure, name))

    def close(self) -> None:
        """Wait for the last figure; raise `FileError` if one could not be drawn or written."""
        refusal, _ = self._process.communicate()
        if self._process.returncode:
            raise FileError(refusal.decode() or "figures could not be drawn: the process ended")

    def kill(self) -> None:
        """End the process with whatever it draws."""
        self._process.kill()
        self._process.communicate()

    def _send(self, message: object) -> None:
        pipe = self._process.stdin
        assert pipe is not None
        with self._turn, suppress(BrokenPipeError):  # `close` tells why the process ended
            pickle.dump(message, pipe, protocol=pickle.HIGHEST_PROTOCOL)
            pipe.flush()


Figures = FigureFolder | FigureProcess


@contextmanager
def figures_elsewhere(folder: FigureFolder) -> Iterator[Figures]:
    """Give a folder whose figures another process draws until the end of the block.

    Once matplotlib is imported here a process would cost more than it saves: then this one draws.
    """
    if "matplotlib.figure" in sys.modules:
        yield folder
        return
    process = FigureProcess(folder)
    try:
        yield process
    except BaseException:
        process.kill()
        raise
    process.close()
