"""Tables a person can read: one row per wave, lengths in mm, moduli in MPa, loads as given."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import xarray as xr
from rich import box
from rich.console import Console, Group
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from gripscale.charts.view import CONVERGED, PredictionView
from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS, significant
from gripscale.model import with_adhesive
from gripscale.report.notices import conditions_sentences, exponent_sentence, prediction_sentence

if TYPE_CHECKING:
    import xarray as xr


# The look of tables in the terminal: a rule below the heads, columns close to each other.


def printed_table(title: str | None = None, *, padding: int = 1) -> Table:
    """Return a table without columns or rows; `padding` spaces follow each column."""
    return Table(
        title=title,
        title_justify="left",
        title_style="",
        box=box.SIMPLE_HEAD,
        padding=(0, padding, 0, 0),
        pad_edge=False,
    )


@dataclass(frozen=True)
class Column:
    """One column: its heading over its unit, and how a wave (numbered from 0) fills it."""

    heading: str
    unit: str
    cell: Callable[[PredictionView, int], str]
    given: str = ""
    """The key of the load whose unit it has, in place of `unit`."""

    def unit_in(self, view: PredictionView) -> str:
        """Return its unit in a table of a prediction."""
        return view.shown(self.given).unit if self.given else self.unit


def _fixed(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.3f}"


def _area(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.4f}" if value >= 1e-3 else f"{value:.1e}"


def _of(name: str, show: Callable[[float], str]) -> Callable[[PredictionView, int], str]:
    return lambda view, i: show(float(view.column(name)[i]))


def _moving(cell: Callable[[PredictionView, int], str]) -> Callable[[PredictionView, int], str]:
    """Leave a column of friction empty where nothing slides."""
    return lambda view, i: cell(view, i) if view.moving else "-"


def _in(unit: float) -> Callable[[float], str]:
    return lambda value: significant(value / unit)


def _pressure(view: PredictionView, i: int) -> str:
    return significant(float(view.shown("pressure").of(view.column("pressure_received")[i])))


def _loss_factor(view: PredictionView, i: int) -> str:
    star = "*" if view.column("outside_band")[i] else " "
    return f"{view.column('loss_factor')[i]:.2f}{star}"


def _stretches(view: PredictionView, i: int) -> str:
    least, largest = view.column("min_stretch")[i], view.column("max_stretch")[i]
    return "-" if math.isnan(least) or math.isnan(largest) else f"{least:.2f}-{largest:.2f}"


WAVE = Column("#", "", lambda view, i: f"{i + 1}")
LENGTH = Column("λ", "mm", _of("wavelength", _in(MILLI)))
LOAD = [
    Column("A", "mm", _of("amplitude", _in(MILLI))),
    Column("slope", "2πA/λ", _of("slope", "{:.2f}".format)),
    Column("p", "", _pressure, given="pressure"),
    Column("|E*|", "MPa", _of("modulus", _in(MEGA))),
    Column("tan δ", "", _moving(_loss_factor)),
]
CONTACT = [
    Column("area", "wave", _of("contact_fraction", _fixed)),
    Column("area", "run.", _of("running_contact_fraction", _area)),
    Column("μ", "wave", _moving(_of("friction", _fixed))),
    Column("μ", "run.", _moving(_of("running_friction", _fixed))),
    Column("μ", "diss.", _moving(_of("friction_from_dissipation", _fixed))),
]
EVIDENCE = [
    Column("stretch", "min-max", _stretches),
    Column("iter.", "", _of("newton_iterations", "{:.0f}".format)),
    Column("status", "", lambda view, i: view.why(i)),
]


LEGEND = (
    "area: contact length over wavelength, and running A_r/A_0; μ run.: sum of the waves; "
    "μ diss.: from the energy lost; |E*| and tan δ at 2πv/λ."
)
STAR = "* the wave, or a harmonic of it, excites the rubber beyond the measured frequencies:"


def prediction_table(data: xr.Dataset, title: str, width: int) -> Group:
    """Return one table per wave of a prediction, or two under each other where one is too wide.

    Parameters
    ----------
    data
        The answer of any model; of one without waves only the totals are shown.
    title
        Printed above it.
    width
        Characters available.
    """
    view = PredictionView(data)
    everything = [WAVE, LENGTH, *LOAD, *CONTACT, *EVIDENCE]
    whole = (_table(view, everything, padding) for padding in (1, 0) if view.waves)
    tables = [table for table in whole if _width(table) <= width][:1]
    if view.waves and not tables:
        halves = ([*LOAD], [*CONTACT, *EVIDENCE])
        tables = [_table(view, [WAVE, LENGTH, *half], 1) for half in halves]
    below = [totals(data), *filter(None, [exponent_sentence(data)]), *_notes(view)]
    return Group(Text(title, style="bold"), *tables, *map(Text, below))


def totals(data: xr.Dataset) -> str:
    """Return the sentence with the real contact area and the friction of a prediction."""
    view = PredictionView(data)
    if not view.converged.all():
        return f"No totals: wave {view.waves} did not converge ({view.why(view.waves - 1)})."
    if not view.waves and view.status != CONVERGED:
        return f"No totals: {view.status}."
    waves = f"{view.waves} wave{'s' if view.waves != 1 else ''}: " if view.waves else ""
    area = f"{waves}real contact area A_r/A_0 = {_area(view.total('contact_fraction'))}"
    if not view.moving:
        return f"{area}; no friction at rest."
    lost = _fixed(view.total("friction_from_dissipation"))
    text = f"{area}, friction mu = {_fixed(view.total('friction'))} ({lost} from dissipation)"
    both = with_adhesive(data)
    return f"{text}." if both is None else f"{text}; with the area term {_fixed(float(both))}."


def _notes(view: PredictionView) -> Iterator[str]:
    """Yield how far the two friction measures are apart, and what the stars warn of."""
    if not view.waves:
        beyond = prediction_sentence(view)
        if beyond:
            yield beyond
        return
    if view.moving and view.converged.all():
        apart = view.column("friction_mismatch").max()
        yield f"The two friction coefficients of a wave are at most {apart:.2%} apart."
    beyond = prediction_sentence(view)
    if beyond:
        yield f"{STAR} {beyond}"
    yield from conditions_sentences(view)


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


def _table(view: PredictionView, columns: Sequence[Column], padding: int) -> Table:
    table = printed_table(padding=padding)
    for column in columns:
        words = column.heading == "status"
        table.add_column(
            f"{column.heading}\n{column.unit_in(view)}",
            justify="left" if words else "right",
            no_wrap=not words,
            overflow="fold",
        )
    for i, good in enumerate(view.converged):
        cells = (column.cell(view, i) for column in columns)
        table.add_row(*cells, style=None if good else "bold red")
    return table


# How warm the rubber gets on each wave of a chain, as a table.

PARTS = (
    "flash_temperature_rise_uniform",
    "flash_temperature_rise_larger_waves",
    "flash_temperature_rise_own",
)


def heat_table(data: xr.Dataset) -> Table:
    """Return the temperature on each wave, by what it is made of.

    Parameters
    ----------
    data : xarray.Dataset
        Of `Prediction.to_dataset`, with heat.
    """
    table = printed_table(padding=2)
    for head in (
        "#\n",
        "λ\nmm",
        "all waves,\nevenly [K]",
        "larger\nwaves [K]",
        "own\n[K]",
        "T where\nlost [°C]",
        "T at the\nsurface [°C]",
    ):
        table.add_column(head, justify="right", no_wrap=True)
    for i in range(data.sizes["scale"]):
        wave = data.isel(scale=i)
        table.add_row(
            str(i + 1),
            significant(float(wave.wavelength) / MILLI),
            *(_kelvin(float(wave[name])) for name in PARTS),
            *(
                _kelvin(float(wave[name]) - ZERO_CELSIUS)
                for name in ("temperature", "contact_temperature")
            ),
        )
    return table


def _kelvin(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.1f}"
