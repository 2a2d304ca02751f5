"""What decides the friction: which part of the master curve, and which other input.

result = gs.sensitivity(case, vary={"speed": [0.003, 0.3, 30.0]})
result.data.d_ln_friction_d_ln_loss.sum("frequency")
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.charts import draw
from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BLUE, GREEN, NARROW, ORANGE, PURPLE
from gripscale.core import Array, InputError, Quantity, Topic, checks, doubt
from gripscale.core.units import MEGA
from gripscale.experiment.design import solve_design
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sensitivity import contact_sensitivity
from gripscale.io.table import Column, Table, digits, fixed, least_to_most, percent
from gripscale.model import STATUS
from gripscale.questions import view
from gripscale.questions.answer.charts import (
    NamedTrace,
    height_figure,
    height_panels,
    named_traces,
)
from gripscale.questions.inputs import record
from gripscale.questions.result import Result
from gripscale.questions.sensitivity.friction_sensitivity import (
    FEEDBACK,
    LOSS,
    RULE_FREQUENCY,
    STORAGE,
    FrictionSensitivity,
    derivatives_of_answer,
    with_rules_of_thumb,
)
from gripscale.questions.vary.axis import axes_of
from gripscale.questions.vary.inputs import reading_notes
from gripscale.questions.vary.study import Study, coordinates
from gripscale.report.elements import Section
from gripscale.report.failures import failures_in, first_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The two moduli by the names of their derivatives: word, symbol in tables and in figures.
_MODULI = {LOSS: ("loss", "E″", "E''"), STORAGE: ("storage", "E′", "E'")}


def sensitivity_figure(data: xr.Dataset) -> Figure:
    """Draw the master curve, and an effect by decade of frequency below it for E'' and E'."""
    omega = data.modulus_frequency.values
    axis = PlotAxis("angular frequency $\\omega$ [rad/s]", True, float(omega[0]), float(omega[-1]))
    rules: list[Mark] = []
    if "rule" in data.dims:
        colours = zip(data.rule.values, data.rule_frequency.values, (GREEN, PURPLE), strict=False)
        rules = [
            CrossLine(float(at), colour, f"tan δ, {name}", "dotted", 0.9, upright=True)
            for name, at, colour in colours
            if omega[0] <= at <= omega[-1]
        ]
    moduli: list[Mark] = [
        Series(omega, data.storage_modulus.values / MEGA, BLUE, "$E'$"),
        Series(omega, data.loss_modulus.values / MEGA, ORANGE, "$E''$"),
    ]
    low = float(data.loss_modulus.min()) / MEGA / 2.0
    panels = [Panel(axis, PlotAxis("modulus [MPa]", log=True, low=low), [*moduli, *rules])]
    for name, (_, _, letter) in _MODULI.items():
        # bands that are not excited at a point have no derivative
        by_decade = data[name].where(data[name] != 0.0) * int(data.attrs["bands_per_decade"])
        flags = xr.DataArray(False)
        panel = view.panel(data.assign({name: by_decade}), name, "frequency", flags=flags)
        y = PlotAxis(f"friction by ${letter}$ [% for 1 %,\nper decade]")
        panels.append(replace(panel.with_marks([*rules, CrossLine(0.0)]), x=axis, y=y))
    layout = {"sharex": True, "height_ratios": [1.0, 0.9, 0.9]}
    return Sheet(panels, 1, NARROW, 6.4, gap=0.03, layout=layout).on_paper()


# Inputs at whose values derivatives are taken.
DERIVED_OVER = ("speed", "pressure", "temperature", "smallest_wavelength", "rubber", "surface")
_BY = "d_ln_friction_d_"
# Ends of the names of derivatives by one number, with their headings and units.
SCALARS = {
    "ln_pressure": ("pressure", "1"),
    "ln_speed": ("speed", "1"),
    "ln_cut_off": ("cut-off", "1"),
    "ln_bulk_modulus": ("bulk modulus", "1"),
    "temperature": ("temperature", "1/K"),
}
_MOST_POINTS = 6  # points that the table by decade has columns for
signed = fixed(2, "+")


def frequencies_of(effect: xr.DataArray, share: float) -> Array:
    """Return the frequencies between which a share of an effect lies, in its middle [rad/s]."""
    within = (np.cumsum(effect.values) - 0.5 * effect.values) / effect.values.sum()
    ends = np.interp([0.5 - 0.5 * share, 0.5 + 0.5 * share], within, np.log(effect.frequency))
    return np.asarray(np.exp(ends))


