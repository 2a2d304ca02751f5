"""The folder of one visit: what is dropped on the page is stored here, and nothing else is read."""

from __future__ import annotations

import re
import secrets
import shutil
import time
from dataclasses import dataclass
from pathlib import Path, PureWindowsPath

from gripscale.case import CaseFile, folder
from gripscale.case.saved import CASE, INPUTS
from gripscale.errors import InputError

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
