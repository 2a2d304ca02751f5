"""Master curve with its Prony series, and the frequencies the waves excite (figure 2 of LW)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
from numpy.typing import ArrayLike, NDArray

from gripscale.case.record import CLOSE_UP, band, close_up, envelope, sine_curves, trace
from gripscale.charts.style import (
    BEYOND,
    BLUE,
    COLOURS,
    DASHED,
    DOTTED,
    GREEN,
    GREY,
    INK,
    NARROW,
    ORANGE,
    WIDE,
    dashed_entry,
    log_axis,
    sheet,
    styled,
)
from gripscale.core.errors import InputError
from gripscale.core.units import MEGA, MILLI, SQUARE_MM, ZERO_CELSIUS
from gripscale.rubber import (
    FiniteStrainFit,
    MasterCurve,
    PronyFit,
    Rubber,
    ShiftFit,
    ShiftTable,
    Superposition,
    Sweep,
    Sweeps,
    UniaxialTest,
    uniaxial_stress,
)
from gripscale.rubber.superposition import temperatures_in
from gripscale.surface import HeightDifference, SelfAffineFit, SineStack
from gripscale.surface.profile import Profile

Array = NDArray[np.float64]


@styled
def master_curve_figure(
    rubber: Rubber,
    master: MasterCurve | None = None,
    fit: PronyFit | None = None,
    excitation: ArrayLike = (),
) -> Figure:
    """Draw moduli [MPa] and loss factor against angular frequency.

    Parameters
    ----------
    rubber
        Its Prony series is drawn as lines, dashed beyond the measured band, whose ends are marked.
    master
        The measured points, if any.
    fit
        Tells which rows were left out of the fit; they are drawn as crosses.
    excitation
        Angular frequencies of the waves [rad/s], marked on the axis.
    """
    figure, panels = sheet(NARROW, 4.9, 2, 1, sharex=True, height_ratios=[2.0, 1.0])
    moduli, loss = panels[:, 0]
    omega = np.asarray(excitation, dtype=float)
    _series(moduli, loss, rubber, master, omega)
    if master is not None:
        _points(moduli, loss, master, fit)
    log_axis(loss, "x")
    log_axis(moduli, "y")
    moduli.set_ylabel("modulus $E'$, $E''$ [MPa]")
    loss.set_ylabel("loss factor [-]")
    loss.set_xlabel("angular frequency $\\omega$ [rad/s]")
    loss.set_ylim(bottom=0.0)
    dashed_entry(moduli)
    _ends(moduli, loss, rubber)
    if omega.size:
        _marks(moduli, loss, rubber, omega)
    figure.legend(*moduli.get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def _series(
    moduli: Axes,
    loss: Axes,
    rubber: Rubber,
    master: MasterCurve | None,
    excitation: Array,
) -> None:
    """Draw E', E'' and E''/E' of the Prony series over everything that is shown."""
    omega = band(rubber, master, excitation, 600)
    modulus = rubber.complex_modulus(omega)
    if rubber.admissible is not None:
        low, high = rubber.complex_modulus_band(omega)
        shade: dict[str, Any] = {"alpha": 0.2, "lw": 0.0}
        moduli.fill_between(omega, low.real / MEGA, high.real / MEGA, color=BLUE, **shade)
        moduli.fill_between(omega, low.imag / MEGA, high.imag / MEGA, color=ORANGE, **shade)
        moduli.fill_between([], [], color=GREY, label="admissible", **shade)
    curves = (
        (moduli, modulus.real / MEGA, BLUE, "$E'$, Prony series"),
        (moduli, modulus.imag / MEGA, ORANGE, "$E''$, Prony series"),
        (loss, modulus.imag / modulus.real, GREEN, None),
    )
    for axes, values, colour, label in curves:
        for shown, dash, text in _stretches(rubber, omega, label):
            kind: dict[str, Any] = {"gid": BEYOND} if dash == DASHED else {}
            axes.plot(omega[shown], values[shown], ls=dash, color=colour, label=text, **kind)


def _stretches(
    rubber: Rubber, omega: Array, label: str | None
) -> list[tuple[NDArray[np.bool_], Any, str | None]]:
    """Return the frequencies within the measured band, solid, and those beyond it, dashed."""
    low, high = rubber.valid_band or (0.0, math.inf)
    inside = (omega >= low) & (omega <= high)
    return [(inside, "-", label), (omega <= low, DASHED, None), (omega >= high, DASHED, None)]


def _ends(moduli: Axes, loss: Axes, rubber: Rubber) -> None:
    """Mark the lowest and the highest measured frequency."""
    ends = [end for end in rubber.valid_band or () if 0.0 < end < math.inf]
    look: dict[str, Any] = {"color": GREY, "ls": DOTTED, "lw": 0.9, "zorder": 1.5}
    for k, end in enumerate(ends):
        moduli.axvline(end, label=None if k else "ends of the measured band", **look)
        loss.axvline(end, **look)


def _marks(moduli: Axes, loss: Axes, rubber: Rubber, omega: Array) -> None:
    """Mark the frequencies of the waves on the three curves."""
    modulus = rubber.complex_modulus(omega)
    look: dict[str, Any] = {
        "marker": "o",
        "ls": "",
        "mfc": "white",
        "mec": INK,
        "ms": 3.8,
        "mew": 0.9,
    }
    moduli.plot(omega, modulus.real / MEGA, label="$\\omega_i$ of the waves", **look)
    moduli.plot(omega, modulus.imag / MEGA, **look)
    loss.plot(omega, modulus.imag / modulus.real, **look)


def _points(moduli: Axes, loss: Axes, master: MasterCurve, fit: PronyFit | None) -> None:
    """Draw the measured rows, those left out of the fit as crosses."""
    out = np.zeros(len(master), dtype=bool)
    if fit is not None:
        out = np.isin(master.frequency, fit.outlier_frequency)
    omega = 2.0 * math.pi * master.frequency
    curves = (
        (moduli, master.storage / MEGA, BLUE, "$E'$, measured"),
        (moduli, master.loss / MEGA, ORANGE, "$E''$, measured"),
        (loss, master.loss_factor, GREEN, None),
    )
    for axes, values, colour, label in curves:
        axes.plot(omega[~out], values[~out], ".", color=colour, ms=3.5, alpha=0.6, label=label)
        axes.plot(omega[out], values[out], "x", color=colour, ms=4.5)
    if out.any():
        moduli.plot([], [], "x", color=GREY, ms=4.5, label="left out of the fit")


# How sweeps become a master curve: shifted rows, shift factors, tests of the superposition.

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


# Measured finite-strain loops with what fitted rubbers make of them.

KILO = 1e3


@styled
def finite_strain_figure(fits: Mapping[str, FiniteStrainFit]) -> Figure:
    """Draw nominal stress [kPa] against stretch, one panel for each test.

    Parameters
    ----------
    fits
        Label of each fit in the legend -> fit; all of the same tests.

    Raises
    ------
    InputError
        If there is no fit, or the fits are of different tests.
    """
    found = list(fits.values())
    if not found or any(fit.tests != found[0].tests for fit in found):
        raise InputError("fits must hold at least one fit, all of the same tests")
    tests = found[0].tests
    rows = (len(tests) + 1) // 2
    figure, panels = sheet(WIDE, 2.6 * rows + 0.3, rows, 2)
    for axes, place in zip(panels.flat, range(panels.size), strict=True):
        if place < len(tests):
            _panel(axes, tests[place], fits, place)
        else:
            axes.set_visible(False)
    for axes in panels[-1]:
        axes.set_xlabel("stretch $s$ [-]")
    for axes in panels[:, 0]:
        axes.set_ylabel("nominal stress $P$ [kPa]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def _panel(axes: Axes, test: UniaxialTest, fits: Mapping[str, FiniteStrainFit], place: int) -> None:
    """Draw one test, the fits over it, and their errors in the same colours."""
    measured = test.stress / KILO
    axes.plot(test.stretch, measured, "o", ms=3.0, mfc="none", mec=GREY, mew=0.7, label="measured")
    axes.text(0.03, 0.97, "error: rms, work lost", transform=axes.transAxes, va="top", fontsize=7.0)
    looks = zip(fits.items(), COLOURS, ("-", "-", "--", ":", "-.", "-"), strict=False)
    for line, ((label, fit), colour, dash) in enumerate(looks, 1):
        stress = uniaxial_stress(fit.rubber, test.time, test.stretch) / KILO
        axes.plot(test.stretch, stress, color=colour, ls=dash, lw=1.1, label=label)
        rms, work = fit.rms_errors[place], fit.work_errors[place]
        axes.text(
            0.03,
            0.97 - 0.075 * line,
            f"{100 * rms:.1f} %, {100 * work:+.0f} %",
            transform=axes.transAxes,
            va="top",
            fontsize=7.0,
            color=colour,
        )
    axes.set_title(test.name)
    top = float(np.max(measured))
    axes.set_ylim(min(0.0, float(np.min(measured))) - 0.04 * top, 1.25 * top)


# Measured profiles: as read with the points cleaning removed, cleaned, and a piece close up.

THIN: Any = {"lw": 0.45}
PIECES = 5000
"""Pieces a profile is drawn in: several to a pixel, so that most gaps are still seen."""


@styled
def profile_figure(pairs: Sequence[tuple[Profile, Profile]]) -> Figure:
    """Draw (as read, cleaned) pairs of profiles side by side.

    Rows: as read, with the points cleaning removed or cut off; cleaned; 30 mm of it close up,
    where the missing heights are gaps.
    """
    width = WIDE if len(pairs) > 1 else 0.7 * WIDE
    figure, axes = sheet(width, 5.2, 3, len(pairs), sharey="row")
    for column, (raw, cleaned) in enumerate(pairs):
        _as_read(axes[0, column], raw, cleaned)
        _cleaned(axes[1, column], cleaned)
        _close_up(axes[2, column], raw, cleaned)
        axes[0, column].set_title(raw.name or f"profile {column + 1}", loc="left")
        axes[1, column].sharex(axes[0, column])
        axes[0, column].tick_params(labelbottom=False)
        for panel in axes[1:, column]:
            panel.set_xlabel("distance $x$ [mm]")
    for panel, text in zip(axes[:, 0], ("as read", "cleaned", "close up"), strict=True):
        panel.set_ylabel(f"height $z$ [mm]\n{text}")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    close, names = axes[2, 0].get_legend_handles_labels()
    figure.legend(handles + close, labels + names, loc="outside upper center", ncols=4)
    return figure


def kept_points(raw: Profile, cleaned: Profile) -> NDArray[np.bool_]:
    """Return which points of `raw` still have a height in `cleaned`."""
    still = cleaned.x[np.isfinite(cleaned.z)]
    at = np.clip(np.searchsorted(still, raw.x), 1, max(still.size - 1, 1))
    nearest = np.minimum(np.abs(raw.x - still[at - 1]), np.abs(raw.x - still[at % still.size]))
    return np.asarray((nearest < 0.1 * raw.step) & np.isfinite(raw.z))


def _as_read(axes: Axes, raw: Profile, cleaned: Profile) -> None:
    kept = kept_points(raw, cleaned)
    x, z = raw.x / MILLI, raw.z / MILLI
    axes.plot(*_outline(x, np.where(kept, z, np.nan)), color=GREY, label="kept", **THIN)
    gone = ~kept & np.isfinite(raw.z)
    dots: dict[str, Any] = {"color": ORANGE, "rasterized": True, "zorder": 1.5}
    axes.plot(x[gone], z[gone], ".", ms=1.0, mew=0.0, **dots)
    axes.plot([], [], ".", color=ORANGE, ms=4.0, label="removed")


def _cleaned(axes: Axes, cleaned: Profile) -> None:
    axes.plot(*_outline(cleaned.x / MILLI, cleaned.z / MILLI), color=BLUE, **THIN)


def _outline(x: NDArray[np.float64], z: NDArray[np.float64]) -> tuple[Any, Any]:
    """Return what a line of all points would show, in so few that it is quickly drawn."""
    return trace(*envelope(x, z, PIECES))


def _close_up(axes: Axes, raw: Profile, cleaned: Profile) -> None:
    """Draw a piece from the middle, with the removed points at their cleaned level."""
    x, z = close_up(cleaned)
    axes.plot(x / MILLI, z / MILLI, color=BLUE, lw=0.9, label="cleaned")
    both = np.interp(cleaned.x, raw.x, raw.z) - cleaned.z  # the trend, where a height is left
    trend = np.polyfit(cleaned.x[np.isfinite(both)], both[np.isfinite(both)], 1)
    piece = (raw.x >= x[0]) & (raw.x <= x[0] + CLOSE_UP) & ~kept_points(raw, cleaned)
    level = raw.z[piece] - np.polyval(trend, raw.x[piece])
    axes.plot(raw.x[piece] / MILLI, level / MILLI, ".", color=ORANGE, ms=2.5)


# Height difference correlation: measured, self-affine fit and sine waves (figures 3b and 4 of LW).
#
# Beyond a quarter of the first wavelength the waves are drawn as they were fitted, the first one by
# its mean over phases, A_1^2 (see `fit_sines`); the pure sines, which fall back there, are dotted.
# Neither is drawn beyond the first wavelength.


@styled
def correlation_figure(
    measured: HeightDifference,
    sines: Mapping[str, SineStack],
    self_affine: SelfAffineFit | None = None,
) -> Figure:
    """Draw C_z [mm^2] against lag [mm], with the named sine stacks and their wavelengths marked."""
    figure, panels = sheet(NARROW, 3.7)
    axes = panels[0, 0]
    _measured(axes, measured)
    if self_affine is not None:
        curve = self_affine.evaluate(measured.lag) / SQUARE_MM
        text = f"self-affine, $H$ = {self_affine.hurst:.2f}"
        axes.plot(measured.lag / MILLI, curve, color=ORANGE, ls=DASHED, label=text)
    lag = np.geomspace(measured.lag[0], measured.lag[-1], 1000)
    for (name, stack), colour in zip(sines.items(), [BLUE, *COLOURS[2:]], strict=False):
        _waves(axes, stack, lag, name, colour)
    log_axis(axes, "x")
    log_axis(axes, "y")
    axes.set_xlabel("lag $l$ [mm]")
    axes.set_ylabel("height difference correlation $C_z$ [mm$^2$]")
    value = measured.value / SQUARE_MM
    axes.set_ylim(0.3 * value[value > 0.0].min(), 3.0 * value.max())
    axes.legend(loc="lower right")
    return figure


def _measured(axes: Axes, measured: HeightDifference) -> None:
    lag = measured.lag / MILLI
    if measured.lower is not None and measured.upper is not None:
        low, high = measured.lower / SQUARE_MM, measured.upper / SQUARE_MM
        axes.fill_between(lag, low, high, color=GREY, alpha=0.35, lw=0, label="95 % band")
    axes.plot(lag, measured.value / SQUARE_MM, ".", color=INK, ms=4.0, label="measured")


def _waves(axes: Axes, stack: SineStack, lag: NDArray[np.float64], name: str, colour: str) -> None:
    """Draw the waves up to the first wavelength as fitted and as pure sines; mark wavelengths."""
    lag = lag[lag <= stack.wavelength[0]]
    fitted, pure = (curve / SQUARE_MM for curve in sine_curves(stack, lag))
    pure[lag <= 0.25 * stack.wavelength[0]] = np.nan  # the same as fitted
    axes.plot(lag / MILLI, fitted, color=colour, label=name)
    text = "as pure sines, which repeat"
    axes.plot(lag / MILLI, pure, color=colour, lw=0.8, ls=DOTTED, label=text)
    axes.plot(
        stack.wavelength / MILLI,
        np.full(len(stack), 0.0),
        "|",
        color=colour,
        ms=9,
        mew=1.4,
        transform=axes.get_xaxis_transform(),
        label="their wavelengths",
    )
