"""The elements a page is made of; `page.html` has one macro for each, chosen by `kind`.

All texts are plain: escaping is the template's task.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from gripscale.core.units import significant
from gripscale.experiment.axis import LABELS
from gripscale.experiment.speed_and_temperature import BEYOND_SHIFT
from gripscale.model import ADHESIVE_FRICTION, FRICTION_OUTSIDE_BAND, WHY_NO_EXPONENT


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str
    kind: ClassVar[str] = "text"


@dataclass(frozen=True)
class Notice:
    """Something the reader must not miss; `level` is "error" or "warning"."""

    level: str
    text: str
    kind: ClassVar[str] = "notice"


@dataclass(frozen=True)
class Facts:
    """Pairs of a name and its value, under a caption."""

    caption: str
    pairs: list[tuple[str, str]]
    kind: ClassVar[str] = "facts"


@dataclass(frozen=True)
class Heading:
    """Head of a column: what it holds, and its unit; `words` if it holds texts, not numbers."""

    text: str
    unit: str = ""
    words: bool = False


@dataclass(frozen=True)
class Table:
    """A table whose first column names its rows.

    `groups` are (label, number of columns) of a row above the headings, or empty.
    `bad` are the cells that must not be trusted, as (row, column).
    """

    name: str
    caption: str
    headings: Sequence[Heading]
    rows: Sequence[Sequence[str]]
    groups: Sequence[tuple[str, int]] = ()
    bad: frozenset[tuple[int, int]] = frozenset()
    note: str = ""
    kind: ClassVar[str] = "table"

    @property
    def narrow(self) -> bool:
        """Whether it fits beside a figure."""
        return len(self.headings) <= 4 and not any(heading.words for heading in self.headings)


@dataclass(frozen=True)
class Chart:
    """An interactive figure: a Bokeh model, its caption and a text for who cannot see it."""

    name: str
    caption: str
    alt: str
    model: Any
    wide: bool = False
    kind: ClassVar[str] = "chart"


@dataclass(frozen=True)
class Image:
    """A picture inside the page, base64."""

    name: str
    caption: str
    alt: str
    data: str
    media_type: str
    width: int
    height: int
    kind: ClassVar[str] = "image"


@dataclass(frozen=True)
class Equation:
    """An equation: its LaTeX, and an SVG picture of it, base64, with its size [px]."""

    name: str
    latex: str
    data: str
    width: int
    height: int
    words: str
    source: str
    kind: ClassVar[str] = "equation"


@dataclass(frozen=True)
class Code:
    """Text to be copied."""

    name: str
    caption: str
    text: str
    kind: ClassVar[str] = "code"


Element = Text | Notice | Facts | Table | Chart | Image | Equation | Code


@dataclass(frozen=True)
class Section:
    """A chapter of the page."""

    name: str
    title: str
    elements: Sequence[Element]


@dataclass(frozen=True)
class Card:
    """One result at the head of the page."""

    label: str
    value: str
    detail: str
    bad: bool = False


@dataclass(frozen=True)
class Page:
    """A whole report."""

    title: str
    subtitle: str
    notices: Sequence[Notice]
    cards: Sequence[Card]
    sections: Sequence[Section] = field(default_factory=tuple)

    @property
    def charts(self) -> list[Chart]:
        """All interactive figures, in order."""
        return [e for section in self.sections for e in section.elements if isinstance(e, Chart)]


# Numbers as people read them.

NONE = "–"
"""What a cell shows where there is no number."""


def number(value: object, scale: float = 1.0, digits: int = 3) -> str:
    """Return `value` / `scale` with so many significant digits; a dash for NaN."""
    real = float(np.asarray(value, dtype=float)) / scale
    if math.isnan(real):
        return NONE
    if math.isinf(real):
        return "∞" if real > 0.0 else "−∞"
    return significant(real, digits).replace("-", "−")


def whole(value: object) -> str:
    """Return a count, with thin spaces between thousands."""
    real = float(np.asarray(value, dtype=float))
    return NONE if math.isnan(real) else f"{round(real):,}".replace(",", "\u202f")


def percent(value: object) -> str:
    """Return a ratio as a percentage of two significant digits."""
    real = 100.0 * float(np.asarray(value, dtype=float))
    return NONE if math.isnan(real) else f"{significant(real, 2).replace('-', '−')} %"


# What the numbers of a study are called on its page, and which of them tell nothing.

AT_REST = "static_"
"""Before the name of what a study says of rubber at rest."""

WORDS = {
    "total_contact_fraction": "real contact area A_r/A_0",
    "total_friction": "friction μ",
    "total_friction_from_dissipation": "μ from the energy lost",
    ADHESIVE_FRICTION: "μ of the area term",
    FRICTION_OUTSIDE_BAND: "share of μ beyond the measured band",
    "total_decades_below_band": "decades below the measured band",
    "total_decades_above_band": "decades above the measured band",
    "total_contact_fraction_cut_off_exponent": "d ln(A_r/A_0) / d ln λ_min",
    "total_friction_cut_off_exponent": "d ln μ / d ln λ_min",
    WHY_NO_EXPONENT: "why there is no exponent",
    BEYOND_SHIFT: "temperature beyond those of the shift",
    "prediction_status": "status",
    "friction_by_decade": "friction μ of relaxation times",
    "contact_fraction": "contact fraction of each wave",
    "friction": "friction μ of each wave",
    "running_contact_fraction": "A_r/A_0 down to the wave",
    "running_friction": "μ down to the wave",
}
"""Words by the name in the result file; of others its `long_name` is taken."""


def words_of(data: xr.Dataset, name: str) -> str:
    """Return what a page calls a variable or an axis."""
    if name.startswith(AT_REST):
        return f"{words_of(data, name.removeprefix(AT_REST))}, at rest"
    if name in WORDS:
        return WORDS[name]
    plain = name.replace("_", " ")
    if name in LABELS or name not in data.variables:
        return plain
    return str(data[name].attrs.get("long_name", plain))


def telling(variable: xr.DataArray) -> bool:
    """Return whether some value is neither zero, missing nor an empty text."""
    if variable.dtype.kind in "fiub":
        return bool(np.nan_to_num(variable.values.astype(float)).any())
    return any(str(value) for value in variable.values.ravel())
