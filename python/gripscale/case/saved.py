"""The case beside its results, with copies of the files it names: the folder runs anywhere.

Its text is that of the case but for the names of files, which become those of the copies. Files too
large to be copied are named where they are.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gripscale.case.models import Case
from gripscale.case.read import CaseFile, read_case
from gripscale.errors import GripscaleError
from gripscale.textfile import read_bytes

CASE, INPUTS = "case.toml", "inputs"
COPIED_AT_MOST = 100e6
"""Bytes of all files together above which they are not copied."""

_STRING = re.compile(
    r"""#[^\n]*"""
    r"""|\"{3}(?:\\.|[^\\])*?\"{3,5}|'{3}.*?'{3,5}"""
    r"""|"(?:\\.|[^"\\\n])*"|'[^'\n]*'""",
    re.DOTALL,
)
"""A comment or a string of TOML 1.0, the longer quotes first."""
_MARK = "the file that is looked for"


@dataclass(frozen=True)
class SavedCase:
    """What is written: the text of the case, and by path in the folder the files it names."""

    text: str
    copies: Mapping[str, bytes]


def saved_case(file: CaseFile, folder: Path) -> SavedCase:
    """Return `file` as it can be saved in `folder`, where nothing is touched.

    Raises `FileError` if a file it names cannot be read.
    """
    names = list(dict.fromkeys(name for _, name in file.case.named_files()))
    paths = {name: file.resolve(name) for name in names}
    contents = {name: read_bytes(path) for name, path in paths.items()}
    if sum(map(len, contents.values())) > COPIED_AT_MOST:
        return SavedCase(renamed(file.text, {name: str(paths[name]) for name in names}), {})
    places: dict[str, str] = {}
    own = saved_inputs(folder)
    for name, content in contents.items():
        taken = set(places.values())
        places[name] = _place(paths[name].name, content, taken, folder, own)
    copies = {place: contents[name] for name, place in places.items()}
    return SavedCase(renamed(file.text, places), copies)


def saved_inputs(folder: Path) -> set[str]:
    """Return the copies, by path in `folder`, that the case saved there names."""
    try:
        names = read_case(folder / CASE).case.named_files()
    except GripscaleError:
        return set()
    return {name for _, name in names if Path(name).parent == Path(INPUTS)}


def renamed(text: str, places: Mapping[str, str]) -> str:
    """Return the text of a case with the files it names by other names, and nothing else changed.

    A string is the name of a file if the case would look for another file with another string.
    """
    for found in reversed(list(_STRING.finditer(text))):
        if found[0].startswith("#"):
            continue
        name = tomllib.loads(f"string = {found[0]}")["string"]
        before, after = text[: found.start()], text[found.end() :]
        if name in places and _names_a_file(f'{before}"{_MARK}"{after}'):
            text = f"{before}{json.dumps(places[name], ensure_ascii=False)}{after}"
    return text


def _names_a_file(text: str) -> bool:
    """Return whether the case looks for a file by the mark put into its text."""
    try:
        case = Case.model_validate(tomllib.loads(text))
    except ValueError:
        return False
    return any(name == _MARK for _, name in case.named_files())


def _place(name: str, content: bytes, taken: set[str], folder: Path, own: set[str]) -> str:
    """Return a path in the folder for a copy, at which there is no file but its like or ours."""
    stem, suffix = Path(name).stem, Path(name).suffix
    number = 1
    while True:
        place = f"{INPUTS}/{stem}{'' if number == 1 else f'_{number}'}{suffix}"
        there = folder / place
        foreign = there.exists() and place not in own and not _holds(there, content)
        if place not in taken and not foreign:
            return place
        number += 1


def _holds(path: Path, content: bytes) -> bool:
    return path.is_file() and path.read_bytes() == content
