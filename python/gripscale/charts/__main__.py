"""Draws the figures that `gripscale.charts.figure_folder.FigureProcess` hands over."""

import pickle
import sys
from collections.abc import Iterator
from typing import Any

from gripscale.charts.figure_folder import FigureFolder
from gripscale.core.errors import GripscaleError


def messages() -> Iterator[Any]:
    """Yield what comes through standard input until it ends."""
    while True:
        try:
            yield pickle.load(sys.stdin.buffer)
        except EOFError:
            return


def draw_messages(folder: FigureFolder) -> None:
    """Draw each figure under its name."""
    for figure, name in messages():
        folder.save(figure, name)


if __name__ == "__main__":
    try:
        draw_messages(next(messages()))
    except GripscaleError as error:
        sys.stdout.write(str(error))
        sys.exit(1)
