"""The answer of a case that does not state whether its rubber is filled: both numbers.

The numbers are those of an unfilled rubber; their intervals reach from the lowest end of both to
the highest.
"""

from __future__ import annotations

from collections.abc import Iterator

import xarray as xr

from gripscale.questions.answer.variables import AnswerNumber

FILLERS = ("filled", "unfilled")
_ENDS = ("", "_low", "_high")


def with_filled(data: xr.Dataset, filled: xr.Dataset) -> xr.Dataset:
    """Return an answer for unfilled rubber with that of filled rubber, and intervals of both."""
    numbers = {}
    for name in ("friction", "contact_fraction", "hysteresis_friction"):
        names = [f"answer_{name}{end}" for end in _ENDS]
        if not {*names} <= {*data.variables} & {*filled.variables}:
            continue
        for filler, of in zip(FILLERS, (filled, data), strict=True):
            for end in names:
                text = f"{of[end].attrs.get('long_name', name)}, {filler} rubber"
                numbers[f"{filler}_{end}"] = of[end].assign_attrs(long_name=text)
        _, low, high = names
        numbers[low] = data[low].copy(data=min(float(data[low]), float(filled[low])))
        numbers[high] = data[high].copy(data=max(float(data[high]), float(filled[high])))
    return data.assign(numbers)


def both_answers(data: xr.Dataset) -> Iterator[tuple[str, dict[str, AnswerNumber]]]:
    """Yield "filled" and "unfilled" with friction and contact area; nothing of other answers."""
    for filler in FILLERS:
        if f"{filler}_answer_contact_fraction" not in data:
            return
        numbers = {}
        for name in ("friction", "contact_fraction"):
            start = f"{filler}_answer_{name}"
            numbers[name] = AnswerNumber(*(float(data[f"{start}{end}"]) for end in _ENDS))
        yield filler, numbers
