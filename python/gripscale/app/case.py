"""The case of one visit: its folder, and its text, which is the only state of the page.

Every field, tab and upload of the page changes the text of the case, and follows it. Uploads are
stored in the folder of the visit; the page reads no other file.
"""

from __future__ import annotations

import math
import re
import secrets
import shutil
import time
import tomllib
from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path, PureWindowsPath
from typing import Any

import param
import tomlkit
from tomlkit.exceptions import TOMLKitError

from gripscale.case_file import CaseFile, folder, read_case_file
from gripscale.case_file.examples import write_example
from gripscale.case_file.folder import INPUTS, SAVED_CASE, renamed
from gripscale.case_file.new import case_text, propose
from gripscale.case_file.schema import toml_text
from gripscale.core.errors import FileError, GripscaleError, InputError
from gripscale.io.folders import make_folder, write_bytes, write_text
from gripscale.io.text_table import require_numbers

MAX_UPLOAD = 50_000_000  # bytes of an uploaded file
MAX_NAME = 100  # letters of the name of an uploaded file


@dataclass(frozen=True)
class VisitFolder:
    """A folder with the case of a visit, the files it names, and its runs."""

    path: Path

    @classmethod
    def new(cls, root: Path) -> VisitFolder:
        """Make the folder of a new visit in `root`, named by the time."""
        path = root / f"{time.strftime('%Y-%m-%d_%H%M%S')}_{secrets.token_hex(4)}"
        make_folder(path / INPUTS)
        return cls(path.resolve())

    @property
    def case(self) -> Path:
        """The case file."""
        return self.path / SAVED_CASE

    def store(self, name: str, content: bytes) -> str:
        """Store an upload; return its name as the case states it.

        A file of the same name with another content stays, as a run may still read it.
        """
        safe, number = Path(safe_name(name)), 1
        if len(content) > MAX_UPLOAD:
            raise InputError(
                f"{safe} has {len(content) / 1e6:.0f} MB; expected at most "
                f"{MAX_UPLOAD / 1e6:.0f} MB"
            )
        require_numbers(safe, content)
        path = self.path / INPUTS / safe
        while path.exists() and path.read_bytes() != content:
            number += 1
            path = path.with_name(f"{safe.stem}_{number}{safe.suffix}")
        write_bytes(path, content)
        return f"{INPUTS}/{path.name}"

    def require_inside(self, file: CaseFile) -> None:
        """Raise `InputError` if the case names a file outside this folder."""
        for role, name in file.case.named_files():
            if not self._holds(partial(file.resolve, name)):
                refusal = InputError(
                    f'{role} file "{name}" lies outside the folder of this page; '
                    "drop the file itself on the page"
                )
                refusal.table = role
                raise refusal

    def require_name_inside(self, name: str, role: str) -> None:
        """Raise `InputError` if `name` is a file outside this folder; a plain word may be known."""
        if re.fullmatch(r"\w+", name):
            return
        inside = self._holds((self.path / name).resolve)
        if name.startswith(("-", "~")) or not inside:
            raise InputError(
                f'{role}: "{name}" lies outside the folder of this page; drop the file itself'
            )

    def _holds(self, resolve: Callable[[], Path]) -> bool:
        try:
            return resolve().is_relative_to(self.path)
        except (OSError, RuntimeError, ValueError):  # a loop of links, an unknown home, a NUL
            return False

    def short(self, message: object) -> str:
        """Return an error or a text with its paths relative to this folder."""
        return str(message).replace(f"{self.path}/", "").replace(f"{self.path}\\", "")

    def remove_if_unused(self) -> None:
        """Remove the folder unless something was run in it."""
        if not (self.path / "runs").exists():
            shutil.rmtree(self.path, ignore_errors=True)


def safe_name(name: str) -> str:
    """Return the last part of a path with letters, digits, dots, dashes and underscores only."""
    last = PureWindowsPath(name).name  # cuts at / and \
    plain = re.sub(r"[^\w.-]+", "_", last).lstrip(".")[-MAX_NAME:].lstrip(".")
    if not plain.strip("._"):
        raise InputError(f"a file named {name!r} cannot be kept; expected letters or digits in it")
    return plain


