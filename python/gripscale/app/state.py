"""The case of one visit: its text is the one state of the page, shown and edited from all sides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import param

from gripscale.app.case_text import stated, with_value
from gripscale.app.visit_folder import VisitFolder
from gripscale.case import CaseFile, folder, read_case
from gripscale.case.saved import renamed
from gripscale.errors import GripscaleError, InputError
from gripscale.init import write_example


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
