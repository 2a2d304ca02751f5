"""Forms made from the tables of a case: a field for every key, named and explained as there.

A field that is left empty takes the key out of the case.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any, Literal, get_args, get_origin

import panel as pn

from gripscale.app.case import CaseState, value_of, words_of
from gripscale.app.elements import Cards, beside, error, panes
from gripscale.case import CaseFile
from gripscale.case.keys import NEEDED, NOTHING, TABLES, Key, Section, sections
from gripscale.case.schema import Table
from gripscale.charts.page_elements import Element
from gripscale.core.errors import GripscaleError

Watch = Callable[[], None]
BY_DEFAULT = "by default"
LOOK: dict[str, Any] = {
    "sizing_mode": "stretch_width",
    "margin": (2, 8),
    "styles": {"flex": "1 1 190px", "min-width": "0", "max-width": "340px"},
}
DROPPED = {"surface.sines", "surface.files", "surface.map", "rubber.file"}
"""Keys that are not typed: files are dropped, and waves by hand stand in the text."""


def table_form(state: CaseState, name: str, first: Collection[str]) -> pn.Column:
    """Return the form of the table `name` of a case: the keys of `first`, the others to open."""
    section = next(one for one in sections() if one.name == name)
    fields = {key.name: field(state, section, key) for key in section.keys if _typed(name, key)}
    laws = [law_form(state, inner) for inner in _inner(name)]
    shown = [fields.pop(key) for key in first]
    parts: list[Any] = [_rows(shown)]
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
    return pn.Column(*parts, *laws, sizing_mode="stretch_width")


def law_form(state: CaseState, name: str) -> pn.Column:
    """Return the choice of a kind of the table `name`, and the fields of the kind chosen."""
    kinds = {one.kind: one for one in sections() if one.name == name}
    path = tuple(name.split("."))
    only = list(kinds) == [""]
    labels = {_unstated(name): None, **{kind or "as stated below": kind for kind in kinds}}
    title = path[-1].replace("_", " ")
    about = next(iter(kinds.values())).about if only else ""
    choice = pn.widgets.Select(label=title, options=list(labels), description=about, **LOOK)
    body = pn.Column(sizing_mode="stretch_width", margin=(0, 0, 6, 16))
    shown: list[str | None] = [None]

    def chosen() -> None:
        if choice.value not in labels:
            return  # the file that is stated
        kind, stated = labels[choice.value], state.get(path)
        if kind != _kind(state, path, kinds) or isinstance(stated, str):
            empty = {} if only else {"kind": kind}
            state.set(path, None if kind is None else empty)

    def follow() -> None:
        kind = _kind(state, path, kinds)
        label = next(label for label, one in labels.items() if one == kind)
        stated = state.get(path)
        named = [f"file {stated}"] if isinstance(stated, str) else []
        choice.param.update(options=[*labels, *named], value=[label, *named][-1])
        if kind != shown[0]:
            shown[0] = kind
            body.objects = [] if kind is None else [_law(state, kinds[kind])]

    _bind(state, choice, chosen, follow)
    return pn.Column(_rows([choice]), body, sizing_mode="stretch_width")


def _unstated(name: str) -> str:
    """Return what it means that the case states no table `name`."""
    above, _, last = name.rpartition(".")
    outer = next(one for one in sections() if one.name == above)
    default = next(key.default for key in outer.keys if key.name == last)
    return "none" if default == NOTHING else f"{BY_DEFAULT}: {default}"


def _law(state: CaseState, section: Section) -> pn.FlexBox:
    return _rows([field(state, section, key) for key in section.keys if key.name != "kind"])


def _kind(state: CaseState, path: tuple[str, ...], kinds: Collection[str]) -> str | None:
    """Return the kind the case states, or None where it states no table there."""
    table = state.get(path)
    if not isinstance(table, dict):
        return None
    kind = table.get("kind", "")
    return kind if kind in kinds else None


def field(state: CaseState, section: Section, key: Key) -> pn.widgets.Select | pn.widgets.TextInput:
    """Return what shows and changes one key of a table."""
    path = (*section.name.split("."), key.name)
    annotation = _annotation(section, key.name)
    choices, words = list(_literals(annotation)), annotation in (str, str | None)
    label = key.name.replace("_", " ") + (" *" if key.default == NEEDED else "")
    about = f"{key.meaning} Takes {key.takes}."
    look = {"label": label, "description": about, **LOOK}
    widget: pn.widgets.Select | pn.widgets.TextInput
    known = key.default not in (NEEDED, NOTHING)
    by_default = f"{BY_DEFAULT}: {key.default}" if known else BY_DEFAULT
    if key.default == NEEDED:
        by_default = "to be chosen"
    labels = {by_default: None, **{str(one).lower(): one for one in choices}}
    if choices:
        widget = pn.widgets.Select(options=list(labels), **look)
    else:
        hint = by_default if known else key.takes
        widget = pn.widgets.TextInput(placeholder=hint, **look)

    def typed() -> None:
        shown = str(widget.value or "")
        value = labels.get(shown) if choices else _typed_value(shown, words)
        if value != state.get(path):
            state.set(path, value)

    def follow() -> None:
        value = state.get(path)
        if choices:
            found = (label for label, one in labels.items() if one == value)
            widget.value = next(found, by_default)
        else:
            widget.value = value if words and isinstance(value, str) else words_of(value)

    _bind(state, widget, typed, follow)
    return widget


def _typed_value(value: str, words: bool) -> Any:
    return (value.strip() or None) if words else value_of(value)


def _bind(state: CaseState, widget: Any, typed: Watch, follow: Watch) -> None:
    """Let a widget follow the case, and the case what is typed: never what only followed."""
    following: list[bool] = []

    def follows(*_: Any) -> None:
        following.append(True)
        try:
            follow()
        finally:
            following.pop()

    def changes(_: Any) -> None:
        if not following:
            typed()

    follows()
    state.param.watch(follows, "text")
    widget.param.watch(changes, "value")


def _rows(fields: list[Any]) -> pn.FlexBox:
    return pn.FlexBox(*fields, sizing_mode="stretch_width", align_items="end")


def _typed(table: str, key: Key) -> bool:
    return f"{table}.{key.name}" not in {*DROPPED, *_inner(table)}


def _inner(table: str) -> list[str]:
    """Return the tables in a table that have forms of their own."""
    names = [name for name, _, _ in TABLES]
    return [name for name in names if name.startswith(f"{table}.") and name not in DROPPED]


def _annotation(section: Section, key: str) -> Any:
    """Return the type of a key; strain energies are dataclasses of numbers."""
    law = next(table for name, table, _ in TABLES if name == section.name)
    model = law[section.kind] if isinstance(law, Mapping) else law
    return model.model_fields[key].annotation if issubclass(model, Table) else float


def _literals(annotation: Any) -> Iterator[Any]:
    """Yield the values of a `Literal` or a truth, with None beside it or not."""
    parts = [one for one in get_args(annotation) or () if one is not type(None)]
    if annotation is bool:
        yield from (True, False)
    elif get_origin(annotation) is Literal:
        yield from parts
    elif len(parts) == 1 and get_origin(annotation) is not list:
        yield from _literals(parts[0])


# Parts of the page that take a while: computed in a thread, shown, or the sentence why not.

Shown = Sequence[Element | Cards]


async def fill(body: pn.Column, make: Callable[[], Shown], state: CaseState) -> None:
    """Fill `body` with what `make` returns; meanwhile the page stays alive."""
    body.loading = True
    try:
        body.objects = panes(await beside(make))
    except GripscaleError as refused:
        body.objects = [error(state.place.short(refused))]
    finally:
        body.loading = False


class PreviewPanel:
    """A button and what `make` finds in the case as it is at the click."""

    def __init__(
        self, state: CaseState, label: str, make: Callable[[CaseFile], Sequence[Element]]
    ) -> None:
        self._state, self._make = state, make
        self.button = pn.widgets.Button(label=label, color="primary", margin=(8, 8))
        self.body = pn.Column(sizing_mode="stretch_width")
        self.button.on_click(self.look)

    async def look(self, _: Any = None) -> None:
        """Make it from the case as it is now."""
        self.button.disabled = True
        await fill(self.body, lambda: self._make(self._state.file()), self._state)
        self.button.disabled = False
