"""Figures as BokehJS reads them: parts with a type and attributes, without Bokeh's Python classes.

Bokeh's classes would be imported, filled and checked for every page, which takes longer than all
else on it. Types and attributes: https://docs.bokeh.org/en/latest/docs/reference/models.html.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count
from typing import Any

from bokeh import __version__
from bokeh.core.serialization import Deserializer, Serializable, Serializer
from numpy.typing import ArrayLike, NDArray

_NUMBERS = count(1)


class Part(Serializable):
    """A part of a figure: the type that BokehJS has for it, and attributes other than default."""

    def __init__(self, kind: str, /, **attributes: Any) -> None:
        self.kind = kind
        self.id = f"g{next(_NUMBERS)}"
        self.attributes = attributes

    def __getitem__(self, name: str) -> Any:
        return self.attributes[name]

    def update(self, **attributes: Any) -> None:
        """Set attributes."""
        self.attributes |= attributes

    def to_serializable(self, serializer: Any) -> Any:
        """Return the part as data; where it occurs again, Bokeh's serializer refers to it."""
        serializer.add_ref(self, {"id": self.id})
        attributes = {name: serializer.encode(value) for name, value in self.attributes.items()}
        return {"type": "object", "name": self.kind, "id": self.id, "attributes": attributes}


def columns(values: Mapping[str, ArrayLike | list[NDArray[Any]]], **attributes: Any) -> Part:
    """Return the source of columns of equal length."""
    return Part("ColumnDataSource", data=dict(values), **attributes)


def document(root: Part) -> dict[str, Any]:
    """Return a figure as a document of Bokeh, plain data for JSON."""
    return {"version": __version__, "title": "", "config": None, "roots": [_encoded(root)]}


def model(root: Part) -> Any:
    """Return a figure as Bokeh's model, for a server; Bokeh warns of unknown attributes."""
    import bokeh.plotting  # noqa: F401 - has the type Figure

    return Deserializer().deserialize(_encoded(root))


def _encoded(root: Part) -> Any:
    return Serializer(deferred=False).encode(root)
