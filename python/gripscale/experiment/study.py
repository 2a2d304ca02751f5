"""A study: one case with one or two of its inputs varied, into one Dataset.

    study = Study("case.toml", vary={"speed": "0.003:30:log9", "pressure": ["1 bar", "3 bar"]})
    result = study.run("results/speed_and_pressure")

Each prediction is kept as soon as it is made. A study that was stopped, however abruptly, goes on
where it was when it is run again, and ends in the same Dataset to the last bit.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case.prepare import prepare_conditions
from gripscale.case.read import CaseFile, read_case
from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions
from gripscale.core import provenance
from gripscale.core.errors import FileError, InputError
from gripscale.core.provenance import software
from gripscale.core.units import GIVEN
from gripscale.experiment.axis import LONG_NAMES, UNITS, Axis, axes_of
from gripscale.experiment.inputs import (
    at_temperature,
    case_rubber,
    case_surface,
    contents,
    model_of,
    rubber_before,
    rubber_of,
    stated_by,
    surface_of,
    with_effects,
)
from gripscale.experiment.solve import OnTask, Progress, solve_all
from gripscale.experiment.speed_and_temperature import (
    beyond_shift,
    friction_by_decade,
    with_master_curve,
)
from gripscale.experiment.task import PREDICTIONS, Store, Task, canonical_json
from gripscale.io import netcdf
from gripscale.model import (
    ADHESIVE_FRICTION,
    CUT_OFF_EXPONENTS,
    OUTSIDE_BAND,
    TOTALS,
    WHY_NO_EXPONENT,
    Model,
)
from gripscale.rubber import Rubber
from gripscale.surface import PreparedSurface

# From the finished predictions of a study to one Dataset over the axes that were varied.

RENAMED = {"temperature": "wave_temperature"}
"""Variables over waves that have the name of an axis."""

Index = tuple[int, ...]
Predictions = dict[Index, xr.Dataset]

OF_ALL = (
    *TOTALS,
    ADHESIVE_FRICTION,
    *OUTSIDE_BAND,
    *CUT_OFF_EXPONENTS,
    WHY_NO_EXPONENT,
    "prediction_status",
)
"""What every model says of the whole surface."""


def combined(predictions: Predictions, axes: Sequence[Axis]) -> xr.Dataset:
    """Return every number the predictions have, in total and per wave, over `axes`.

    Predictions with fewer waves, and waves after one that failed, are NaN.
    """
    kept = {index: _kept(data) for index, data in predictions.items()}
    nested: Any = np.empty(tuple(len(axis.values) for axis in axes), dtype=object)
    for index, data in kept.items():
        nested[index] = data
    names = [axis.name for axis in axes]
    together: xr.Dataset = xr.combine_nested(
        nested.tolist(),
        concat_dim=names,
        data_vars="all",
        coords="minimal",
        compat="override",
        join="outer",
        combine_attrs="override",
    )
    result: xr.Dataset = together.transpose(*names, ...).drop_attrs(deep=False)
    return result


def by_decade(
    predictions: Predictions, axes: Sequence[Axis], rubbers: dict[Index, Rubber]
) -> dict[str, xr.DataArray]:
    """Return the friction by decade of relaxation time, over `axes` and `decade`."""
    parts = {index: friction_by_decade(one, rubbers[index]) for index, one in predictions.items()}
    found = sorted({n for part in parts.values() for n in part})
    if not found:
        return {}
    decades = range(found[0], found[-1] + 1)
    values = np.full((*(len(axis.values) for axis in axes), len(decades)), np.nan)
    for index, part in parts.items():
        if part:
            values[index] = [part.get(n, 0.0) for n in decades]
    dims = (*(axis.name for axis in axes), "decade")
    array = _labelled(
        dims, values, "1", "friction coefficient by relaxation time, split as at small strain"
    )
    time = _labelled(
        "decade", [10.0**n for n in decades], "s", "shortest relaxation time of the decade"
    )
    return {"friction_by_decade": array.assign_coords(decade=time)}


def coordinates(axes: Iterable[Axis], case: str) -> dict[str, xr.DataArray]:
    """Return the coordinates of the axes of a study of this text of a case."""
    out = {}
    for axis in axes:
        values = np.array(axis.coordinate, dtype=None if axis.numeric else object)
        out[axis.name] = _labelled(
            axis.name, values, UNITS[axis.name] if axis.numeric else "1", LONG_NAMES[axis.name]
        )
        how = axis.shown(case)
        if how is not None:
            out[axis.name].attrs[GIVEN] = how.unit
        if axis.name == "factors":
            for at, name in enumerate(("s_wavelength", "s_amplitude")):
                each = [pair[at] for pair in axis.values]
                out[name] = _labelled("factors", each, "1", f"magnification factor {name}")
    return out


def _kept(data: xr.Dataset) -> xr.Dataset:
    """Return what a study keeps of a prediction: one number a wave, and what is said of all."""
    names = [
        name
        for name, variable in data.data_vars.items()
        if name in OF_ALL
        or (variable.dims == ("scale",) and np.issubdtype(variable.dtype, np.number))
    ]
    key = xr.DataArray(
        data.attrs["prediction_key"],
        attrs={"units": "1", "long_name": "name of the file the prediction is kept in"},
    )
    kept = data[names].assign(prediction_key=key).drop_encoding()
    return kept.rename({old: new for old, new in RENAMED.items() if old in kept})


def _labelled(dims: Any, values: Any, unit: str, long_name: str) -> xr.DataArray:
    return xr.DataArray(
        np.asarray(values), dims=dims, attrs={"units": unit, "long_name": long_name}
    )


RESULT = "study.nc"
"""The Dataset, in the folder of the study."""


@dataclass(frozen=True)
class Point:
    """One point of a study: where it is on the axes, what it is called, what is solved there."""

    index: Index
    label: str
    task: Task


class Study:
    """A case with one or two of its inputs varied.

    Parameters
    ----------
    case
        The case, or its file. What is not varied is as it says.
    vary
        One or two of speed, pressure, temperature, smallest_wavelength, cut_off (numbers in SI
        units, or texts with a unit; a cut_off also "instrument", "rms_slope 1.3" or another
        `CutOffRule`), upper_share (numbers), waves, pressure_classes (whole numbers), factors
        (pairs of magnification factors, or "3.5/2.4"), effects (of the conditions: "all",
        "no heat", "none"), rubber and surface (names and files, or a mapping from names to
        `Rubber`, `SineStack`, names and files), each with its values, or with a text as on the
        command line ("0.003:30:log9", "1 bar,3 bar"). A speed of zero is static contact.
    static
        Whether the relaxed rubber at rest is solved, too; as the case says by default.
    model
        What predicts: "chain" with the solver of the case, "direct", both under its conditions, or
        a model. One that takes no conditions gets the rubber at the temperature of the case.

    Raises
    ------
    InputError, FileError
        A value or a file that cannot be used.
    """

    def __init__(
        self,
        case: CaseFile | str | Path,
        vary: Mapping[str, Any],
        *,
        static: bool | None = None,
        model: Model | str = "chain",
    ) -> None:
        self.file = case if isinstance(case, CaseFile) else read_case(case)
        self.axes: tuple[Axis, ...] = axes_of(vary)
        self.static = self.file.case.load.static if static is None else static
        self.model = model_of(model, self.file)
        for value in self._values("temperature"):
            at_temperature(self.model, value)
        for value in self._values("effects"):
            with_effects(self.model, value)
        if "pressure_classes" in vary and not isinstance(self.model, Chain):
            raise InputError(
                f"pressure_classes belongs to the chain; got the model {self.model.name}"
            )
        self._varied: dict[Any, PreparedSurface] = {}

    @cached_property
    def surfaces(self) -> list[PreparedSurface]:
        """The varied surfaces, or the one of the case, read and fitted."""
        given = self._values("surface")
        return [surface_of(value, self.file) for value in given] or [case_surface(self.file)]

    @cached_property
    def rubbers(self) -> list[Rubber]:
        """The varied rubbers, or the one of the case, read and fitted."""
        given = self._values("rubber")
        return [rubber_of(value, self.file) for value in given] or [case_rubber(self.file)]

    @cached_property
    def _case_conditions(self) -> Conditions | None:
        return prepare_conditions(self.file.case.conditions, self.file.resolve)

    def _values(self, name: str) -> tuple[Any, ...]:
        return next((axis.values for axis in self.axes if axis.name == name), ())

    @cached_property
    def key(self) -> str:
        """A hash of all the study depends on, its files unread but for their bytes."""
        named = {name: self._values(name) for name in ("surface", "rubber")}
        stated = {
            "software": software(),
            "case": contents(self.file),
            "axes": {axis.name: axis.labels for axis in self.axes},
            "values": {
                axis.name: canonical_json(axis.values)
                for axis in self.axes
                if axis.name not in named
            },
            "named": {n: [stated_by(v, self.file) for v in vs] for n, vs in named.items()},
            "static": self.static,
            "model": canonical_json(self.model),
        }
        return hashlib.sha256(json.dumps(stated, sort_keys=True).encode()).hexdigest()

    def description(self) -> list[str]:
        """Return in words what is varied, and on what."""
        count = len({point.task.key for point in [*self.points, *self.static_points]})
        names = " x ".join(f"{axis.name} ({len(axis.values)})" for axis in self.axes)
        return [
            f"Study of {self.file.path}",
            f"  varied: {names}; {count} different predictions",
            *(f"  surface: {one.source}, {len(one.sines)} sine waves" for one in self.surfaces),
            *(f"  rubber: {rubber.name}, {rubber.source}" for rubber in self.rubbers),
        ]

    @cached_property
    def points(self) -> list[Point]:
        """All points in motion (or at rest, where the speed is zero), last axis fastest."""
        return self._points(self.axes, static=False)

    @cached_property
    def static_axes(self) -> tuple[Axis, ...]:
        """The axes without speed, on which contact at rest does not depend."""
        return tuple(axis for axis in self.axes if axis.name != "speed")

    @cached_property
    def static_points(self) -> list[Point]:
        """All points of the rubber at rest; none if they are not wanted."""
        return self._points(self.static_axes, static=True) if self.static else []

    def run(
        self,
        folder: str | Path,
        *,
        workers: int | None = None,
        client: Any = None,
        on_task: OnTask | None = None,
    ) -> xr.Dataset:
        """Solve what `folder` does not have yet, and write and return the Dataset.

        Parameters
        ----------
        folder
            Gets `study.nc`, and the predictions in `predictions`. Several studies may share one
            folder for their predictions, one after the other; the last one's Dataset stays.
        workers, client, on_task
            As for `solve_all`.

        Returns
        -------
        xarray.Dataset
            Per wave and in total, over the varied axes; at rest with the prefix `static_`.
            A prediction that did not converge has NaN totals and says why in `prediction_status`.

        Raises
        ------
        InputError, FileError
            An input that cannot be used, a result that cannot be written.
        """
        folder = Path(folder)
        store = Store(folder / PREDICTIONS)
        known = self.stored(folder)
        if known is not None and self._all_there(known, store, on_task):
            return known
        tasks = {point.label: point.task for point in [*self.points, *self.static_points]}
        solved = solve_all(tasks, store, workers=workers, client=client, on_task=on_task)
        return netcdf.load(netcdf.save(self.assemble(solved), folder / RESULT))

    def stored(self, folder: str | Path) -> xr.Dataset | None:
        """Return the Dataset an earlier run of just this study left in `folder`, or None."""
        try:
            found = netcdf.load(Path(folder) / RESULT)
        except FileError:
            return None
        return found if found.attrs.get("study_key") == self.key else None

    def _all_there(self, known: xr.Dataset, store: Store, on_task: OnTask | None) -> bool:
        """Tell of every prediction as stored, if none of `known` is missing or damaged."""
        wanted: dict[str, str] = {}
        for prefix, axes in (("", self.axes), ("static_", self.static_axes)):
            if f"{prefix}prediction_key" in known:
                for index, label in self._places(axes, static=bool(prefix)):
                    wanted.setdefault(str(known[f"{prefix}prediction_key"].values[index]), label)
        found = {key: store.get(key) for key in wanted}
        if any(one is None for one in found.values()):
            return False
        for number, (key, one) in enumerate(found.items(), start=1):
            if on_task is not None and one is not None:
                on_task(Progress(number, len(found), wanted[key], one, 0.0, stored=True))
        return True

    def assemble(self, solved: Mapping[str, xr.Dataset]) -> xr.Dataset:
        """Return the Dataset of the study from its predictions by their keys."""
        moving = {point.index: solved[point.task.key] for point in self.points}
        rest = {point.index: solved[point.task.key] for point in self.static_points}
        rubbers = {point.index: point.task.rubber for point in self.points}
        result = combined(moving, self.axes)
        result = result.assign(by_decade(moving, self.axes, rubbers))
        if rest:
            at_rest = _at_rest(combined(rest, self.static_axes))
            result = xr.merge([result, at_rest], join="outer", compat="no_conflicts")
        result = result.assign_coords(coordinates(self.axes, self.file.text))
        result = result.assign(beyond_shift([p.task for p in self.points], self.axes))
        if {"speed", "temperature"} == {axis.name for axis in self.axes}:
            result = with_master_curve(result, self.rubbers[0])
        return result.drop_attrs(deep=False).assign_attrs(self._provenance())

    def _places(self, axes: tuple[Axis, ...], *, static: bool) -> Iterator[tuple[Index, str]]:
        """Yield where each point is on the axes, and what it is called."""
        for index in product(*(range(len(axis.values)) for axis in axes)):
            words = [
                f"{axis.name} {axis.called(i, self.file.text)}"
                for axis, i in zip(axes, index, strict=True)
            ]
            yield index, ", ".join(["static", *words] if static else words)

    def _points(self, axes: tuple[Axis, ...], *, static: bool) -> list[Point]:
        points = []
        for index, label in self._places(axes, static=static):
            chosen = {axis.name: axis.values[i] for axis, i in zip(axes, index, strict=True)}
            place = {axis.name: i for axis, i in zip(axes, index, strict=True)}
            points.append(Point(index, label, self._task(chosen, place, static=static)))
        return points

    def _task(self, chosen: dict[str, Any], place: dict[str, int], *, static: bool) -> Task:
        load = self.file.case.load.nominal
        speed = 0.0 if static else chosen.get("speed", load.speed)
        model, rubber = self._model(chosen), self.rubbers[place.get("rubber", 0)]
        if not model.takes_conditions and self._case_conditions is not None:
            rubber = self._case_conditions.before(rubber)
        rubber_before(rubber, model)  # nothing is solved if one point of the study is impossible
        return Task(
            rubber=rubber,
            surface=self._surface(place.get("surface", 0), chosen),
            load=replace(
                load,
                pressure=chosen.get("pressure", load.pressure),
                speed=speed,
                load_time=load.load_time if speed > 0.0 else "passage",
            ),
            model=model,
        )

    def _model(self, chosen: dict[str, Any]) -> Model:
        model = self.model
        if "pressure_classes" in chosen and isinstance(model, Chain):
            model = replace(model, pressure_classes=chosen["pressure_classes"])
        if "temperature" in chosen:
            model = at_temperature(model, chosen["temperature"])
        return with_effects(model, chosen["effects"]) if "effects" in chosen else model

    def _surface(self, number: int, chosen: dict[str, Any]) -> PreparedSurface:
        """Return the surface of a point; each choice of waves is fitted once."""
        changes = {
            name: chosen[name]
            for name in ("factors", "waves", "smallest_wavelength", "cut_off", "upper_share")
            if name in chosen
        }
        key = (number, *sorted(changes.items()))
        if key not in self._varied:
            self._varied[key] = self.surfaces[number].varied(**changes)
        return self._varied[key]

    def _provenance(self) -> dict[str, Any]:
        """Return what the study is of; nothing in it depends on when or how often it was run."""
        return {
            "title": "Study of real contact area and friction of rubber on a rough surface",
            "case": self.file.text,
            "varied": json.dumps({axis.name: list(axis.labels) for axis in self.axes}),
            "surfaces": "; ".join(surface.source for surface in self.surfaces),
            "rubbers": "; ".join(f"{rubber.name}: {rubber.source}" for rubber in self.rubbers),
            "rubber_parameters": json.dumps(canonical_json(self.rubbers)),
            "notes": "\n".join(dict.fromkeys(n for one in self.surfaces for n in one.notes)),
            "software": software(),
            "study_key": self.key,
            "description": json.dumps(self.description()),
            "model": self.model.name,
            **provenance.attributes(),
        }


def _at_rest(data: xr.Dataset) -> xr.Dataset:
    """Return what `data` says of rubber at rest, where there is no friction, as `static_...`."""
    moving = (
        "friction",
        "angular_frequency",
        "loss_factor",
        "load_time",
        "speed",
        "_band",
        "_missing",
    )
    names = [str(name) for name in data.data_vars if not any(word in str(name) for word in moving)]
    return data[names].rename({name: f"static_{name}" for name in names})
