"""How sweeps become a master curve: shifted rows, shift factors, tests of the superposition."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
from numpy.typing import NDArray

from gripscale.errors import InputError
from gripscale.figures.palette import BLUE, COLOURS, GREEN, GREY, INK, MEGA, NARROW, ORANGE, WIDE
from gripscale.figures.style import log_axis, sheet, styled
from gripscale.rubber import MasterCurve, ShiftFit, ShiftTable, Superposition, Sweep, Sweeps
from gripscale.rubber.superposition.report import temperatures_in
from gripscale.units import ZERO_CELSIUS

Array = NDArray[np.float64]

DEGREES = "temperature [°C]"


@styled
def superposition_figure(sweeps: Sweeps, master: MasterCurve) -> Figure:
    """Draw the sweeps as measured and shifted: moduli [MPa] and loss factor by frequency [Hz].

    Parameters
    ----------
    sweeps
        The sweeps.
    master
        Their master curve, with its shift.

    Raises
    ------
    InputError
        If the master curve has no shift.
    """
    figure, panels = sheet(WIDE, 6.2, 3, 2, sharex="col", sharey="row")
    colours = _Colours(sweeps)
    shifted = list(_shifted(sweeps, master))
    for column, found in enumerate((list(sweeps), shifted)):
        storage, loss, factor = panels[:, column]
        for one in found:
            look = {"color": colours.of(one), "marker": "o", "ms": 2.2, "lw": 0.8}
            storage.plot(one.frequency, one.storage / MEGA, **look)
            loss.plot(one.frequency, one.loss / MEGA, **look)
            factor.plot(one.frequency, one.loss / one.storage, **look)
        log_axis(factor, "x")
    panels[2, 1].xaxis.set_major_locator(LogLocator(numticks=6))
    names = ("$E'$ [MPa]", "$E''$ [MPa]", "$E''/E'$ [-]")
    columns = (sweeps.storage, sweeps.loss, sweeps.loss_factor)
    for axes, name, values in zip(panels[:, 0], names, columns, strict=True):
        log_axis(axes, "y", _steps(values))
        axes.set_ylabel(name)
    panels[0, 0].set_title("as measured")
    assert master.reference_temperature is not None
    celsius = master.reference_temperature - ZERO_CELSIUS
    panels[0, 1].set_title(f"shifted to {celsius:.1f} °C")
    panels[2, 0].set_xlabel("frequency $f$ [Hz]")
    panels[2, 1].set_xlabel("$a_T f$ [Hz]")
    colours.bar(figure, panels)
    return figure


@styled
def shift_figure(table: ShiftTable, fits: Sequence[ShiftFit] = ()) -> Figure:
    """Draw log10 a_T, with two standard errors, and log10 b_T by temperature, with formulas.

    Parameters
    ----------
    table
        The shift factors.
    fits
        Formulas fitted to them; dashed beyond the temperatures fitted.
    """
    lifted = bool((table.vertical != 0.0).any())
    rows = 3 if lifted else 2
    figure, panels = sheet(
        NARROW, 1.5 * rows + 1.4, rows, 1, sharex=True, height_ratios=[2.0, *[1.0] * (rows - 1)]
    )
    horizontal, rest = panels[0, 0], panels[1, 0]
    celsius = table.temperature - ZERO_CELSIUS
    error = 2.0 * np.nan_to_num(table.horizontal_error)
    look = {"fmt": "o", "color": INK, "ms": 3.2, "lw": 0.9, "capsize": 1.8}
    horizontal.errorbar(celsius, table.horizontal, error, label="sweeps, two std. errors", **look)
    rest.errorbar(celsius, np.zeros_like(celsius), error, **look)
    for fit, colour in zip(fits, COLOURS, strict=False):
        _formula(horizontal, rest, table, fit, colour)
    margin = 0.15 * max(float(np.ptp(table.horizontal)), 1.0)  # WLF has a pole
    horizontal.set_ylim(table.horizontal.min() - margin, table.horizontal.max() + margin)
    horizontal.set_ylabel("$\\log_{10} a_T$ [-]")
    rest.set_ylabel("formula less\nsweeps [-]")
    if lifted:
        panels[2, 0].errorbar(celsius, table.vertical, 2.0 * table.vertical_error, **look)
        panels[2, 0].set_ylabel("$\\log_{10} b_T$ [-]")
    panels[-1, 0].set_xlabel(DEGREES)
    horizontal.legend()
    return figure


@styled
def superposition_tests_figure(sweeps: Sweeps, report: Superposition) -> Figure:
    """Draw what needs no shift, and how neighbours meet once shifted.

    Van Gurp and Palmen's plot (phase angle by |E*|) and that of Cole and Cole (E'' by E') are one
    curve where horizontal shifts suffice; overlap and distance of neighbours by temperature.

    Parameters
    ----------
    sweeps
        The sweeps.
    report
        Of their superposition.
    """
    figure, panels = sheet(WIDE, 5.4, 2, 2)
    (gurp, cole), (width, apart) = panels
    colours = _Colours(sweeps)
    for one in sweeps:
        look = {"color": colours.of(one), "marker": "o", "ms": 2.2, "lw": 0.8}
        angle = np.degrees(np.arctan2(one.loss, one.storage))
        gurp.plot(np.hypot(one.storage, one.loss) / MEGA, angle, **look)
        cole.plot(one.storage / MEGA, one.loss / MEGA, **look)
    sides = ((gurp, "x", sweeps.storage), (cole, "x", sweeps.storage), (cole, "y", sweeps.loss))
    for axes, which, values in sides:
        log_axis(axes, which, _steps(values))
    gurp.set(xlabel="$|E^*|$ [MPa]", ylabel="phase angle [°]", title="van Gurp and Palmen")
    gurp.set_ylim(bottom=0.0)
    cole.set(xlabel="$E'$ [MPa]", ylabel="$E''$ [MPa]", title="Cole and Cole")
    _overlaps(width, apart, report)
    colours.bar(figure, panels[0])
    return figure


def _overlaps(width: Axes, apart: Axes, report: Superposition) -> None:
    middle = np.array([0.5 * (one.colder + one.warmer) for one in report.overlaps]) - ZERO_CELSIUS
    width.plot(middle, [one.decades for one in report.overlaps], "o-", color=INK, ms=3.2, lw=0.9)
    width.axhline(0.0, color=GREY, lw=0.8)
    width.set(xlabel=DEGREES, ylabel="overlap [decades]", title="overlap of neighbours")
    names = (
        ("storage", "$E'$", BLUE),
        ("loss", "$E''$", ORANGE),
        ("loss_factor", "$E''/E'$", GREEN),
    )
    shown = []
    for name, label, colour in names:
        values = [getattr(one, name) for one in report.overlaps]
        shown += [value for value in values if value > 0.0]
        apart.plot(middle, values, "o-", color=colour, ms=3.2, lw=0.9, label=label)
    log_axis(apart, "y", _steps(np.array(shown or [1.0])))
    apart.set(xlabel=DEGREES, ylabel="rms distance [decades]", title="distance in the overlap")
    if report.overlaps:
        apart.legend()


def _formula(horizontal: Axes, rest: Axes, table: ShiftTable, fit: ShiftFit, colour: str) -> None:
    """Draw a formula where it has values, against the reference of the table."""
    kelvin = np.linspace(max(table.limits[0], fit.shift.limits[0]), table.limits[1], 200)
    # A formula of the glass alone runs through its rows, not through the reference.
    first = float(fit.temperature[0])
    at = int(np.argmin(np.abs(table.temperature - first)))
    values = table.horizontal[at] - fit.residual[0] + fit.shift.log_a(kelvin, first)
    inside = (kelvin >= fit.temperature[0]) & (kelvin <= fit.temperature[-1])
    name = {"wlf": "WLF", "arrhenius": "Arrhenius"}[fit.shift.kind]
    for chosen, dash, label in ((inside, "-", name), (~inside, "--", None)):
        shown = np.where(chosen, values, np.nan)
        horizontal.plot(kelvin - ZERO_CELSIUS, shown, dash, color=colour, lw=1.1, label=label)
    rest.plot(fit.temperature - ZERO_CELSIUS, -fit.residual, "o-", color=colour, ms=2.5, lw=0.9)


def _steps(values: Array) -> tuple[float, ...]:
    """Return where the numbers of a logarithmic axis stand: denser on a short one."""
    return (1.0, 2.0, 5.0) if values.max() < 100.0 * values.min() else (1.0,)


def _shifted(sweeps: Sweeps, master: MasterCurve) -> Iterator[Sweep]:
    """Yield the sweeps as they stand in the master curve."""
    if master.shift is None or master.reference_temperature is None:
        raise InputError("master must have a shift, as superpose gives it; got none")
    kelvin = temperatures_in(master.shift, sweeps.temperatures, sweeps.tolerance)
    a = master.shift.a(kelvin, master.reference_temperature)
    b = master.shift.b(kelvin, master.reference_temperature)
    for one, along, up in zip(sweeps, a, b, strict=True):
        yield Sweep(one.temperature, one.frequency * along, one.storage * up, one.loss * up)


class _Colours:
    """Colours of temperatures, cold blue to warm red."""

    def __init__(self, sweeps: Sweeps) -> None:
        celsius = sweeps.temperatures - ZERO_CELSIUS
        self._map = ScalarMappable(Normalize(celsius[0], celsius[-1]), mpl.colormaps["turbo"])

    def of(self, sweep: Sweep) -> tuple[float, ...]:
        return tuple(self._map.to_rgba(np.array(sweep.temperature - ZERO_CELSIUS)))

    def bar(self, figure: Figure, panels: NDArray[Any]) -> None:
        bar = figure.colorbar(self._map, ax=list(panels.flat), label=DEGREES, aspect=40, pad=0.02)
        bar.outline.set_visible(False)
