"""Forms made from the tables of a case: one field for each key, named and explained as in the case.

A field that is left empty removes its key from the case.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Any

import panel as pn

from gripscale.app import elements
from gripscale.app.case import CaseState, field_text, field_value
from gripscale.case_file import CaseFile
from gripscale.case_file.keys import NEEDED, NOTHING, Key, KeySection, sections
from gripscale.case_file.schema import choices_of
from gripscale.conditions.conditions import DEFAULTED, OFF
from gripscale.report import write_page
from gripscale.report.elements import Page

BY_DEFAULT = "by default"
LOOK: dict[str, Any] = {
    "sizing_mode": "stretch_width",
    "margin": (2, 8),
    "styles": {"flex": "1 1 190px", "min-width": "0", "max-width": "340px"},
    "stylesheets": [elements.CUT_TEXT],
}
# Keys without a field: files are uploaded, and waves are written into the text of the case.
WITHOUT_FIELD = {"surface.sines", "surface.files", "surface.map", "rubber.file"}


def table_form(state: CaseState, name: str, first: Collection[str]) -> pn.Column:
    """Return the form of the table `name` of a case: the keys of `first`, the others to open."""
    section = next(section for section in sections() if section.name == name)
    laws = list(dict.fromkeys(s.name for s in sections() if s.name.startswith(f"{name}.")))
    fields = {
        key.name: field(state, section, key)
        for key in section.keys
        if f"{name}.{key.name}" not in {*laws, *WITHOUT_FIELD}
    }
    parts: list[Any] = [_rows([fields.pop(key) for key in first])]
    if fields:
        parts.append(elements.folded_card("All other keys", _rows([*fields.values()])))
    parts += [law_form(state, law) for law in laws if law not in WITHOUT_FIELD]
    return elements.column(*parts)


def law_form(state: CaseState, name: str) -> pn.Column:
    """Return the choice of a law, such as the softening, and the fields of the chosen law."""
    laws = {section.kind: section for section in sections() if section.name == name}
    single = list(laws) == [""]
    path = tuple(name.split("."))
    table = next(section for section in sections() if section.name == ".".join(path[:-1]))
    default = next(key.default for key in table.keys if key.name == path[-1])
    no_law = "none" if default == NOTHING else f"{BY_DEFAULT}: {default}"
    labels: dict[str, str | None] = {no_law: None}
    if path[-1] in DEFAULTED:  # a case has one where it states none
        labels = {BY_DEFAULT: None, OFF: OFF}
    labels |= {kind or "as stated below": kind for kind in laws}
    choice = pn.widgets.Select(
        label=path[-1].replace("_", " "),
        options=list(labels),
        description=laws[""].about if single else "",
        **LOOK,
    )
    body = elements.column(margin=(0, 0, 6, 16))
    body_kind: list[str | None] = [None]

    def kind_of_case() -> str | None:
        law = state.get(path)
        kind = law.get("kind", "") if isinstance(law, dict) else law
        return kind if kind in labels.values() else None

    def edit() -> None:
        if choice.value not in labels:
            return  # the law is a file, which the case already states
        kind = labels[choice.value]
        if kind != kind_of_case() or (kind != OFF and isinstance(state.get(path), str)):
            empty = {} if single else {"kind": kind}
            state.set(path, kind if kind in (None, OFF) else empty)

    def follow() -> None:
        kind, law = kind_of_case(), state.get(path)
        label = next(label for label, labelled in labels.items() if labelled == kind)
        file = [f"file {law}"] if isinstance(law, str) and law != OFF else []
        choice.param.update(options=[*labels, *file], value=[label, *file][-1])
        if kind != body_kind[0]:
            body_kind[0] = kind
            body.objects = []
            if kind in laws:
                keys = [key for key in laws[kind].keys if key.name != "kind"]
                body.objects = [_rows([field(state, laws[kind], key) for key in keys])]

    _bind(state, [choice], edit, follow)
    return elements.column(_rows([choice]), body)


def field(state: CaseState, section: KeySection, key: Key) -> Any:
    """Return what shows and changes one key of a table, written as in the case: `3 bar`."""
    path = (*section.name.split("."), key.name)
    kind = key.schema.get("type")
    choices = [True, False] if kind == "boolean" else choices_of(key.schema)
    is_text = kind == "string"
    label = key.name.replace("_", " ") + (" *" if key.default == NEEDED else "")
    look = {"label": label, "description": f"{key.meaning} Takes {key.takes}.", **LOOK}
    has_default = key.default not in (NEEDED, NOTHING)
    by_default = f"{BY_DEFAULT}: {key.default}" if has_default else BY_DEFAULT
    if key.default == NEEDED:
        by_default = "to be chosen"
    labels = {by_default: None, **{str(choice).lower(): choice for choice in choices}}
    widget: pn.widgets.Select | pn.widgets.TextInput
    if choices:
        widget = pn.widgets.Select(options=list(labels), **look)
    else:
        limits = re.sub("^a (whole )?number, ", "", key.takes)
        widget = pn.widgets.TextInput(placeholder=by_default if has_default else limits, **look)

    def edit() -> None:
        text = str(widget.value or "")
        if choices:
            value = labels.get(text)
        else:
            value = (text.strip() or None) if is_text else field_value(text)
        if value != state.get(path):
            state.set(path, value)

    def follow() -> None:
        value = state.get(path)
        if choices:
            matching = (label for label, choice in labels.items() if choice == value)
            widget.value = next(matching, by_default)
        else:
            widget.value = value if is_text and isinstance(value, str) else field_text(value)

    _bind(state, [widget], edit, follow)
    return widget


def _bind(
    state: CaseState, widgets: Sequence[Any], edit: Callable[[], None], follow: Callable[[], None]
) -> None:
    """Bind widgets and a case key both ways, without feedback loops."""
    following: list[bool] = []

    def on_text(*_: Any) -> None:
        following.append(True)
        try:
            follow()
        finally:
            following.pop()

    def on_value(_: Any) -> None:
        if not following:
            edit()

    on_text()
    state.param.watch(on_text, "text")
    for widget in widgets:
        widget.param.watch(on_value, "value")


def _rows(fields: list[Any]) -> pn.FlexBox:
    return pn.FlexBox(*fields, sizing_mode="stretch_width", align_items="end")


class PreviewPanel:
    """The page that `make` composes of the case as it is, at a click or on `update`.

    What is refused is the problem of the case, in its `table`.
    """

    def __init__(
        self, state: CaseState, table: str, label: str, make: Callable[[CaseFile], Page]
    ) -> None:
        self._state, self._table, self._make = state, table, make
        self.button = elements.work_button(label, self.update, color="primary")
        self.body = elements.column()

    def _written(self) -> Path:
        target = self._state.visit.path / f"preview-{self._table}.html"
        return write_page(lambda: self._make(self._state.file()), target)

    async def update(self) -> None:
        """Make the preview of the case as it is now."""
        self.body.loading, self.body.objects = True, []
        try:
            with self._state.refusals(self._table):
                page = await elements.in_worker(self._written)
                title = f"Preview of the {self._table}"
                self.body.objects = [elements.page_frame(self._state.visit, page, title)]
        finally:
            self.body.loading = False
