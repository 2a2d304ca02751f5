"""What may change an answer because of its inputs, as their record shows before any solve."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from gripscale.core.finding import Finding, Severity, Topic, ranked
from gripscale.core.units import MILLI
from gripscale.io.table import significant
from gripscale.questions.inputs.record import InputRecord
from gripscale.report.elements import number_text, percent_text

LARGE_RESIDUAL = 0.1  # of the heights of the sine waves


def input_findings(record: InputRecord) -> list[Finding]:
    """Return what is doubtful about the inputs of a result, ranked."""
    return ranked([*extrapolated(record), *misfits(record), *record.warnings()])


def extrapolated(record: InputRecord) -> Iterator[Finding]:
    """Yield from where the roughness of a case is extrapolated, if it is."""
    if record.number("cut_off_beyond_measurement") > 0.0:
        ends = record.number("cut_off_carried_m"), record.number("cut_off_m")
        yield extrapolated_roughness(*ends, {})


def extrapolated_roughness(limit: float, end: float, changed: Mapping[str, float]) -> Finding:
    """Return what roughness from `limit` to `end` [m] adds, both shorter than was measured.

    `changed` are the relative changes of an answer without it, as far as they are known.
    """
    lengths = (f"{number_text(length, MILLI)} mm" for length in (limit, end))
    text = "Roughness from {}, where the measurement ends, to {} is extrapolated".format(*lengths)
    return Finding(
        Severity.WARNING,
        f"{text}: without it {in_words(changed)}." if changed else f"{text}.",
        changed.get("friction", math.nan),
        changed.get("contact_fraction", math.nan),
        Topic.SURFACE,
    )


def in_words(changed: Mapping[str, float]) -> str:
    """Return relative changes in words, such as `the friction changes by +38 %`."""
    words = {"friction": "the friction", "contact_fraction": "the contact area"}
    first, *others = [
        (words[name], f"by {signed_percent(change)}") for name, change in changed.items()
    ]
    return " and ".join([" changes ".join(first), *map(" ".join, others)])


def signed_percent(change: float) -> str:
    """Return a relative change in per cent with its sign, such as `-3.2 %`."""
    return f"{'+-'[change < 0.0]}{percent_text(abs(change))}"


def misfits(record: InputRecord) -> Iterator[Finding]:
    """Yield by how much the sine waves miss their heights."""
    residual = record.number("sines_residual_decades")
    height = 10.0 ** (0.5 * residual) - 1.0  # C_z goes with the square of the height
    if height > LARGE_RESIDUAL:
        yield Finding(
            Severity.WARNING,
            f"The sine waves miss the measured correlation by {significant(residual, 2)} decades: "
            f"{percent_text(height)} of their height. The friction of the chain has a similar "
            "error.",
            height,
            topic=Topic.SURFACE,
        )
