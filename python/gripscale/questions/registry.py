"""The questions: one package each, found by the kind of a result, by a command and by the app.

A package says in its `__init__` what it holds, as texts, so that nothing heavy is imported:

    KINDS       the class of a saved result by its kind,  {"cut_off": "question:CutOff"}
    COMMANDS    the function of a command by its name,    {"cut-off": "command:cut_off"}
    FORMS       what the page in the browser offers

To add a question is to add a package and its line here; to drop one is to delete both.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gripscale.questions.result import Result

# Packages in the order of the command line.
QUESTIONS = [
    "gripscale.questions.answer",
    "gripscale.questions.compare",
    "gripscale.questions.vary",
    "gripscale.questions.uncertainty",
    "gripscale.questions.sensitivity",
    "gripscale.questions.design",
    "gripscale.questions.cut_off",
    "gripscale.questions.calibration",
]


@dataclass(frozen=True)
class FormField:
    """An option of a command as a field of a form."""

    flag: str
    label: str
    value: str  # content of the field at first
    prefix: str = ""  # text before the value on the command line, as in `--vary speed=...`
    # Labels and values of a choice; any text where there are none.
    choices: Sequence[tuple[str, str]] = ()


@dataclass(frozen=True)
class Form:
    """A command on a case as a form: title, meaning and fields."""

    command: str
    title: str
    about: str
    fields: Sequence[FormField] = ()
    others: str = ""  # what files it needs beside the case, if any

    def arguments(self, values: Mapping[str, str], others: Sequence[str] = ()) -> list[str]:
        """Return what follows the case on the command line; an empty value leaves its option out.

        `values` are those of the fields by label, `others` the files beside the case.
        """
        words = list(others)
        for field in self.fields:
            value = values.get(field.label, field.value).strip()
            if value:
                words += [field.flag, f"{field.prefix}{value}"]
        return words


def commands() -> Iterator[tuple[str, Callable[..., None]]]:
    """Yield names and functions of the commands of all questions."""
    for package in QUESTIONS:
        for name, path in getattr(import_module(package), "COMMANDS", {}).items():
            yield name, _attribute(package, path)


def forms() -> list[Form]:
    """Return the forms of all questions."""
    return [form for package in QUESTIONS for form in getattr(import_module(package), "FORMS", ())]


def kinds() -> dict[str, str]:
    """Return the kinds of results, with the package of each."""
    return {
        kind: package
        for package in QUESTIONS
        for kind in getattr(import_module(package), "KINDS", {})
    }


def result_class(kind: str) -> type[Result] | None:
    """Return the class of the results of a kind; None for an unknown kind."""
    package = kinds().get(kind)
    return None if package is None else _attribute(package, import_module(package).KINDS[kind])


def _attribute(package: str, path: str) -> Any:
    """Return what `module:name` in a package stands for; `:name` is in the package itself."""
    module, _, name = path.partition(":")
    return getattr(import_module(f"{package}.{module}" if module else package), name)