class Sensitivity(Result):
    """The derivatives of the friction of a case by all of its inputs."""

    kind = "sensitivity"

    @property
    def lines(self) -> Sequence[str]:
        data = self.data
        if STORAGE not in data:
            reasons = sorted({failure.sentence for failure in failures_in(self.data)})
            return [f"Answer: none. No contact was solved: {'; '.join(reasons)}"]
        loss, storage = (
            least_to_most(sign * data[name].sum("frequency"), digits(2))
            for name, sign in ((LOSS, 1.0), (STORAGE, -1.0))
        )
        load = " and ".join(view.load_in_words(data))
        lines = [
            f"Answer: 1 % more E″ gives {loss} % more friction; 1 % less E′ gives {storage} % more"
            f"{load and f', at {load}'}."
        ]
        for text, point in view.points(data):
            if np.isfinite(point[LOSS].values).all():
                low, high = frequencies_of(point[LOSS].clip(min=0.0), 0.5)
                where = f" at {text}" if data[LOSS].size > data.sizes["frequency"] else ""
                between = f"between {low:.2g} and {high:.2g} rad/s"
                lines.append(f"  half of the effect of E″{where} is {between}")
        return lines

    @property
    def failure(self) -> str:
        return first_of(failures_in(self.data), self.data[STATUS].size, "points")

    def parts(self) -> Iterator[str | Table]:
        if STORAGE not in self.data:
            return
        yield self.table()
        yield self.decades_table()
        if "rule" not in self.data.dims:
            yield "Without a temperature shift, tan δ at 0 °C and 60 °C have no place on this axis."
            return
        for i, name in enumerate(self.data.rule.values):
            shares = least_to_most(self.data.rule_share.isel(rule=i), percent)
            yield (
                f"The rule of thumb for {name} takes tan δ at "
                f"{float(self.data.rule_frequency[i]):.2g} rad/s ({RULE_FREQUENCY:g} Hz, shifted); "
                f"{shares} of the effect of E″ lies within half a decade of it."
            )

    def table(self) -> Table:
        """Return the derivatives by each input, the moduli summed over frequency."""
        listed = list(view.points(self.data))
        columns = [Column("point", [text for text, _ in listed], "")]
        for name, (key, symbol, _) in _MODULI.items():
            sums = self.data[name].sum("frequency").values.ravel()
            columns.append(Column(key, sums, symbol, format=signed))
        notes = ["Per cent of friction for a per cent of the input; of temperature, for a kelvin."]
        for end, group in (("", ""), (FEEDBACK, "with feedback")):
            for name, (heading, unit) in SCALARS.items():
                values = [float(point.get(f"{_BY}{name}{end}", np.nan)) for _, point in listed]
                size, unit_text = (0.01, "%/K") if unit == "1/K" else (1.0, "")
                if np.isfinite(values).any():
                    column = Column(f"{name}{end}", values, heading, unit_text, size, format=signed)
                    columns.append(replace(column, group=group))
        if f"{_BY}ln_speed{FEEDBACK}" in self.data:
            notes.append("With feedback strain and temperature of the rubber follow the change.")
        elif self.data.attrs["iterated"]:
            notes.append("Strain and temperature of the rubber stay; with feedback they follow.")
        return Table("sums", columns, "What the friction depends on", notes)

    def decades_table(self) -> Table:
        """Return what E'' and E' of each decade of frequency are worth, at the first few points."""
        decade = np.floor(np.log10(self.data.frequency.values) + 1e-9).astype(int)
        rows = np.arange(decade.min(), decade.max() + 1)
        listed = list(view.points(self.data))
        columns = [Column("decade", [f"1e{row} to 1e{row + 1}" for row in rows], "rad/s")]
        for i, (text, point) in enumerate(listed[:_MOST_POINTS]):
            unit = text if len(listed) > 1 else ""
            for name, (_, symbol, _) in _MODULI.items():
                values = [float(point[name].values[decade == row].sum()) for row in rows]
                columns.append(Column(f"{name}_{i}", values, symbol, unit, format=signed))
        notes = []
        if (rest := len(listed) - _MOST_POINTS) > 0:
            notes.append(f"{rest} more points are in the result file.")
        return Table("decades", columns, "What each decade of the master curve is worth", notes)

    def pictures(self) -> Iterator[Picture]:
        if STORAGE in self.data:
            yield Picture(
                "sensitivity",
                sensitivity_figure(self.data),
                "The master curve, and below it the per cent of friction for a per cent of E'' and "
                "E' in a decade of frequency. Factors on the friction, such as that from lines to "
                "a surface, do not change them.",
                "Three panels of curves against angular frequency.",
            )

    def figures(self) -> Iterator[tuple[str, Sheet | Figure]]:
        yield from super().figures()
        for number, (name, trace) in enumerate(self._traces, start=1):
            yield f"height_{number}", height_figure(trace, name)

    def chapters(self) -> Iterator[Section]:
        panels = [panel for name, trace in self._traces for panel in height_panels(trace, name)]
        yield Section("heights", "Which heights count", draw.panels_on_page(panels))

    @property
    def _traces(self) -> list[NamedTrace]:
        """Traces at the first point, which show what heights of the surface are worth."""
        if STORAGE not in self.data:
            return []
        return named_traces(
            self.data.isel(dict.fromkeys(view.dimensions(self.data), 0)), self.inputs
        )


