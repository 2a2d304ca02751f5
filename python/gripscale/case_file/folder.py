"""The results folder: checked before the long work, and cleared of an earlier run's results.

Only files with the names of results, and copies that the saved case names, are ever removed. The
case is saved beside its results with copies of the files it names, so that the folder runs
anywhere: its text is that of the case but for the names of files, which become those of the copies.
Files too large to be copied are named where they are.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import time
import tomllib
from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import get_args

from gripscale.case_file.json_schema import write_schema
from gripscale.case_file.read import CaseFile, read_case_file
from gripscale.case_file.tables import CaseTables, FigureKind
from gripscale.core.errors import GripscaleError, InputError
from gripscale.core.provenance import versions, whole_package
from gripscale.io.folders import (
    make_folder,
    path_between,
    require_writable,
    unwritable,
    write_bytes,
    write_text,
)
from gripscale.io.netcdf import write_whole
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
    *("summary", "direct_contact"),
)
# Figures of cases with conditions, or with sweeps at several temperatures.
AT_TIMES = ("cut_off", "heat", "superposition", "superposition_tests", "shift")
# What a finished run was made from and the files it left, so that it need not be repeated.
NOTE = ".finished.json"
REPORT_PAGE = "report.html"
# Everything a run may write into its folder, beside copies of the files the case names.
RESULT_FILES = (
    *(NOTE, SAVED_CASE, REPORT_PAGE, "report.txt", "chain.txt"),
    *("dynamic.nc", "static.nc", "answer.nc", "cut_off.nc"),
    *(f"figures/{name}.{kind}" for name in (*_FIGURES, *AT_TIMES) for kind in get_args(FigureKind)),
)


CASE_NOTE = ".case"  # the case whose results are in a folder, by its path from there


def claim(folder: Path, case: Path, *, replace: bool = False) -> None:
    """Make `folder` for the results of a case file and note that they are its.

    Raises `FileError` if the folder cannot be written, `InputError` if it holds results of another
    case and they are not to be replaced.
    """
    require_writable(folder)
    note, name = folder / CASE_NOTE, path_between(folder, case)
    other = note.read_text(encoding="utf-8").strip() if note.is_file() else name
    if other != name and not replace:
        raise InputError(
            f"{folder} holds the results of another case, {Path(os.path.normpath(folder / other))}"
            "; --output DIR keeps both, --replace replaces them"
        )
    make_folder(folder)
    write_text(note, f"{name}\n")


def earlier_run(folder: Path, keep: Collection[str] = ()) -> str:
    """Return a sentence on what an earlier run left in `folder` but for `keep`, or nothing."""
    replaced = [name for name in RESULT_FILES if (folder / name).exists() and name not in keep]
    if not replaced:
        return ""
    newest = max((folder / name).stat().st_mtime for name in replaced)
    when = time.strftime("%Y-%m-%d %H:%M", time.localtime(newest))
    files = "1 file" if len(replaced) == 1 else f"{len(replaced)} files"
    return f"Replaces {files} of an earlier run, of {when}, in {folder}."


def prepare(folder: Path, file: CaseFile, keep: Collection[str] = ()) -> None:
    """Make `folder`, remove what an earlier run left but for `keep`, and save the case in it."""
    saved = saved_case(file, folder)
    make_folder(folder / "figures")
    try:
        for name in {*RESULT_FILES, *saved_inputs(folder)} - {*keep, *saved.copies, SAVED_CASE}:
            (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise unwritable(folder, error) from error
    write_saved(saved, folder)


def save_case(file: CaseFile, folder: Path) -> None:
    """Save the case in `folder` with copies of its files, so that it runs from there."""
    write_saved(saved_case(file, folder), folder)


def write_saved(saved: SavedCase, folder: Path, case_name: str = SAVED_CASE) -> None:
    """Write the case and its copies; raise `FileError` if that fails."""
    make_folder(folder / INPUTS if saved.copies else folder)
    for target, content in saved.copies.items():
        write_bytes(folder / target, content)
    write_schema(saved.text, folder)
    write_text(folder / case_name, saved.text)


def is_finished(file: CaseFile, folder: Path, others: tuple[Path, ...] = ()) -> bool:
    """Return whether `folder` holds all results of a case, made by this very software.

    `others` are files beside those of the case that a run shows; they may be missing. Results
    that have another size or date than the run gave them do not count.
    """
    try:
        noted = json.loads((folder / NOTE).read_text(encoding="utf-8"))
        return bool(
            noted["key"] == _key(file, others) and noted["files"] == _files(folder, noted["files"])
        )
    except (OSError, ValueError, TypeError, KeyError):
        return False


def note_finished(file: CaseFile, folder: Path, others: tuple[Path, ...] = ()) -> None:
    """Note that `folder` holds all results of a case."""
    kept = {NOTE, REPORT_PAGE}  # a page may be written anew
    present = [name for name in RESULT_FILES if name not in kept and (folder / name).is_file()]
    present += [path.relative_to(folder).as_posix() for path in folder.glob("figures/direct_*")]
    noted = json.dumps({"key": _key(file, others), "files": _files(folder, present)})
    write_whole(folder / NOTE, lambda path: path.write_text(noted, encoding="utf-8"))


def _key(file: CaseFile, others: tuple[Path, ...]) -> str:
    """Return a hash of the case, its files, the other files and the software, faces included."""
    inputs = json.dumps([whole_package(), versions(), str(file.path), file.text], sort_keys=True)
    digest = hashlib.sha256(inputs.encode())
    for _, name in file.case.named_files():
        digest.update(hashlib.sha256(read_bytes(file.resolve(name))).digest())
    for path in others:
        digest.update(path.read_bytes() if path.is_file() else b"-")
    return digest.hexdigest()


def _files(folder: Path, names: list[str]) -> dict[str, list[int]]:
    """Return size and date of the files of a folder."""
    stats = {name: (folder / name).stat() for name in names}
    return {name: [stat.st_size, stat.st_mtime_ns] for name, stat in stats.items()}
