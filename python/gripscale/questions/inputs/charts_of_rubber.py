"""Charts of rubber: moduli and Prony series (LW, figure 2), sweeps, shift factors, softening."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.charts import draw
from gripscale.charts.chart import ColourBar, CrossLine, Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Chart, Sheet
from gripscale.charts.style import BLUE, COLOURS, GREEN, GREY, INK, NARROW, ORANGE, shades
from gripscale.core import Array, InputError
from gripscale.core.units import MEGA, ZERO_CELSIUS
from gripscale.questions.inputs.record import band, rubber_variables
from gripscale.rubber import (
    MasterCurve,
    PronyFit,
    Rubber,
    ShiftFit,
    ShiftTable,
    Superposition,
    Sweep,
    Sweeps,
)
from gripscale.rubber.softening import SofteningTable
from gripscale.rubber.superposition import temperatures_in

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.charts.draw import FigureFolder
    from gripscale.rubber.measured_rubber import MeasuredRubber

OMEGA = PlotAxis("angular frequency $\\omega$ [rad/s]", log=True)
MODULUS = PlotAxis("modulus $E'$, $E''$ [MPa]", log=True)
LOSS_FACTOR = PlotAxis("loss factor $E''/E'$ [-]", low=0.0)
CELSIUS = PlotAxis("temperature [°C]")
_TWO_TO_ONE: dict[str, Any] = {"sharex": True, "height_ratios": [2.0, 1.0]}
_MODULI = (("storage", "$E'$", BLUE), ("loss", "$E''$", ORANGE))


def master_curve_figure(
    rubber: Rubber,
    master: MasterCurve | None = None,
    fit: PronyFit | None = None,
    excitation: ArrayLike = (),
) -> Figure:
    """Draw moduli [MPa] and loss factor against angular frequency.

    The Prony series of `rubber` is drawn as lines, dashed beyond the measured band; the measured
    points of `master` with those that `fit` left out as crosses; the angular frequencies
    `excitation` of the waves [rad/s] as marks on the curves.
    """
    omega = np.asarray(excitation, dtype=float)
    variables, attrs = rubber_variables(rubber, master, fit, omega)
    panels = moduli_panels(xr.Dataset(variables, attrs=attrs))
    if omega.size:
        at = rubber.complex_modulus(omega)
        look: dict[str, Any] = {"dash": "", "marker": "o", "size": 3.8, "filled": False}
        storage = Series(omega, at.real / MEGA, INK, "$\\omega_i$ of the waves", **look)
        loss = Series(omega, at.imag / MEGA, INK, **look)
        factor = Series(omega, at.imag / at.real, INK, **look)
        panels = [panels[0].with_marks([storage, loss]), panels[1].with_marks([factor])]
    sheet = Sheet(panels, 1, NARROW, 4.9, legend_columns=2, gap=0.02, layout=_TWO_TO_ONE)
    return sheet.on_paper()


def rubber_charts(inputs: xr.Dataset, excited: xr.Dataset | None) -> list[Chart]:
    """Return moduli and loss factor of the recorded inputs of a result.

    `excited` is the prediction of the chain whose waves are marked, if any.
    """
    panels = moduli_panels(inputs)
    if excited is not None:
        omega = excited["angular_frequency"].values
        values = excited["modulus"].values / MEGA, excited["loss_factor"].values
        labels = "$|E^*|$ of the waves", "waves"
        panels = [
            replace(
                panel.with_marks([Series(omega, value, INK, label, "", marker="D", filled=False)]),
                caption=f"{panel.caption} Diamonds: at the frequencies of the waves.",
            )
            for panel, value, label in zip(panels, values, labels, strict=True)
        ]
    return draw.panels_on_page(panels)


def moduli_panels(inputs: xr.Dataset) -> list[Panel]:
    """Return moduli and loss factor of recorded inputs."""
    omega = inputs["series_omega"].values
    ends = [inputs.attrs.get(f"band_{end}_rad_per_s") for end in ("low", "high")]
    low, high = ends[0] or 0.0, math.inf if ends[1] is None else ends[1]
    beyond = (omega < low) | (omega > high)
    measured = "master_frequency" in inputs
    moduli: list[Mark] = []
    for part, name, colour in _MODULI:
        if f"series_low_{part}" in inputs:
            sides = (f"series_{side}_{part}" for side in ("low", "high"))
            least, most = (inputs[side].values / MEGA for side in sides)
            moduli.append(ShadedBand(omega, least, most, colour, "admissible"))
        values = inputs[f"series_{part}"].values / MEGA
        moduli.append(Series(omega, values, colour, f"{name}, Prony series", beyond=beyond))
    for part, name, colour in _MODULI if measured else ():
        moduli += _rows(inputs, inputs[f"master_{part}"].values / MEGA, colour, name)
    factor = inputs["series_loss"].values / inputs["series_storage"].values
    loss: list[Mark] = [Series(omega, factor, GREEN, "loss factor, Prony series", beyond=beyond,
                               listed=False)]  # fmt: skip
    if measured:
        factor = inputs["master_loss"].values / inputs["master_storage"].values
        loss += _rows(inputs, factor, GREEN, "loss factor", listed=False)
    marked = [float(end) for end in ends if end is not None and 0.0 < end < math.inf]
    label = "ends of the measured band"
    borders = [CrossLine(end, GREY, label * (end == marked[0]), "dotted", 0.9, upright=True)
               for end in marked]  # fmt: skip
    return [
        Panel(
            OMEGA,
            MODULUS,
            [*moduli, *borders],
            name="master-curve",
            caption="Storage and loss modulus: measured, and the Prony series that is solved with.",
            alt="Storage and loss modulus against angular frequency on logarithmic axes.",
            height=400,
        ),
        Panel(
            OMEGA,
            LOSS_FACTOR,
            [*loss, *borders],
            name="loss-factor",
            caption="Loss factor: measured, and of the Prony series.",
            alt="Loss factor against angular frequency.",
            height=400,
        ),
    ]


def _rows(
    inputs: xr.Dataset, values: Array, colour: str, name: str, *, listed: bool = True
) -> Iterator[Series]:
    """Yield the measured rows, those left out of the fit as crosses."""
    omega = 2.0 * math.pi * inputs["master_frequency"].values
    out = inputs.get("master_left_out", xr.zeros_like(inputs.master_frequency)).values != 0
    yield Series(omega[~out], values[~out], colour, f"{name}, measured", "", marker=".", size=3.5,
                 alpha=0.6, listed=listed)  # fmt: skip
    if out.any():
        yield Series(omega[out], values[out], colour, "left out of the fit", "",
                     marker="x", listed=listed)  # fmt: skip


def measured_moduli_figure(master: MasterCurve) -> Figure:
    """Draw both moduli [MPa] and the loss factor of a master curve as measured."""
    omega = master.angular_frequency
    marks: dict[str, Any] = {"dash": "", "marker": ".", "size": 3.5}
    moduli: list[Mark] = [
        Series(omega, getattr(master, part) / MEGA, colour, name, **marks)
        for part, name, colour in _MODULI
    ]
    loss = [Series(omega, master.loss_factor, GREEN, **marks)]
    panels = [Panel(OMEGA, MODULUS, moduli), Panel(OMEGA, LOSS_FACTOR, loss)]
    return Sheet(panels, 1, NARROW, 4.9, gap=0.02, layout=_TWO_TO_ONE).on_paper()


def compound_moduli_figure(rubbers: Mapping[str, Rubber]) -> Figure:
    """Draw E' [MPa] and the loss factor of compounds, dashed beyond what was measured.

    The shade is what the measured moduli leave open of E'.
    """
    storage: list[Mark] = []
    loss: list[Mark] = []
    for (name, rubber), colour in zip(rubbers.items(), COLOURS, strict=False):
        omega = band(rubber, None, (), 300)
        modulus, beyond = rubber.complex_modulus(omega), rubber.outside_band(omega)
        if rubber.admissible is not None:
            low, high = rubber.complex_modulus_band(omega)
            storage.append(ShadedBand(omega, low.real / MEGA, high.real / MEGA, colour, alpha=0.15))
        storage.append(Series(omega, modulus.real / MEGA, colour, name, beyond=beyond))
        loss.append(Series(omega, modulus.imag / modulus.real, colour, beyond=beyond))
    panels = [
        Panel(OMEGA, PlotAxis("storage modulus $E'$ [MPa]", log=True), storage),
        Panel(OMEGA, PlotAxis("loss factor [-]", low=0.0), loss),
    ]
    layout = {"sharex": True}
    return Sheet(panels, 1, NARROW, 4.9, legend_columns=2, gap=0.02, layout=layout).on_paper()


def superposition_figure(sweeps: Sweeps, master: MasterCurve) -> Figure:
    """Draw the sweeps as measured and shifted: moduli [MPa] and loss factor by frequency [Hz].

    Raises `InputError` if their `master` curve has no shift.
    """
    if master.shift is None or master.reference_temperature is None:
        raise InputError("master must have a shift, as superpose gives it; got none")
    kelvin = temperatures_in(master.shift, sweeps.temperatures, sweeps.tolerance)
    factors = (of(kelvin, master.reference_temperature) for of in (master.shift.a, master.shift.b))
    shifted = [
        Sweep(sweep.temperature, sweep.frequency * a, sweep.storage * b, sweep.loss * b)
        for sweep, a, b in zip(sweeps, *factors, strict=True)
    ]
    celsius = master.reference_temperature - ZERO_CELSIUS
    columns = (
        (sweeps, "as measured", PlotAxis("frequency $f$ [Hz]", log=True)),
        (shifted, f"shifted to {celsius:.1f} °C", PlotAxis("$a_T f$ [Hz]", log=True, numbers=6)),
    )
    quantities: dict[str, Callable[[Sweep], Array]] = {
        "$E'$ [MPa]": lambda sweep: sweep.storage / MEGA,
        "$E''$ [MPa]": lambda sweep: sweep.loss / MEGA,
        "$E''/E'$ [-]": lambda sweep: sweep.loss / sweep.storage,
    }
    panels = [
        Panel(
            hertz,
            PlotAxis(label, log=True),
            [
                Series(sweep.frequency, of(sweep), colour, marker="o", size=2.2, width=0.8)
                for sweep, colour in _coloured(drawn, sweeps)
            ],
            title="" if row else title,
        )
        for row, (label, of) in enumerate(quantities.items())
        for drawn, title, hertz in columns
    ]
    layout = {"sharex": "col", "sharey": "row"}
    bar = _temperatures(sweeps)
    return Sheet(panels, height=6.2, gap=0.02, colour_bar=bar, layout=layout).on_paper()


def _temperatures(sweeps: Sweeps) -> ColourBar:
    celsius = sweeps.temperatures - ZERO_CELSIUS
    return ColourBar(celsius[0], celsius[-1], "Plasma", CELSIUS.label)


def _coloured(drawn: Iterable[Sweep], sweeps: Sweeps) -> Iterator[tuple[Sweep, str]]:
    """Yield sweeps with the colours of their temperatures among all `sweeps`."""
    kelvin, scale = sweeps.temperatures, shades(256, "Plasma")
    for sweep in drawn:
        share = (sweep.temperature - kelvin[0]) / max(kelvin[-1] - kelvin[0], 1e-9)
        yield sweep, scale[round(255 * min(max(share, 0.0), 1.0))]


def shift_figure(table: ShiftTable, fits: Sequence[ShiftFit] = ()) -> Figure:
    """Draw log10 a_T, with two standard errors, and log10 b_T by temperature, with formulas.

    Formulas `fits` to the `table` of factors are dashed beyond the temperatures fitted.
    """
    celsius = table.temperature - ZERO_CELSIUS

    def factors(values: Array, error: Array, label: str = "") -> Series:
        spread = 2.0 * np.nan_to_num(error)
        ends: dict[str, Any] = {"low": values - spread, "high": values + spread}
        return Series(celsius, values, INK, label, "", marker="o", size=3.2, **ends)

    shifts = [factors(table.horizontal, table.horizontal_error, "sweeps, two std. errors")]
    rest = [factors(np.zeros_like(celsius), table.horizontal_error)]
    for fit, colour in zip(fits, COLOURS, strict=False):
        fitted, lowest = fit.temperature, max(table.limits[0], fit.shift.limits[0])
        kelvin = np.linspace(lowest, table.limits[1], 200)
        # A formula of the glass alone runs through its rows, not through the reference.
        at = int(np.argmin(np.abs(table.temperature - fitted[0])))
        start = table.horizontal[at] - fit.residual[0]
        values = start + fit.shift.log_a(kelvin, float(fitted[0]))
        inside = (kelvin >= fitted[0]) & (kelvin <= fitted[-1])
        name = {"wlf": "WLF", "arrhenius": "Arrhenius"}[fit.shift.kind]
        for rows, dash, label in ((inside, "solid", name), (~inside, "dashed", "")):
            curve = np.where(rows, values, np.nan)
            shifts.append(Series(kelvin - ZERO_CELSIUS, curve, colour, label, dash, width=1.1))
        rest.append(Series(fitted - ZERO_CELSIUS, -fit.residual, colour, marker="o", size=2.5,
                           width=0.9))  # fmt: skip
    margin = 0.15 * max(float(np.ptp(table.horizontal)), 1.0)  # WLF has a pole
    ends = float(table.horizontal.min()) - margin, float(table.horizontal.max()) + margin
    panels = [
        Panel(CELSIUS, PlotAxis("$\\log_{10} a_T$ [-]", False, *ends), shifts, legend="best"),
        Panel(CELSIUS, PlotAxis("formula minus\nsweeps [-]"), rest),
    ]
    if (table.vertical != 0.0).any():
        lifted = [factors(table.vertical, table.vertical_error)]
        panels.append(Panel(CELSIUS, PlotAxis("$\\log_{10} b_T$ [-]"), lifted))
    layout = {"sharex": True, "height_ratios": [2.0, *[1.0] * (len(panels) - 1)]}
    height = 1.5 * len(panels) + 1.4
    return Sheet(panels, 1, NARROW, height, legend="", gap=0.02, layout=layout).on_paper()


def superposition_tests_figure(sweeps: Sweeps, report: Superposition) -> Figure:
    """Draw what needs no shift, and how neighbours meet once shifted.

    Van Gurp and Palmen's plot (phase angle by |E*|) and that of Cole and Cole (E'' by E') are one
    curve where horizontal shifts suffice; overlap and distance of neighbours by temperature, as the
    `report` of their superposition has them.
    """
    gurp: list[Mark] = []
    cole: list[Mark] = []
    for sweep, colour in _coloured(sweeps, sweeps):
        size = np.hypot(sweep.storage, sweep.loss) / MEGA
        angle = np.degrees(np.arctan2(sweep.loss, sweep.storage))
        for marks, x, y in ((gurp, size, angle), (cole, sweep.storage / MEGA, sweep.loss / MEGA)):
            marks.append(Series(x, y, colour, marker="o", size=2.2, width=0.8))
    overlaps = report.overlaps
    middle = np.array([0.5 * (pair.colder + pair.warmer) for pair in overlaps]) - ZERO_CELSIUS
    look: dict[str, Any] = {"marker": "o", "size": 3.2, "width": 0.9}
    apart = [
        Series(middle, [getattr(pair, name) for pair in overlaps], colour, label, **look)
        for name, label, colour in (*_MODULI, ("loss_factor", "$E''/E'$", GREEN))
    ]
    width = Series(middle, [pair.decades for pair in overlaps], INK, **look)
    panels = [
        Panel(PlotAxis("$|E^*|$ [MPa]", log=True), PlotAxis("phase angle [°]", low=0.0), gurp,
              "van Gurp and Palmen"),
        Panel(PlotAxis("$E'$ [MPa]", log=True), PlotAxis("$E''$ [MPa]", log=True), cole,
              "Cole and Cole"),
        Panel(CELSIUS, PlotAxis("overlap [decades]"), [width, CrossLine(0.0)],
              "overlap of neighbours"),
        Panel(CELSIUS, PlotAxis("rms distance [decades]", log=True), apart,
              "distance in the overlap",
              legend="best" if overlaps else ""),
    ]  # fmt: skip
    bar = replace(_temperatures(sweeps), first_row=True)
    return Sheet(panels, height=5.4, gap=0.02, legend="", colour_bar=bar).on_paper()


def softening_sheet(law: SofteningTable) -> Sheet:
    """Draw both moduli of strain sweeps, over those of the master curve, against strain [%]."""
    count = len(law.strain)
    labels = [f"{kelvin - ZERO_CELSIUS:.1f} °C" for kelvin in law.temperature or ()] or [""]
    strain = PlotAxis(f"strain amplitude, {law.deformation or 'tension or shear'} [%]", log=True)
    references = [law.reference(at) for at in range(count)]
    ends = "–".join(f"{100 * end:.3g}" for end in sorted({min(references), max(references)}))
    panels = []
    for row, (_, name, _) in enumerate(_MODULI):
        ratios = [law.of_sweep(at, strains)[row] for at, strains in enumerate(law.strain)]
        marks: list[Mark] = [
            Series(100.0 * np.array(law.strain[at]), ratios[at], colour, labels[at], marker="o",
                   size=2.5, width=0.9)
            for at, colour in enumerate(shades(count + 1, "Plasma")[:count])
        ]  # fmt: skip
        marks += [CrossLine(100.0 * at, GREY, dash="dotted", upright=True) for at in references]
        marks.append(CrossLine(1.0, GREY))
        panels.append(Panel(strain, PlotAxis(f"{name} over that at {ends} % [-]", low=0.0), marks))
    return Sheet(panels, legend_columns=min(count, 6))


def rubber_figures(prepared: MeasuredRubber, omega: ArrayLike, figures: FigureFolder) -> None:
    """Draw the master curve with the angular frequencies `omega` [rad/s] marked.

    Of sweeps at several temperatures also how they meet, and the shift factors.
    """
    sweeps, master, report = prepared.sweeps, prepared.master, prepared.superposition
    figure = master_curve_figure(prepared.rubber, master, prepared.fit, omega)
    figures.save(figure, "master_curve")
    if sweeps is None or master is None or report is None or len(sweeps) < 2:
        return
    figures.save(superposition_figure(sweeps, master), "superposition")
    figures.save(superposition_tests_figure(sweeps, report), "superposition_tests")
    if isinstance(master.shift, ShiftTable):
        figures.save(shift_figure(master.shift, prepared.shift_fits()), "shift")