@overload
def sensitivity(
    subject: RoughContact,
    *,
    bands_per_decade: int | None = ...,
    contact_fraction: bool = ...,
    reference_temperature: Quantity | None = ...,
) -> xr.Dataset: ...


@overload
def sensitivity(
    subject: Case,
    *,
    vary: Mapping[str, Any] | None = ...,
    bands_per_decade: int | None = ...,
    contact_fraction: bool = ...,
    with_feedback: bool = ...,
    folder: str | Path | None = ...,
    workers: int | None = ...,
    on_task: OnTask | None = ...,
) -> Sensitivity: ...


def sensitivity(
    subject: Case | RoughContact,
    *,
    vary: Mapping[str, Any] | None = None,
    bands_per_decade: int | None = None,
    contact_fraction: bool = False,
    with_feedback: bool = False,
    reference_temperature: Quantity | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Sensitivity | xr.Dataset:
    """Return the derivatives of the friction of a case, or of one direct contact.

    Raises `InputError` or `FileError` for what cannot be used; if the case is at rest, or has no
    measured surface.

        >>> f"{gs.sensitivity(contact).d_ln_friction_d_ln_loss.values.sum():.2f}"
        '0.91'

    Parameters
    ----------
    subject : Case or RoughContact
        A case in motion with a measured surface, or a contact of `gripscale.solve_rough_contact`.
        A contact takes `bands_per_decade`, `contact_fraction` and `reference_temperature` only.
    vary : mapping, optional
        One or two of `DERIVED_OVER`, as for a `Study`: the derivatives at each value.
    bands_per_decade : int, optional
        Bands of frequency in a decade; 4 of a case, 2 of a contact by default.
    contact_fraction : bool
        Also the derivatives of the contact fraction, from four further contacts a band.
    with_feedback : bool
        With softening or heat, also derivatives by speed, pressure and temperature with the answer
        of the rubber: six further solutions.
    reference_temperature : float, optional
        Temperature that the frequencies of a contact are shifted to [K].
    folder : path, optional
        Keeps each solution as soon as it is there: what was interrupted resumes.
    workers, on_task
        As for `gripscale.experiment.Bench`.

    Returns
    -------
    Sensitivity
        Over what is varied: the variables of `gripscale.half_space.contact_sensitivity` but for the
        heights, over `frequency` at the temperature of the master curve. Those with the end
        `_with_feedback` hold the answer of softening and heat. `storage_modulus` and
        `loss_modulus` [Pa] of the master curve over `modulus_frequency` [rad/s]; with a shift, over
        `rule`, the frequency that each rule of thumb stands for, and the share of the effect of E''
        within half a decade of it. Where nothing is varied, the derivatives by height in the traces
        of the profiles (`gripscale.half_space.location.traces_of`).
    xarray.Dataset
        Of a contact, see `gripscale.half_space.contact_sensitivity`.
    """
    if not isinstance(subject, Case):
        return contact_sensitivity(
            subject,
            bands_per_decade=2 if bands_per_decade is None else bands_per_decade,
            contact_fraction=contact_fraction,
            reference_temperature=reference_temperature,
        )
    case = subject
    if case.conditions is not None and case.conditions.water is not None:
        raise InputError("sensitivity has derivatives of dry contacts only: leave out the water")
    bands = 4 if bands_per_decade is None else bands_per_decade
    axes = {"speed": [case.load.speed]} if vary is None else dict(vary)
    for axis in axes_of(axes):
        checks.one_of("vary", axis.name, DERIVED_OVER)
        if axis.name == "speed" and min(axis.values) <= 0.0:
            raise InputError("speed must be above zero for derivatives of friction; got 0 m/s")
    conditions = case.chain.conditions
    model = FrictionSensitivity(
        conditions=conditions,
        bands_per_decade=bands,
        contact_fraction=contact_fraction,
        with_feedback=with_feedback,
        traces=vary is None,
    )
    study = Study(case, axes, model=model)
    with bench_in(folder, workers, None, on_task) as bench:
        data = solve_design(study.design, bench, derivatives_of_answer)
    data = data.assign_coords(coordinates(study.axes, case.units))
    if STORAGE in data:
        data = with_rules_of_thumb(
            data.fillna({STORAGE: 0.0, LOSS: 0.0}), study.measured_rubbers[0].rubber
        )
    attrs = {
        "title": "What decides the friction of a case",
        "model": "direct",
        "bands_per_decade": bands,
        "iterated": int(conditions is not None and conditions.iterated),
    }
    loads = [point.task.load for point in study.points]
    notes = [doubt(text, topic=Topic.RUBBER) for text in reading_notes(study.measured_rubbers)]
    inputs = record.inputs(case, study.surfaces, loads, notes)
    return Sensitivity(data.assign_attrs(case.attributes, **attrs), inputs)
