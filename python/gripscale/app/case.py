"""The case of one visit: its text is the one state of the page, shown and edited from all sides."""

from __future__ import annotations

import re
import secrets
import shutil
import time
import tomllib
from collections.abc import Mapping, MutableMapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PureWindowsPath
from typing import Any

import param
import tomlkit
from tomlkit.exceptions import TOMLKitError

from gripscale.case import CaseFile, folder, read_case
from gripscale.case.examples import write_example
from gripscale.case.folder import CASE, INPUTS, renamed
from gripscale.core.errors import FileError, GripscaleError, InputError

# The folder of one visit: what is dropped on the page is stored here, and nothing else is read.

MOST = 50_000_000
"""Bytes of a file that is taken."""
LONGEST = 100
"""Letters of a name that are kept."""


@dataclass(frozen=True)
class VisitFolder:
    """A folder with the case of a visit, the files it names, and its runs."""

    path: Path

    @classmethod
    def new(cls, root: Path) -> VisitFolder:
        """Make the folder of a new visit in `root`, named by the time."""
        path = root / f"{time.strftime('%Y-%m-%d_%H%M%S')}_{secrets.token_hex(4)}"
        folder.make(path / INPUTS)
        return cls(path.resolve())

    @property
    def case(self) -> Path:
        """The case file."""
        return self.path / CASE

    def store(self, name: str, content: bytes) -> str:
        """Keep a dropped file; return its name as the case states it.

        A file of the same name with another content stays, as a run may still read it.
        """
        if len(content) > MOST:
            raise InputError(
                f"{safe_name(name)} has {len(content) / 1e6:.0f} MB; "
                f"expected at most {MOST / 1e6:.0f} MB"
            )
        safe, number = Path(safe_name(name)), 1
        place = self.path / INPUTS / safe
        while place.exists() and place.read_bytes() != content:
            number += 1
            place = place.with_name(f"{safe.stem}_{number}{safe.suffix}")
        folder.write_bytes(place, content)
        return f"{INPUTS}/{place.name}"

    def require_inside(self, file: CaseFile) -> None:
        """Raise `InputError` if the case names a file outside this folder."""
        for role, name in file.case.named_files():
            if not self.holds(file, name):
                raise InputError(
                    f'{role} file "{name}" lies outside the folder of this page; '
                    "drop the file itself on the page"
                )

    def holds(self, file: CaseFile, name: str) -> bool:
        """Return whether a file that the case names lies in this folder, links followed."""
        try:
            return file.resolve(name).is_relative_to(self.path)
        except (OSError, RuntimeError, ValueError):  # a loop of links, an unknown home, a zero byte
            return False

    def short(self, words: object) -> str:
        """Return an error or a text with paths from this folder on."""
        return str(words).replace(f"{self.path}/", "").replace(f"{self.path}\\", "")

    def remove_if_unused(self) -> None:
        """Remove the folder unless something was run in it."""
        if not (self.path / "runs").exists():
            shutil.rmtree(self.path, ignore_errors=True)


def safe_name(name: str) -> str:
    """Return the last part of a path with letters, digits, dots, dashes and underscores only."""
    last = PureWindowsPath(name).name  # cuts at / and \
    plain = re.sub(r"[^\w.-]+", "_", last).lstrip(".")[-LONGEST:].lstrip(".")
    if not plain.strip("._"):
        raise InputError(f"a file named {name!r} cannot be kept; expected letters or digits in it")
    return plain


# The text of a case edited key by key: comments and everything else in it stay as they are.


def stated(text: str, path: Sequence[str]) -> Any:
    """Return what `text` states at a path such as ("load", "speed"), or None."""
    value: Any = tables(text)
    for name in path:
        value = value.get(name) if isinstance(value, dict) else None
    return value


