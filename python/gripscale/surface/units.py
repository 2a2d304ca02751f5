"""Units of length a file or a caller may name, and their size in metres."""

from __future__ import annotations

import re

from gripscale.errors import InputError

METRES = {
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "nm": 1e-9,
    "pm": 1e-12,
    "in": 0.0254,
}

_OTHER_SPELLINGS = {
    "µm": "um",
    "μm": "um",
    "micron": "um",
    "microns": "um",
    "micrometer": "um",
    "micrometre": "um",
    "meter": "m",
    "metre": "m",
    "meters": "m",
    "metres": "m",
    "millimeter": "mm",
    "millimetre": "mm",
    "inch": "in",
}

_BRACKETED = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
_TRAILING = re.compile(r"[\s/_,]([^\s/_,]+)\s*$")


def metres_per(unit: str, name: str = "unit") -> float:
    """Return the size of `unit` in metres; raise `InputError` if it is not a unit of length."""
    known = known_unit(unit)
    if known is None:
        raise InputError(
            f"{name} must be a unit of length, one of {', '.join(METRES)}; got {unit!r}"
        )
    return METRES[known]


def known_unit(text: object) -> str | None:
    """Return the usual spelling of a unit of length, or None if `text` is not one."""
    if not isinstance(text, str):
        return None
    word = text.strip()
    word = _OTHER_SPELLINGS.get(word.lower(), word)
    return word if word in METRES else None


def unit_in_title(title: str) -> tuple[str | None, str | None]:
    """Return (unit, unknown text) named by a column title such as "x [mm]" or "distance_mm".

    A bracketed text that is no unit of length comes back as the second item, so that the caller
    can refuse it by name; a title without any unit gives (None, None).
    """
    bracketed = _BRACKETED.search(title)
    if bracketed:
        unit = known_unit(bracketed.group(1))
        return unit, None if unit else bracketed.group(1)
    trailing = _TRAILING.search(title)
    return (known_unit(trailing.group(1)) if trailing else None), None
