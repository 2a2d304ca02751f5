"""Reading a case file; what is wrong becomes one sentence: file, key, value, expectation."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from gripscale.case_file.schema import first_complaint, sentence
from gripscale.case_file.tables import CaseTables
from gripscale.core import Described, FileError, InputError, about_keys
from gripscale.core.units import stated_units

M = TypeVar("M", bound=BaseModel)
# What is usually meant by a line that is no TOML.
_MISTAKES = {
    r"\\": "; a path is written with / or in 'single quotation marks'",
    r"=\s*[-+]?[\d.]+,\d": "; the decimal sign is the point",
    r"=\s*[-+]?[\d.]+\s*[^\s\d#]": '; a number with its unit stands in "quotation marks"',
}


@dataclass(frozen=True, repr=False)
class CaseFile(Described):
    """A case with the file it came from: `text` is kept word for word for the results folder."""

    case: CaseTables
    path: Path
    text: str
    units: Mapping[str, str] = field(default_factory=dict, compare=False)
    """The units the case states, by key, in which results are shown."""

    def resolve(self, name: str) -> Path:
        """Return the path of a file named in the case, relative to the case file."""
        return (self.path.parent / Path(name).expanduser()).resolve()


def read_case_file(path: str | Path) -> CaseFile:
    """Read and validate the case file at `path`.

    Raises `FileError` if it cannot be read or is not TOML, `InputError` if it says something
    unusable.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise FileError(f"case file {path} does not exist") from error
    except (OSError, UnicodeDecodeError) as error:
        undecodable = isinstance(error, UnicodeDecodeError)
        reason = "it is not UTF-8 text" if undecodable else getattr(error, "strerror", "") or error
        raise FileError(f"case file {path} cannot be read: {reason}") from error
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        if path.suffix.lower() != ".toml":
            raise FileError(
                f"{path} is no case file (TOML); `gripscale new ROAD RUBBER` makes one of measured "
                "files"
            ) from error
        number = re.search(r"at line (\d+)", str(error))
        line = text.splitlines()[int(number[1]) - 1] if number else ""
        hint = next((words for form, words in _MISTAKES.items() if re.search(form, line)), "")
        raise FileError(f"case file {path} is not valid TOML: {error}{hint}") from error
    except (ValueError, RecursionError) as error:  # numbers of 4300 digits, a thousand brackets
        raise FileError(f"case file {path} is beyond reading: {error}") from error
    if not tables:
        raise InputError(
            f"{path}: an empty case; expected at least [surface], [rubber] and [load], as "
            "`gripscale init FOLDER` writes them"
        )
    return CaseFile(validate(CaseTables, tables, str(path)), path, text, stated_units(tables))


def validate(model: type[M], values: Mapping[str, Any], where: str) -> M:
    """Return `values` as a `model`; an `InputError` begins with `where` and says why not."""
    try:
        return model.model_validate(dict(values))
    except ValidationError as error:
        whole = model is CaseTables
        refused = InputError(f"{where}: {sentence(error, model, in_table=whole)}")
        if not whole:
            raise refused from error
        from gripscale.case_file.keys import sections  # not for reading a case

        location = [part for part in first_complaint(error)["loc"] if isinstance(part, str)]
        longer_first = [".".join(location[:count]) for count in range(len(location), 0, -1)]
        names = {section.name for section in sections()}
        with about_keys(next((name for name in longer_first if name in names), "")):
            raise refused from error
