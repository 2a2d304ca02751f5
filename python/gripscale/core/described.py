"""How public objects show themselves: in few lines of text, in a notebook also with a figure."""

from __future__ import annotations

import math
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from gripscale.core.errors import GripscaleError
from gripscale.core.faces import FIGURE_PNG, face
from gripscale.core.units import readable
from gripscale.core.wording import short_repr, shortened

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH = 100
_MOST_ROWS = 14
"""Rows below the name of an object."""
_UNITS = {
    **dict.fromkeys(("wavelength", "amplitude", "smallest_wavelength", "thickness", "x"), "m"),
    **dict.fromkeys(("pressure", "nominal_pressure", "nominal", "modulus"), "Pa"),
    **dict.fromkeys(("speed",), "m/s"),
    **dict.fromkeys(("time", "duration"), "s"),
}
"""SI units of fields that state none, by name."""


def shown_value(value: Any, unit: str = "") -> str:
    """Return a value as text: numbers with their unit, arrays by size and range."""
    if isinstance(value, np.ndarray) and value.ndim:
        return _shown_array(value, unit)
    if isinstance(value, float | np.floating | np.ndarray):
        return readable(float(value), unit)
    if isinstance(value, str):
        return shortened(str(value), _WIDTH - 20) if type(value) is not str else short_repr(value)
    if isinstance(value, tuple | list) and value:
        if len(value) <= 3 and all(isinstance(item, float | int) for item in value):
            return f"({', '.join(shown_value(item, unit) for item in value)})"
        kinds = {type(item).__name__ for item in value}
        return f"{len(value)} {kinds.pop() if len(kinds) == 1 else 'items'}"
    if isinstance(value, Mapping):
        return shortened(f"{{{', '.join(f'{k}: {shown_value(v)}' for k, v in value.items())}}}", 80)
    return shortened(repr(value).partition("\n")[0], _WIDTH - 20)


def _shown_array(values: np.ndarray[Any, Any], unit: str) -> str:
    size = " x ".join(map(str, values.shape))
    if values.dtype.kind not in "fiu" or not np.isfinite(values).any():
        return f"{size} values"
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return f"{size} values from {readable(low, unit)} to {readable(high, unit)}"


class Described:
    """Base of objects that show what they hold in at most 15 lines of at most 100 characters."""

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield what the object shows of itself: names and texts; by default its fields."""
        for item in fields(self) if is_dataclass(self) else ():
            check = item.metadata.get("check")
            unit = getattr(check, "keywords", {}).get("unit", "")
            value = getattr(self, item.name)
            empty = value is None or (isinstance(value, str | tuple | list | dict) and not value)
            if item.repr and not empty:
                yield item.name, shown_value(value, unit or _UNITS.get(item.name, ""))

    def __repr__(self) -> str:
        name, rows = type(self).__name__, list(self.shown_rows())
        line = f"{name}({', '.join(f'{key}={text}' for key, text in rows)})"
        if len(line) <= _WIDTH:
            return line
        width = max(len(key) for key, _ in rows)
        lines = [f"  {key.ljust(width)}  {text}" for key, text in rows]
        if len(lines) > _MOST_ROWS:
            lines[_MOST_ROWS - 1 :] = [f"  ... {len(lines) - _MOST_ROWS + 1} more"]
        return "\n".join([name, *(shortened(line, _WIDTH) for line in lines)])


class Pictured(Described):
    """Base of objects that a notebook also shows as a figure, that of `plot`."""

    def plot(self) -> Figure:
        """Draw the object (matplotlib)."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<tr><th style="text-align:left">{escape(key)}</th>'
            f'<td style="text-align:left">{escape(text)}</td></tr>'
            for key, text in self.shown_rows()
        )
        return with_figure(f"<b>{type(self).__name__}</b><table>{rows}</table>", self)


def with_figure(html: str, drawn: Any) -> str:
    """Return HTML beside the figure of an object's `plot`, alone where there is none to draw."""
    try:
        picture = b64encode(face(FIGURE_PNG)(drawn.plot(), dpi=110)).decode()
    except GripscaleError:
        return html
    image = f'<img alt="" style="{_IMAGE}" src="data:image/png;base64,{picture}">'
    return f'<div style="display:flex;flex-wrap:wrap;gap:1.5em"><div>{html}</div>{image}</div>'


_IMAGE = "width:24em;max-width:100%;height:auto;align-self:flex-start;background:white"
"""A figure has dark lines: its ground stays white on a dark page."""
