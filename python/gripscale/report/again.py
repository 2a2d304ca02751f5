"""How to make a result again: its case, command and software."""

from __future__ import annotations

from pathlib import PurePath
from typing import Any

from gripscale.core.provenance import CASE_TITLE, versions
from gripscale.report.elements import Code, Element, Facts, Section, Text

_KEY = "prediction_key"


def case_name(attrs: dict[Any, Any]) -> str:
    """Return the file name of the case of a result; empty where it is not known."""
    return PurePath(str(attrs.get("case_file", ""))).name


def case_title(attrs: dict[Any, Any]) -> str:
    """Return rubber and surface of a result in words, or what its case is called."""
    return str(attrs.get(CASE_TITLE, "")) or case_name(attrs) or "a case"


def rerun_section(attrs: dict[object, object]) -> Section:
    """Return versions, and the command that made the result with its case file."""
    names = sorted(str(name) for name in attrs if str(name).startswith("version_"))
    solved = [(name.removeprefix("version_"), str(attrs[name])) for name in names]
    solved += [("Key of the result", str(attrs[_KEY]))] if _KEY in attrs else []
    here = ", ".join(f"{name} {version}" for name, version in versions().items())
    elements: list[Element] = [Facts("Solved with", [*solved, ("This page written by", here)])]
    if "case" in attrs:
        name = case_name(attrs) or "case.toml"
        elements += [
            Text(
                f"Save the text below as {name}. Paths of files start at its folder. The inputs "
                "list their checksums."
            ),
            *([Code("command", "Command", str(attrs["command"]))] if "command" in attrs else []),
            Code("case", f"Case file {name}", str(attrs["case"])),
        ]
    return Section("again", "Software, and how to run it again", elements)
