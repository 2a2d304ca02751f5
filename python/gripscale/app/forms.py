"""Forms made from the tables of a case: one field for each key, named and explained as in the case.

A field that is left empty removes its key from the case.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any, Literal, get_args, get_origin

import panel as pn

from gripscale.app.case import CaseState, field_text, field_value
from gripscale.app.elements import PageElements, column, in_worker, panes, refusals_in
from gripscale.case import CaseFile
from gripscale.case.keys import NEEDED, NOTHING, TABLES, Key, Section, sections
from gripscale.case.schema import table_of

BY_DEFAULT = "by default"
LOOK: dict[str, Any] = {
    "sizing_mode": "stretch_width",
    "margin": (2, 8),
    "styles": {"flex": "1 1 190px", "min-width": "0", "max-width": "340px"},
}
WITHOUT_FIELD = {"surface.sines", "surface.files", "surface.map", "rubber.file"}
"""Keys without a field: files are uploaded, and waves are written into the text of the case."""


def table_form(state: CaseState, name: str, first: Collection[str]) -> pn.Column:
    """Return the form of the table `name` of a case: the keys of `first`, the others to open."""
    section = next(section for section in sections() if section.name == name)
    tables = {table for table, _, _ in TABLES if table.startswith(f"{name}.")} - WITHOUT_FIELD
    fields = {
        key.name: field(state, section, key)
        for key in section.keys
        if f"{name}.{key.name}" not in tables | WITHOUT_FIELD
    }
    parts: list[Any] = [_rows([fields.pop(key) for key in first])]
    if fields:
        parts.append(
            pn.Card(
                _rows(list(fields.values())),
                title="All other keys",
                collapsed=True,
                sizing_mode="stretch_width",
                margin=(6, 8),
            )
        )
    laws = [law_form(state, table) for table, _, _ in TABLES if table in tables]
    return column(*parts, *laws)


def law_form(state: CaseState, name: str) -> pn.Column:
    """Return the choice of a law, such as the softening, and the fields of the chosen law."""
    laws = {section.kind: section for section in sections() if section.name == name}
    single = list(laws) == [""]
    path = tuple(name.split("."))
    table = next(section for section in sections() if section.name == ".".join(path[:-1]))
    default = next(key.default for key in table.keys if key.name == path[-1])
    no_law = "none" if default == NOTHING else f"{BY_DEFAULT}: {default}"
    labels = {no_law: None, **{kind or "as stated below": kind for kind in laws}}
    choice = pn.widgets.Select(
        label=path[-1].replace("_", " "),
        options=list(labels),
        description=laws[""].about if single else "",
        **LOOK,
    )
    body = column(margin=(0, 0, 6, 16))
    body_kind: list[str | None] = [None]

    def kind_of_case() -> str | None:
        law = state.get(path)
        kind = law.get("kind", "") if isinstance(law, dict) else None
        return kind if kind in laws else None

    def edit() -> None:
        if choice.value not in labels:
            return  # the law is a file, which the case already states
        kind = labels[choice.value]
        if kind != kind_of_case() or isinstance(state.get(path), str):
            empty = {} if single else {"kind": kind}
            state.set(path, None if kind is None else empty)

    def follow() -> None:
        kind, law = kind_of_case(), state.get(path)
        label = next(label for label, labelled in labels.items() if labelled == kind)
        file = [f"file {law}"] if isinstance(law, str) else []
        choice.param.update(options=[*labels, *file], value=[label, *file][-1])
        if kind != body_kind[0]:
            body_kind[0] = kind
            body.objects = []
            if kind is not None:
                keys = [key for key in laws[kind].keys if key.name != "kind"]
                body.objects = [_rows([field(state, laws[kind], key) for key in keys])]

    _bind(state, choice, edit, follow)
    return column(_rows([choice]), body)


def field(state: CaseState, section: Section, key: Key) -> pn.widgets.Select | pn.widgets.TextInput:
    """Return the widget that shows and changes one key of a table."""
    path = (*section.name.split("."), key.name)
    law = next(table for name, table, _ in TABLES if name == section.name)
    table = table_of(law[section.kind] if isinstance(law, Mapping) else law)
    annotation = table.model_fields[key.name].annotation
    choices, is_text = list(literals(annotation)), annotation in (str, str | None)
    look = {
        "label": key.name.replace("_", " ") + (" *" if key.default == NEEDED else ""),
        "description": f"{key.meaning} Takes {key.takes}.",
        **LOOK,
    }
    has_default = key.default not in (NEEDED, NOTHING)
    by_default = f"{BY_DEFAULT}: {key.default}" if has_default else BY_DEFAULT
    if key.default == NEEDED:
        by_default = "to be chosen"
    labels = {by_default: None, **{str(choice).lower(): choice for choice in choices}}
    widget: pn.widgets.Select | pn.widgets.TextInput
    if choices:
        widget = pn.widgets.Select(options=list(labels), **look)
    else:
        widget = pn.widgets.TextInput(placeholder=by_default if has_default else key.takes, **look)

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

    _bind(state, widget, edit, follow)
    return widget


def literals(annotation: Any) -> Iterator[Any]:
    """Yield the values of a `Literal` or a bool, optional or not."""
    parts = [part for part in get_args(annotation) or () if part is not type(None)]
    if annotation is bool:
        yield from (True, False)
    elif get_origin(annotation) is Literal:
        yield from parts
    elif len(parts) == 1 and get_origin(annotation) is not list:
        yield from literals(parts[0])


def _bind(
    state: CaseState, widget: Any, edit: Callable[[], None], follow: Callable[[], None]
) -> None:
    """Bind a widget and a case key both ways, without feedback loops."""
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
    widget.param.watch(on_value, "value")


def _rows(fields: list[Any]) -> pn.FlexBox:
    return pn.FlexBox(*fields, sizing_mode="stretch_width", align_items="end")


async def fill(body: pn.Column, make: Callable[[], PageElements], state: CaseState) -> None:
    """Fill `body` with what `make` returns or its error; the page stays responsive meanwhile."""
    body.loading = True
    try:
        with refusals_in(body, state.visit.short):
            body.objects = panes(await in_worker(make))
    finally:
        body.loading = False


class PreviewPanel:
    """A button, and the elements `make` returns for the case at the click."""

    def __init__(
        self, state: CaseState, label: str, make: Callable[[CaseFile], PageElements]
    ) -> None:
        self._state, self._make = state, make
        self.button = pn.widgets.Button(label=label, color="primary", margin=(8, 8))
        self.body = column()
        self.button.on_click(self.update)

    async def update(self, _: Any = None) -> None:
        """Make the preview of the case as it is now."""
        self.button.disabled = True
        await fill(self.body, lambda: self._make(self._state.file()), self._state)
        self.button.disabled = False
