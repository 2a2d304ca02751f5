"""How public objects show themselves: in few lines of text, in a notebook also with a figure."""

from __future__ import annotations

import math
from base64 import b64encode
from collections.abc import Iterator, Mapping
from dataclasses import Field, fields, is_dataclass
from html import escape
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from gripscale.core.errors import GripscaleError
from gripscale.core.units import readable
from gripscale.core.wording import short_repr, shortened

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH = 100
_FEW = 5  # numbers of an array that are listed
_MOST_LINES = 14  # lines below the name of an object
_LENGTHS = "wavelength amplitude smallest_wavelength thickness footprint distance indentation lag x"
# SI units of fields that state none, by name.
_UNITS = {
    **dict.fromkeys(f"{_LENGTHS} down_to cut_off lag_range".split(), "m"),
    **dict.fromkeys(("pressure", "pressure_received", "nominal_pressure"), "Pa"),
    **dict.fromkeys(("time", "duration", "load_time"), "s"),
    "speed": "m/s",
}


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
    if values.ndim == 1 and values.size <= _FEW:
        return ", ".join(readable(float(value), unit) for value in values)
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return f"{size} values from {readable(low, unit)} to {readable(high, unit)}"


class Described:
    """Base of objects that show what they hold in at most 15 lines of at most 100 characters."""

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield what the object shows of itself: names and texts; by default its fields."""
        items: tuple[Field[Any], ...] = fields(self) if is_dataclass(self) else ()
        for item in items:
            check, value = item.metadata.get("check"), getattr(self, item.name)
            unit = getattr(check, "keywords", {}).get("unit", "") or _UNITS.get(item.name, "")
            empty = value is None or (isinstance(value, str | tuple | list | dict) and not value)
            empty |= isinstance(value, float) and math.isnan(value)
            if (item.repr or isinstance(value, np.ndarray)) and not empty:
                yield item.name, shown_value(value, unit)

    def __repr__(self) -> str:
        name, rows = type(self).__name__, list(self.shown_rows())
        line = f"{name}({', '.join(f'{key}={text}' for key, text in rows)})"
        if len(line) <= _WIDTH:
            return line
        width = max(len(key) for key, _ in rows) + 2
        lines = []
        for key, text in rows:
            first, *rest = wrap(text, _WIDTH - width - 2) or [""]
            lines += [f"  {key:{width}}{first}", *(" " * (width + 2) + line for line in rest)]
        if len(lines) > _MOST_LINES:
            lines[_MOST_LINES - 1 :] = ["  ..."]
        return "\n".join([name, *lines])


class Pictured(Described):
    """Base of objects that a notebook also shows as a figure, that of `plot`."""

    def plot(self) -> Figure:
        """Draw the object (matplotlib)."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<tr><th style="text-align:left;padding-right:1em">{escape(key)}</th>'
            f'<td style="text-align:left">{escape(text)}</td></tr>'
            for key, text in self.shown_rows()
        )
        return with_figure(f"<b>{type(self).__name__}</b><table>{rows}</table>", self)


def with_figure(html: str, drawn: Any) -> str:
    """Return HTML beside the figure of an object's `plot`, alone where there is none to draw."""
    from gripscale.charts.paper import figure_file

    try:
        picture = b64encode(figure_file(drawn.plot(), dpi=110)).decode()
    except GripscaleError:
        return html
    image = f'<img alt="" style="{_IMAGE}" src="data:image/png;base64,{picture}">'
    return f'<div style="display:flex;flex-wrap:wrap;gap:1.5em"><div>{html}</div>{image}</div>'


# A figure has dark lines: its ground stays white on a dark page.
_IMAGE = "width:30em;max-width:100%;height:auto;align-self:flex-start;background:white"