def case_tables(text: str) -> dict[str, Any]:
    """Return the tables of the text of a case; none if the text is not TOML."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError):
        return {}


def value_at(text: str, path: Sequence[str]) -> Any:
    """Return the value in `text` at a path such as ("load", "speed"), or None."""
    value: Any = case_tables(text)
    for name in path:
        value = value.get(name) if isinstance(value, dict) else None
    return value


def with_value(text: str, path: Sequence[str], value: Any) -> str:
    """Return `text` with `value` at a path, or without the key if it is None; comments stay."""
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


def field_value(text: str) -> Any:
    """Return the value of what is written into a field: a value of TOML, else the text itself.

    `0.3` is a number, `["1 mm", "2 mm"]` a list, `3 bar` a text; an empty field is None.
    """
    plain = text.strip()
    if not plain:
        return None
    try:
        return tomllib.loads(f"value = {plain}")["value"] if "\n" not in plain else plain
    except (ValueError, RecursionError):
        return plain


def field_text(value: Any) -> str:
    """Return how a field shows a value: texts without quotes, all else as TOML on one line."""
    if value is None:
        return ""
    if isinstance(value, str) and field_value(value) == value:
        return value
    return toml_text(value, longest=math.inf)


@dataclass(frozen=True)
class CaseProblem:
    """What is wrong with the case: the table it is about, empty for none, and a sentence."""

    table: str
    sentence: str


class CaseState(param.Parameterized):
    """Text of the case, and what is wrong with it, which every part of the page shows alike."""

    text: str = param.String("")  # type: ignore[assignment]
    problem: CaseProblem | None = param.ClassSelector(class_=CaseProblem)  # type: ignore[assignment]

    def __init__(self, visit: VisitFolder) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.visit = visit

    def set_text(self, text: str) -> None:
        """Take `text` as the case, valid or not."""
        text = text.replace("\r\n", "\n")
        write_text(self.visit.case, text)
        self.param.update(text=text, problem=self._problem_of_text())

    def _problem_of_text(self) -> CaseProblem | None:
        try:
            self.file()
        except GripscaleError as error:
            return CaseProblem(error.table.partition(".")[0], self.visit.short(error))
        return None

    @contextmanager
    def refusals(self, table: str) -> Iterator[None]:
        """Let what gripscale refuses be the problem of the case, in one of its tables.

        It stays until the text changes, or until the same table is accepted.
        """
        try:
            yield
        except GripscaleError as error:
            self.problem = CaseProblem(table, self.visit.short(error))
        else:
            if self.problem is not None and self.problem.table == table:
                self.problem = self._problem_of_text()

    def set(self, path: Sequence[str], value: Any) -> None:
        """State `value` at a path such as ("load", "speed"); None removes the key."""
        with self.refusals(path[0]):
            self.set_text(with_value(self.text, path, value))

    def get(self, path: Sequence[str]) -> Any:
        """Return the value the case states at a path, or None."""
        return value_at(self.text, path)

    def file(self) -> CaseFile:
        """Return the case as it can be run; raise what is wrong with it."""
        file = read_case_file(self.visit.case)
        self.visit.require_inside(file)
        return file

    def text_of(self, path: Path) -> str:
        """Return the text of a case of this machine, with its files copied into the visit."""
        folder.save_case(read_case_file(path), self.visit.path)
        return self.visit.case.read_text(encoding="utf-8")

    def example(self, name: str) -> str:
        """Return the text of a shipped example, with its files copied into the visit."""
        source = self.visit.path / "examples" / name
        case = source / "case.toml"
        return self.text_of(case if case.exists() else write_example(source, name)[0])

    def open(self, uploads: Mapping[str, bytes]) -> str:
        """Return the text of an uploaded case, with the files uploaded with it under their names.

        Files without a case make a new one.
        """
        cases = [name for name in uploads if name.lower().endswith(".toml")]
        if not cases:
            paths = [self.visit.path / self.visit.store(n, c) for n, c in uploads.items()]
            tables, _ = propose(paths, self.visit.path)
            return case_text(tables)
        if len(cases) != 1:
            raise InputError(
                f"{len(cases)} of the dropped files end in .toml; expected one case with the files "
                "it names"
            )
        try:
            text = uploads[cases[0]].decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"{cases[0]} cannot be read: it is not UTF-8 text") from error
        stored = {n: self.visit.store(n, c) for n, c in uploads.items() if n not in cases}
        write_text(self.visit.case, text)
        try:
            names = [name for _, name in read_case_file(self.visit.case).case.named_files()]
        except GripscaleError:
            return text  # the problem of the case says what is wrong with it
        last = {name: name.replace("\\", "/").rpartition("/")[2] for name in names}
        return renamed(text, {n: stored[last[n]] for n in names if last[n] in stored})
