"""Tables a person can read: one row per wave, lengths in mm, pressures and moduli in MPa."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rich import box
from rich.console import Console, Group
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from gripscale.chain import Prediction
from gripscale.scale import ScaleResult

MILLI, MEGA = 1e-3, 1e6


@dataclass(frozen=True)
class Column:
    """One column: its heading over its unit, and how a wave (numbered from 0) fills it."""

    heading: str
    unit: str
    cell: Callable[[Prediction, int], str]


def _of_scale(value: Callable[[ScaleResult], str]) -> Callable[[Prediction, int], str]:
    return lambda prediction, i: value(prediction.scales[i])


def significant(value: float, digits: int = 3) -> str:
    """Return `value` with so many significant digits, without an exponent where it stays short."""
    if not math.isfinite(value):
        return "-" if math.isnan(value) else "inf"
    if value == 0.0 or 1e-4 <= abs(value) < 1e6:
        decimals = max(digits - 1 - math.floor(math.log10(abs(value))), 0) if value else 0
        return f"{value:.{decimals}f}"
    return f"{value:.{digits - 1}e}"


def _fixed(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.3f}"


def _area(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.4f}" if value >= 1e-3 else f"{value:.1e}"


def _moving(value: Callable[[Prediction, int], str]) -> Callable[[Prediction, int], str]:
    """Leave a column of friction empty where nothing slides."""
    return lambda prediction, i: value(prediction, i) if prediction.speed > 0.0 else "-"


def _loss_factor(prediction: Prediction, i: int) -> str:
    return f"{float(prediction.loss_factor[i]):.2f}{'*' if prediction.outside_band[i] else ' '}"


def _stretches(scale: ScaleResult) -> str:
    if math.isnan(scale.min_stretch) or math.isnan(scale.max_stretch):
        return "-"
    return f"{scale.min_stretch:.2f}-{scale.max_stretch:.2f}"


WAVE = Column("#", "", lambda p, i: f"{i + 1}")
LENGTH = Column("λ", "mm", _of_scale(lambda s: significant(s.wavelength / MILLI)))
LOAD = [
    Column("A", "mm", _of_scale(lambda s: significant(s.amplitude / MILLI))),
    Column(
        "slope", "2πA/λ", _of_scale(lambda s: f"{2 * math.pi * s.amplitude / s.wavelength:.2f}")
    ),
    Column("p", "MPa", _of_scale(lambda s: significant(s.pressure_received / MEGA))),
    Column("|E*|", "MPa", lambda p, i: significant(float(p.modulus[i]) / MEGA)),
    Column("tan δ", "", _moving(lambda p, i: _loss_factor(p, i))),
]
CONTACT = [
    Column("area", "wave", _of_scale(lambda s: _fixed(s.contact_fraction))),
    Column("area", "run.", lambda p, i: _area(float(p.running_contact_fraction[i]))),
    Column("μ", "wave", _moving(_of_scale(lambda s: _fixed(s.friction)))),
    Column("μ", "run.", _moving(lambda p, i: _fixed(float(p.running_friction[i])))),
    Column("μ", "diss.", _moving(_of_scale(lambda s: _fixed(s.friction_from_dissipation)))),
]
EVIDENCE = [
    Column("stretch", "min-max", _of_scale(_stretches)),
    Column("iter.", "", _of_scale(lambda s: f"{s.newton_iterations}")),
    Column("status", "", _of_scale(lambda s: s.status)),
]


LEGEND = (
    "area: contact length over wavelength, and running A_r/A_0; μ run.: sum of the waves; "
    "μ diss.: from the energy lost; |E*| and tan δ at 2πv/λ."
)
OUTSIDE_BAND = (
    "* the wave, or a harmonic of it, excites the rubber beyond the measured frequencies."
)


def prediction_table(prediction: Prediction, title: str, width: int) -> Group:
    """Return one table per wave of `prediction`, or two under each other where one is too wide.

    Parameters
    ----------
    prediction
        What to show.
    title
        Printed above it.
    width
        Characters available.
    """
    everything = [WAVE, LENGTH, *LOAD, *CONTACT, *EVIDENCE]
    whole = (_table(prediction, everything, padding) for padding in (1, 0))
    tables = [table for table in whole if _width(table) <= width][:1]
    if not tables:
        halves = ([*LOAD], [*CONTACT, *EVIDENCE])
        tables = [_table(prediction, [WAVE, LENGTH, *half], 1) for half in halves]
    below = [totals(prediction), *_notes(prediction)]
    return Group(Text(title, style="bold"), *tables, *map(Text, below))


def totals(prediction: Prediction) -> str:
    """Return the sentence with the real contact area and the friction of all waves."""
    count = len(prediction.scales)
    waves = f"{count} wave{'s' if count != 1 else ''}"
    if not prediction.converged:
        return f"No totals: wave {count} did not converge ({prediction.scales[-1].status})."
    area = f"real contact area A_r/A_0 = {_area(prediction.contact_fraction)}"
    if prediction.speed == 0.0:
        return f"{waves}: {area}; no friction at rest."
    return (
        f"{waves}: {area}, friction mu = {_fixed(prediction.friction)} "
        f"({_fixed(prediction.friction_from_dissipation)} from dissipation)."
    )


def _notes(prediction: Prediction) -> Iterator[str]:
    """Yield how far the two friction measures are apart, and the warning of the stars."""
    if prediction.speed > 0.0 and prediction.converged:
        apart = max(scale.friction_mismatch for scale in prediction.scales)
        yield f"The two friction coefficients of a wave are at most {apart:.2%} apart."
    if prediction.outside_band.any():
        yield OUTSIDE_BAND


def as_text(*parts: object, width: int = 100) -> str:
    """Return tables and sentences as plain text, as written to the results folder."""
    paper = _paper(width)
    with paper.capture() as captured:
        for part in parts:
            paper.print(part)
    return "".join(f"{line.rstrip()}\n" for line in captured.get().splitlines())


def _paper(width: int) -> Console:
    return Console(
        file=io.StringIO(), width=width, color_system=None, highlight=False, markup=False
    )


def _width(table: Table) -> int:
    paper = _paper(400)
    return Measurement.get(paper, paper.options, table).maximum


def _table(prediction: Prediction, columns: Sequence[Column], padding: int) -> Table:
    table = Table(box=box.SIMPLE_HEAD, padding=(0, padding, 0, 0), pad_edge=False)
    for column in columns:
        words = column.heading == "status"
        table.add_column(
            f"{column.heading}\n{column.unit}",
            justify="left" if words else "right",
            no_wrap=not words,
            overflow="fold",
        )
    for i, scale in enumerate(prediction.scales):
        style = None if scale.converged else "bold red"
        table.add_row(*(column.cell(prediction, i) for column in columns), style=style)
    return table
