"""A study: one case with one or two of its inputs varied, into one Dataset.

    study = Study("case.toml", vary={"speed": "0.003:30:log9", "pressure": ["1 bar", "3 bar"]})
    result = study.run("results/speed_and_pressure")

Each prediction is kept as soon as it is made. A study that was stopped, however abruptly, goes on
where it was when it is run again, and ends in the same Dataset to the last bit.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case, fitted_for_load
from gripscale.core.described import Described
from gripscale.core.provenance import software
from gripscale.core.units import GIVEN
from gripscale.experiment.design import (
    OF_THE_CASE,
    SURFACE,
    Design,
    Point,
    basis_numbers,
    variable_attributes,
)
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.experiment.task import Task
from gripscale.half_space.model import JUDGED_TO
from gripscale.io import netcdf
from gripscale.model import METHOD, Model, input_doubts
from gripscale.questions.answer.variables import HYSTERESIS, described
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.vary import inputs
from gripscale.questions.vary.axis import VARIED_INPUTS, Axis, axes_of
from gripscale.questions.vary.friction_parts import (
    friction_by_decade,
    over_decades,
    waves_by_octave,
    with_decades,
)
from gripscale.questions.vary.inputs import AnswerModel
from gripscale.rubber import Rubber
from gripscale.surface import Surface

_LOAD = ("nominal_pressure", "nominal_speed", "footprint", "thickness")


def study_numbers(answer: xr.Dataset, task: Task) -> xr.Dataset:
    """Return what a study keeps: of the answer all but the load, of a model its numbers.

    These are by wave and of the whole surface, and what they rest on with its estimated errors.
    """
    if isinstance(task.model, AnswerModel):
        return answer.drop_vars(_LOAD, errors="ignore")
    names = [
        name
        for name, variable in answer.data_vars.items()
        if name in SURFACE
        or (variable.dims == ("scale",) and np.issubdtype(variable.dtype, np.number))
    ]
    # an axis may have the name of a variable over waves
    kept = answer[names].rename(
        {"temperature": "wave_temperature"} if "temperature" in names else {}
    )
    return kept.assign(basis_numbers(answer)).assign(
        over_decades(friction_by_decade(answer, task.rubber))
    )


def coordinates(axes: Iterable[Axis], units: Mapping[str, str]) -> dict[str, xr.Variable]:
    """Return the coordinates of the axes of a study of a case that states `units`."""
    coords = {}
    for axis in axes:
        kind, numeric = VARIED_INPUTS[axis.name], axis.numeric
        values = np.array(axis.values) if numeric else np.array(axis.labels, dtype=object)
        attrs = variable_attributes(kind.long_name, kind.unit if numeric else "1")
        display = axis.display_unit(units)
        attrs |= {} if display is None else {GIVEN: display.unit}
        attrs |= {"symbol": kind.symbol} if kind.symbol else {}
        coords[axis.name] = xr.Variable(axis.name, values, attrs)
    return coords


BEYOND_SHIFT = "rubber_temperature_extrapolated"
REDUCED_SPEED = "reduced_speed"


def beyond_shift(design: Design) -> dict[str, Any]:
    """Return where the temperature before the contact lies beyond those the shift rests on.

    Empty where no temperature is stated.
    """
    pairs = [(point.task.rubber, point.task.model.conditions) for point in design.points]
    if all(conditions is None or conditions.temperature is None for _, conditions in pairs):
        return {}
    before = [rubber if c is None else c.before(rubber) for rubber, c in pairs]
    flags = np.reshape([rubber.shift_extrapolated for rubber in before], [*design.sizes.values()])
    text = "whether the temperature lies beyond those the shift of the rubber rests on"
    return {BEYOND_SHIFT: ([*design.sizes], flags, variable_attributes(text))}


def with_master_curve(result: xr.Dataset, rubber: Rubber) -> xr.Dataset:
    """Return a study over speed and temperature with the reduced speed a_T v.

    The shift factors are those to the reference temperature of `rubber`.
    """
    assert rubber.shift is not None
    assert rubber.reference_temperature is not None
    kelvin, reference = result.temperature.values, rubber.reference_temperature
    for name, of, text in (
        ("shift_factor", rubber.shift.a, "horizontal shift factor a_T"),
        ("vertical_shift_factor", rubber.shift.b, "vertical factor b_T"),
    ):
        about = variable_attributes(f"{text} to {reference:g} K")
        result = result.assign_coords({name: ("temperature", of(kelvin, reference), about)})
    about = variable_attributes("reduced speed", "m/s") | {"symbol": "a_T v"}
    speed = (result.speed * result.shift_factor).assign_attrs(result.speed.attrs | about)
    return result.assign_coords({REDUCED_SPEED: speed})


class Study(Described):
    """A case with one or two of its inputs varied.

    Raises `InputError` or `FileError` for a value or a file that cannot be used.

    Parameters
    ----------
    case
        The case, prepared, read, or its file. What is not varied is as it says.
    vary
        One or two of `VARIED_INPUTS`, such as speed (numbers in SI units, or texts with a unit; a
        cut_off also "instrument", "rms_slope 1.3" or another `CutOffRule`), effects (of the
        conditions: "all", "no heat", "none"), rubber and surface (names and files, or a mapping
        from names to `Rubber`, `SineStack`, names and files), each with its values, or with a text
        as on the command line ("0.003:30:log9", "1 bar,3 bar"). A speed of zero is static contact.
    model
        What predicts: "direct", "chain" with the solver of the case, both under its conditions, or
        a model. Persson's theory without conditions gets those of the case, one that takes none
        the rubber at its temperature. By default the direct contact where every surface was
        measured, else the chain.
    tolerance
        Estimated relative error of a direct contact that is chosen by name or by default.
    """

    def __init__(
        self,
        case: Case,
        vary: Mapping[str, Any],
        *,
        model: Model | str | None = None,
        tolerance: float = JUDGED_TO,
    ) -> None:
        self.case = case
        self.axes: tuple[Axis, ...] = axes_of(vary)
        values = {axis.name: axis.values for axis in self.axes}
        surfaces = values.get("surface", (OF_THE_CASE,))
        self.surfaces = [inputs.surface_of(value, case) for value in surfaces]
        """The varied surfaces, or the one of the case."""
        rubbers = values.get("rubber", (OF_THE_CASE,))
        self.measured_rubbers = [inputs.measured_rubber_of(value, case) for value in rubbers]
        """The varied rubbers, or the one of the case, with what they come from."""
        if model is None:
            model = inputs.default_model(case, self.surfaces)
        self.model = inputs.model_of(model, case, tolerance)

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield the case, the model, and the number of values of each axis."""
        yield "case", self.case.title
        yield "model", self.model.name
        yield from ((axis.name, f"{len(axis.values)} values") for axis in self.axes)

    @cached_property
    def design(self) -> Design:
        """The points over the axes; nothing is solved if one of them is impossible."""
        case, points, sizes = self.case, [], {axis.name: len(axis.values) for axis in self.axes}
        fitted: dict[Any, Surface] = {}  # each choice of waves once
        for index in np.ndindex(*sizes.values()):
            at = dict(zip(sizes, index, strict=True))
            values: dict[str, Any] = {axis.name: axis.values[at[axis.name]] for axis in self.axes}
            setting = inputs.Setting(self.model, case.load)
            for name, varied in VARIED_INPUTS.items():
                if name in values and varied.change is not None:
                    setting = varied.change(setting, values[name])
            model, load = setting.model, setting.load
            if load.speed == 0.0:
                load = replace(load, load_time="passage")
            measured = self.measured_rubbers[at.get("rubber", 0)]
            if measured.rubber.name != case.rubber.name:
                model = inputs.for_rubber(model, measured.rubber)
            if model.conditions is not None:  # refuses a temperature without a shift
                model.conditions.before(measured.rubber)
            key = at.get("surface", 0), *setting.waves.items()
            if key not in fitted:
                fitted[key] = self.surfaces[key[0]].varied(**setting.waves)
            surface = fitted[key]
            conditions = model.conditions if model.takes_conditions else case.conditions
            # each point is the answer of a case with its load
            rubber = fitted_for_load(measured, surface, load, conditions).rubber
            if not model.takes_conditions and conditions is not None:
                rubber = conditions.before(rubber)
            words = [f"{axis.name} {axis.called(at[axis.name], case.units)}" for axis in self.axes]
            task = Task(rubber, surface, load, model)
            points.append(Point(index, ", ".join(words), task))
        return Design(sizes, points)

    @property
    def points(self) -> Sequence[Point]:
        """All points of `design`, last axis fastest."""
        return self.design.points

    def run(
        self,
        folder: str | Path | None = None,
        *,
        workers: int | None = None,
        client: Any = None,
        on_task: OnTask | None = None,
    ) -> xr.Dataset:
        """Solve what `folder` does not have yet, and write and return the Dataset.

        Raises `InputError` or `FileError` for an input that cannot be used, or a result that cannot
        be written.

        Parameters
        ----------
        folder : path, optional
            Gets `study.nc`, and the predictions in `predictions`. Studies may share a folder, one
            after the other: the last Dataset stays.
        workers, client, on_task
            As for `Bench`.
        """
        with bench_in(folder, workers, client, on_task) as bench:
            answers = bench.solve(self.design.tasks, study_numbers)
            data = self.assemble(answers).assign_attrs(kind="study")
        if folder is None:
            return data
        return netcdf.load_dataset(netcdf.save(data, Path(folder) / "study.nc"))

    def assemble(self, answers: Mapping[str, xr.Dataset]) -> xr.Dataset:
        """Return the Dataset of the study from its predictions by their keys."""
        result = with_decades(self.design.dataset(answers)).drop_vars("seconds")
        if {"friction", "wavelength"} <= set(result):
            result = result.assign(waves_by_octave(result))
        ends = [name for name in ("cutoff_wavelength", CONTINUED_TO) if name in result]
        for name in ends:  # stated once where all predictions have them in common
            common, *others = np.unique(result[name].values)
            result = result.drop_vars(name)
            if not others:
                attrs = variable_attributes("shortest wavelength of the roughness", "m")
                result[name] = (), common, attrs
        if HYSTERESIS in result:  # at rest an answer has no interface, and one friction
            both = result[HYSTERESIS].fillna(result["answer_friction"])
            result[HYSTERESIS] = both.assign_attrs(result[HYSTERESIS].attrs)
        if "factor_label" in result:
            result["factor_label"] = result["factor_label"].isel(
                dict.fromkeys(self.design.sizes, 0)
            )
        result = result.assign_coords(coordinates(self.axes, self.case.units))
        result = result.assign(beyond_shift(self.design))
        if {"speed", "temperature"} == {axis.name for axis in self.axes}:
            result = with_master_curve(result, self.measured_rubbers[0].rubber)
        return described(result).assign_attrs(self.attributes)

    @property
    def attributes(self) -> dict[str, Any]:
        """What the study is of; nothing in it depends on when or how often it was run."""
        load, model = self.case.load, self.model
        rubbers = [measured.rubber for measured in self.measured_rubbers]
        conditions = model.conditions if model.takes_conditions else self.case.conditions
        return {
            "title": "Study of real contact area and friction of rubber on a rough surface",
            **self.case.attributes,
            **input_doubts(
                [*self.surfaces, *self.measured_rubbers],
                [point.task.load for point in self.points],
                self.case.units,
                self.case.softening_doubts,
            ),
            "nominal_pressure": load.pressure,
            "nominal_speed": load.speed,
            "footprint": load.footprint,
            **({} if load.thickness is None else {"thickness": load.thickness}),
            "conditions": json.dumps(None if conditions is None else conditions.to_dict()),
            "surfaces": "; ".join(surface.source for surface in self.surfaces),
            "surface_measured": int(all(s.measured is not None for s in self.surfaces)),
            "rubbers": "; ".join(f"{rubber.name}: {rubber.source}" for rubber in rubbers),
            "rubber_parameters": json.dumps([rubber.to_dict() for rubber in rubbers]),
            "notes": "\n".join(
                dict.fromkeys(str(f) for surface in self.surfaces for f in surface.findings)
            ),
            "software": software(),
            "model": model.name,
            METHOD: json.dumps([*model.method]),
        }
