"""What gripscale can do, one item a line (`python -m tests.golden.abilities` writes it anew).

Commands and their options, keys of a case, public names, statuses; and of the experiments what each
command writes, the variables of its results, the headings of its page, and what it may be given.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

import gripscale
from gripscale.case_file.keys import sections
from gripscale.cli import app
from gripscale.core.status import Status
from gripscale.questions.compare.ladder import LADDER

from .experiment_numbers import datasets, result_files
from .experiments import COMMANDS, Experiments, run_experiments
from .texts import texts

PICTURES = {".png", ".pdf"}


def abilities(made: Experiments) -> list[str]:
    """Return all abilities, sorted."""
    shown = texts(made)
    return sorted(
        {
            *_commands(),
            *_keys(),
            *_public_names(),
            *(f"model {member.name} ({member.group})" for member in LADDER),
            *(f"status {status}" for status in Status),
            *_written(made.folder),
            *_variables(made.folder),
            *_headings(shown),
            *_choices(shown),
        }
    )


def write_abilities(made: Experiments, path: Path) -> None:
    """Write the abilities anew."""
    path.write_text("\n".join([*abilities(made), ""]), encoding="utf-8")


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


def _written(folder: Path) -> Iterator[str]:
    """Yield figures and other files by the experiment that wrote them."""
    for path in folder.rglob("*"):
        words = path.relative_to(folder).as_posix()
        if path.is_file() and words.partition("/")[0] in COMMANDS:
            words = re.sub(r"[0-9a-f]{16,64}", "DIGEST", words).replace("/", " ", 1)
            yield f"{'figure' if path.suffix in PICTURES else 'file'} {words}"


def _variables(folder: Path) -> Iterator[str]:
    """Yield the variables of results with dimensions and unit, and the names of attributes."""
    for path in result_files(folder):
        name = path.relative_to(folder).with_suffix("").as_posix()
        for group, data in datasets(path):
            where = f"{name} {group}".strip()
            for variable, values in data.variables.items():
                unit = f" [{values.attrs['units']}]" if "units" in values.attrs else ""
                yield f"variable {where} {variable}({', '.join(map(str, values.dims))}){unit}"
            yield from (f"attribute {where} {attribute}" for attribute in data.attrs)


def _headings(shown: dict[str, str]) -> Iterator[str]:
    """Yield the chapters and sections of pages."""
    for name, text in shown.items():
        if name.startswith("page_"):
            lines = (line for line in text.splitlines() if re.match(r"#{2,3} ", line))
            yield from (f"chapter {name[5:]} {line.lstrip('# ')}" for line in lines)


def _choices(shown: dict[str, str]) -> Iterator[str]:
    """Yield what commands say they could have been given in place of what they refused."""
    for name, text in shown.items():
        if name.startswith("refused_"):
            yield f"choice {' '.join(COMMANDS[name])}: {' '.join(text.split())}"


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as workplace:
        write_abilities(run_experiments(Path(workplace)), Path(__file__).with_name("abilities.txt"))