def tables(text: str) -> dict[str, Any]:
    """Return all that `text` states; nothing of a text that is not TOML."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError):
        return {}


def with_value(text: str, path: Sequence[str], value: Any) -> str:
    """Return `text` with `value` at a path, or without the key if it is None.

    Raises `FileError` if `text` is not TOML.
    """
    try:
        document = tomlkit.parse(text)
        *parents, key = path
        table: MutableMapping[str, Any] = document
        for name in parents:
            if value is None and name not in table:
                return text
            if not isinstance(table.get(name), MutableMapping):
                table[name] = tomlkit.table()
            table = table[name]
        if value is None:
            table.pop(key, None)
        else:
            table[key] = value
        return tomlkit.dumps(document)
    except (TOMLKitError, RecursionError) as error:
        raise FileError(f"the text of the case is not valid TOML: {error}") from error


def value_of(words: str) -> Any:
    """Return what is written into a field: a value of TOML, else the words as a text.

    `0.3` is a number, `["1 mm", "2 mm"]` a list, `3 bar` a text; nothing is None.
    """
    plain = words.strip()
    if not plain:
        return None
    try:
        return tomllib.loads(f"value = {plain}")["value"] if "\n" not in plain else plain
    except (ValueError, RecursionError):
        return plain


def words_of(value: Any) -> str:
    """Return how a field shows a value: texts without quotes, all else as TOML writes it."""
    if value is None:
        return ""
    if not isinstance(value, str):
        return _inline(value)
    return value if value_of(value) == value else _inline(value)


def _inline(value: Any) -> str:
    """Return `value` as TOML on one line."""
    if isinstance(value, dict):
        pairs = ", ".join(f"{tomlkit.key(k).as_string()} = {_inline(v)}" for k, v in value.items())
        return f"{{ {pairs} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    return str(tomlkit.item(value).as_string())


class CaseState(param.Parameterized):
    """Text of the case, and one sentence on what is wrong with it."""

    text: str = param.String("")  # type: ignore[assignment]
    complaint: str = param.String("")  # type: ignore[assignment]

    def __init__(self, place: VisitFolder) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.place = place

    def show(self, text: str) -> None:
        """Take `text` as the case, good or not."""
        text = text.replace("\r\n", "\n")
        folder.write_text(self.place.case, text)
        try:
            self.place.require_inside(read_case(self.place.case))
            complaint = ""
        except GripscaleError as error:
            complaint = self.place.short(error)
        self.param.update(text=text, complaint=complaint)

    def set(self, path: Sequence[str], value: Any) -> None:
        """State `value` at a path such as ("load", "speed"); None takes the key out."""
        try:
            self.show(with_value(self.text, path, value))
        except GripscaleError as error:
            self.complaint = str(error)

    def get(self, path: Sequence[str]) -> Any:
        """Return what the case states at a path, or None."""
        return stated(self.text, path)

    def file(self) -> CaseFile:
        """Return the case as it can be run; raise what is wrong with it."""
        file = read_case(self.place.case)
        self.place.require_inside(file)
        return file

    def adopt(self, path: Path) -> None:
        """Take a case of this machine, with copies of its files."""
        folder.save_case(read_case(path), self.place.path)
        self.show(self.place.case.read_text(encoding="utf-8"))

    def load_example(self, name: str) -> None:
        """Take a shipped example."""
        source = self.place.path / "examples" / name
        case = source / "case.toml"
        self.adopt(case if case.exists() else write_example(source, name)[0])

    def open(self, dropped: Mapping[str, bytes]) -> None:
        """Take a dropped case; files dropped with it stand for those of the same name in it.

        Raises `InputError` if none or several of `dropped` are cases or one is no text.
        """
        cases = [name for name in dropped if name.lower().endswith(".toml")]
        if len(cases) != 1:
            raise InputError(
                f"{len(cases)} of the dropped files end in .toml; expected one case with the files "
                "it names"
            )
        try:
            text = dropped[cases[0]].decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"{cases[0]} cannot be read: it is not UTF-8 text") from error
        stored = {n: self.place.store(n, c) for n, c in dropped.items() if n not in cases}
        self.show(text)
        self.show(renamed(text, _places(self.place.case, stored)))


def _places(case: Path, stored: Mapping[str, str]) -> dict[str, str]:
    """Return, by the name in the case, where dropped files of that name lie."""
    try:
        names = [name for _, name in read_case(case).case.named_files()]
    except GripscaleError:
        return {}
    last = {name: name.replace("\\", "/").rpartition("/")[2] for name in names}
    return {name: stored[last[name]] for name in names if last[name] in stored}
