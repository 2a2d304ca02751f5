"""What a face does for a room below it, which does not import the face.

`gripscale/__init__.py` stands above all rooms and enters functions here by name, as it does with
public names: each is imported when it is first called.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

CASE_WRITER = "write a case file"
FIGURE_PNG = "save a figure as PNG"

_functions: dict[str, str] = {}


def enter(task: str, function: str) -> None:
    """Let a function, stated as `module:name`, do a task."""
    _functions[task] = function


def face(task: str) -> Callable[..., Any]:
    """Return the function that does a task."""
    module, _, name = _functions[task].partition(":")
    return getattr(import_module(module), name)  # type: ignore[no-any-return]
