"""The results folder: checked before the long work, and cleared of an earlier run's results.

Only files with the names of results, and copies that the saved case names, are ever removed. The
case is saved beside its results with copies of the files it names, so that the folder runs
anywhere: its text is that of the case but for the names of files, which become those of the copies.
Files too large to be copied are named where they are.
"""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import get_args

from gripscale.case_file.keys import write_schema
from gripscale.case_file.read import CaseFile, read_case_file
from gripscale.case_file.tables import CaseTables, FigureKind
from gripscale.core.errors import GripscaleError, InputError
from gripscale.io import folders
from gripscale.io.text_table import read_bytes

SAVED_CASE, INPUTS = "case.toml", "inputs"
COPIED_AT_MOST = 100e6  # bytes of all files together above which they are not copied
# A comment or a string of TOML 1.0, the longer quotes first.
_STRING = re.compile(
    r"""#[^\n]*"""
    r"""|\"{3}(?:\\.|[^\\])*?\"{3,5}|'{3}.*?'{3,5}"""
    r"""|"(?:\\.|[^"\\\n])*"|'[^'\n]*'""",
    re.DOTALL,
)
_MARK = "the file that is looked for"


@dataclass(frozen=True)
class SavedCase:
    """What is written: the text of the case, and by path in the folder the files it names."""

    text: str
    copies: Mapping[str, bytes]


def saved_case(file: CaseFile, folder: Path, case_name: str = SAVED_CASE) -> SavedCase:
    """Return `file` as it can be saved in `folder`, where nothing is touched."""
    names = list(dict.fromkeys(name for _, name in file.case.named_files()))
    paths = {name: file.resolve(name) for name in names}
    contents = {name: read_bytes(path) for name, path in paths.items()}
    if sum(map(len, contents.values())) > COPIED_AT_MOST:
        return SavedCase(renamed(file.text, {name: str(paths[name]) for name in names}), {})
    targets: dict[str, str] = {}
    earlier = saved_inputs(folder, case_name)
    for name, content in contents.items():
        taken = set(targets.values())
        targets[name] = free_target(paths[name], content, taken, folder, earlier)
    copies = {target: contents[name] for name, target in targets.items()}
    return SavedCase(renamed(file.text, targets), copies)


def saved_inputs(folder: Path, case_name: str = SAVED_CASE) -> set[str]:
    """Return the copies, by path in `folder`, that the case saved there names."""
    try:
        names = read_case_file(folder / case_name).case.named_files()
    except GripscaleError:
        return set()
    return {name for _, name in names if Path(name).parent == Path(INPUTS)}


def renamed(text: str, targets: Mapping[str, str]) -> str:
    """Return the text of a case with the files it names by other names, and nothing else changed.

    A string is the name of a file if the case would look for another file with another string.
    """
    for match in reversed(list(_STRING.finditer(text))):
        if match[0].startswith("#"):
            continue
        name = tomllib.loads(f"string = {match[0]}")["string"]
        before, after = text[: match.start()], text[match.end() :]
        if name not in targets:
            continue
        with suppress(ValueError):  # no case with another text there
            case = CaseTables.model_validate(tomllib.loads(f'{before}"{_MARK}"{after}'))
            if any(file == _MARK for _, file in case.named_files()):
                text = f"{before}{json.dumps(targets[name], ensure_ascii=False)}{after}"
    return text


def free_target(
    path: Path, content: bytes, taken: set[str], folder: Path, earlier: set[str]
) -> str:
    """Return a path in the folder for a copy, at which no file of somebody else would be lost."""

    def is_free(target: str) -> bool:
        present = folder / target
        same = present.is_file() and present.read_bytes() == content
        return target not in taken and (target in earlier or same or not present.exists())

    endings = ("" if number == 1 else f"_{number}" for number in count(1))
    targets = (f"{INPUTS}/{path.stem}{ending}{path.suffix}" for ending in endings)
    return next(filter(is_free, targets))


_FIGURES = (
    *("profile", "correlation", "texture_levels", "master_curve", "contact_and_friction"),
    "direct_contact",
)
# Figures of cases with conditions, or with sweeps at several temperatures.
AT_TIMES = ("cut_off", "heat", "superposition", "superposition_tests", "shift")
# Everything a run may write into its folder, beside copies of the files the case names.
RESULT_FILES = (
    *(SAVED_CASE, "report.html", "answer.nc", "chain.nc", "cut_off.nc"),
    *(f"figures/{name}.{kind}" for name in (*_FIGURES, *AT_TIMES) for kind in get_args(FigureKind)),
)
# What earlier versions wrote as well.
_OF_OTHER_VERSIONS = (".finished.json", "chain.txt", "dynamic.nc", "static.nc", "report.txt")
CASE_NOTE = ".case"  # the case whose results are in a folder, by its path from there


def claim(folder: Path, case: Path, *, replace: bool = False) -> None:
    """Make `folder` for the results of a case file and note that they are its.

    Raises `FileError` if the folder cannot be written, `InputError` if it holds results of another
    case and they are not to be replaced.
    """
    folders.require_writable(folder)
    note, name = folder / CASE_NOTE, folders.path_between(folder, case)
    other = note.read_text(encoding="utf-8").strip() if note.is_file() else name
    if other != name and not replace:
        raise InputError(
            f"{folder} holds the results of another case, {Path(os.path.normpath(folder / other))}"
            "; --output DIR keeps both, --replace replaces them"
        )
    folders.make_folder(folder)
    folders.write_text(note, f"{name}\n")


def prepare(folder: Path, file: CaseFile) -> None:
    """Make `folder`, remove what an earlier run left, and save the case in it.

    Predictions stay: each is found by all it depends on.
    """
    saved = saved_case(file, folder)
    folders.make_folder(folder)
    try:
        earlier = {*RESULT_FILES, *_OF_OTHER_VERSIONS, *saved_inputs(folder)}
        for name in earlier - {*saved.copies, SAVED_CASE}:
            (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise folders.unwritable(folder, error) from error
    write_saved(saved, folder)


def save_case(file: CaseFile, folder: Path) -> None:
    """Save the case in `folder` with copies of its files, so that it runs from there."""
    write_saved(saved_case(file, folder), folder)


def write_saved(saved: SavedCase, folder: Path, case_name: str = SAVED_CASE) -> None:
    """Write the case and its copies; raise `FileError` if that fails."""
    folders.make_folder(folder / INPUTS if saved.copies else folder)
    for target, content in saved.copies.items():
        folders.write_bytes(folder / target, content)
    write_schema(saved.text, folder)
    folders.write_text(folder / case_name, saved.text)
