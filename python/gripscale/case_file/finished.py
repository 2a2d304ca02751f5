"""A finished run: what it was made from and the files it left, so that it need not be repeated."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from gripscale.case_file.folder import NOTE, RESULT_FILES
from gripscale.case_file.read import CaseFile
from gripscale.core.provenance import versions, whole_package
from gripscale.io.netcdf import write_whole
from gripscale.io.text_table import read_bytes


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


def case_replaced(file: CaseFile, folder: Path) -> str:
    """Return the name of the case whose finished results are in `folder`, if it is another."""
    try:
        name = str(json.loads((folder / NOTE).read_text(encoding="utf-8"))["case"])
    except (OSError, ValueError, TypeError, KeyError):
        return ""
    return "" if name == file.path.name else name


def note_finished(file: CaseFile, folder: Path, others: tuple[Path, ...] = ()) -> None:
    """Note that `folder` holds all results of a case."""
    present = [name for name in RESULT_FILES if name != NOTE and (folder / name).is_file()]
    present += [path.relative_to(folder).as_posix() for path in folder.glob("figures/direct_*")]
    files = _files(folder, present)
    noted = {"key": _key(file, others), "files": files, "case": file.path.name}
    write_whole(folder / NOTE, lambda path: path.write_text(json.dumps(noted), encoding="utf-8"))


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
