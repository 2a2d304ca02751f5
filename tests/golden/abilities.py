"""What gripscale can do, one item a line (`python -m tests.golden.abilities` writes it anew).

Commands and their options, keys of a case, public names, models, statuses.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

import gripscale
from gripscale.case_file.keys import sections
from gripscale.cli import app
from gripscale.core.status import Status
from gripscale.questions.compare.ladder import LADDER

FILE = Path(__file__).with_name("abilities.txt")


def abilities() -> list[str]:
    """Return all abilities, sorted."""
    return sorted(
        {
            *_commands(),
            *_keys(),
            *_public_names(),
            *(f"model {member.name} ({member.group})" for member in LADDER),
            *(f"status {status}" for status in Status),
        }
    )


def _commands(group: Any = None, before: str = "") -> Iterator[str]:
    """Yield commands, their arguments and options."""
    group = typer.main.get_command(app) if group is None else group
    for name, command in group.commands.items():
        words = f"{before}{name}"
        yield f"command {words}"
        for parameter in command.params:
            if parameter.param_type_name == "argument":
                yield f"argument {words} {parameter.name}"
            else:
                options = (*parameter.opts, *parameter.secondary_opts)
                yield from (f"option {words} {option}" for option in options)
        if hasattr(command, "commands"):
            yield from _commands(command, f"{words} ")


def _keys() -> Iterator[str]:
    """Yield the keys of a case, with what they take and their defaults."""
    for section in sections():
        kind = f" {section.kind}" if section.kind else ""
        for key in section.keys:
            yield f"key {section.name}{kind} {key.name}: {key.takes}; default {key.default}"


def _public_names() -> Iterator[str]:
    """Yield what the package and its public parts offer, and which of that are models."""
    parts = ["gripscale"] + [
        f"gripscale.{found.name}"
        for found in pkgutil.iter_modules(gripscale.__path__)
        if not found.name.startswith("_")
    ]
    for part in parts:
        if part == "gripscale.__main__":
            continue
        module = importlib.import_module(part)
        for name in getattr(module, "__all__", []):
            yield f"name {part}.{name}"
            thing = getattr(module, name)
            if inspect.isclass(thing) and callable(getattr(thing, "predict", None)):
                yield f"model {part}.{name}: {getattr(thing, 'name', '')}"


if __name__ == "__main__":
    FILE.write_text("\n".join([*abilities(), ""]), encoding="utf-8")
