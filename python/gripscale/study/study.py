"""A study: one case with one or two of its inputs varied, into one Dataset.

    study = Study("case.toml", vary={"speed": "0.003:30:log9", "pressure": ["1 bar", "3 bar"]})
    result = study.run("results/speed_and_pressure")

Each prediction is kept as soon as it is made. A study that was stopped, however abruptly, goes on
where it was when it is run again, and ends in the same Dataset to the last bit.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale import netcdf, versions
from gripscale.case.read import CaseFile, read_case
from gripscale.chain.model import Chain
from gripscale.chain.solvers import wave_solver
from gripscale.errors import FileError
from gripscale.model import Model, NominalLoad
from gripscale.rubber import Rubber
from gripscale.study import assemble
from gripscale.study.assemble import Index
from gripscale.study.axes import Axis, axes_of
from gripscale.study.inputs import case_rubber, case_surface, rubber_of, surface_of
from gripscale.study.software import software
from gripscale.study.store import Store
from gripscale.study.task import Task, exact
from gripscale.study.threads import OnTask, solve_all
from gripscale.surface import PreparedSurface

RESULT = "study.nc"
"""The Dataset, in the folder of the study."""

PREDICTIONS = "predictions"
"""Folder of the finished predictions, in the folder of the study."""


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
        One or two of speed, pressure, smallest_wavelength (numbers in SI units, or texts with a
        unit), waves (whole numbers), factors (pairs of magnification factors, or "3.5/2.4"),
        rubber and surface (names and files, or a mapping from names to `Rubber`, `SineStack`,
        names and files), each with its values, or with a text as on the command line
        ("0.003:30:log9", "1 bar,3 bar"). A speed of zero is static contact.
    static
        Whether the relaxed rubber at rest is solved, too; as the case says by default.
    model
        What predicts; the chain with the solver of the case by default.

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
        model: Model | None = None,
    ) -> None:
        self.file = case if isinstance(case, CaseFile) else read_case(case)
        self.axes: tuple[Axis, ...] = axes_of(vary)
        self.static = self.file.case.load.static if static is None else static
        solver = self.file.case.solver
        self.model = model or Chain(wave_solver(solver.model, solver.options()))
        own = {axis.name: axis.values for axis in self.axes}
        self.surfaces: list[PreparedSurface] = [
            surface_of(value, self.file) for value in own.get("surface", ())
        ] or [case_surface(self.file)]
        self.rubbers: list[Rubber] = [
            rubber_of(value, self.file) for value in own.get("rubber", ())
        ] or [case_rubber(self.file)]
        self._varied: dict[Any, PreparedSurface] = {}

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
        tasks = {point.label: point.task for point in [*self.points, *self.static_points]}
        solved = solve_all(tasks, store, workers=workers, client=client, on_task=on_task)
        result = self.assemble(solved)
        netcdf.save(result, folder / RESULT)
        return result

    @staticmethod
    def stored(folder: str | Path) -> xr.Dataset | None:
        """Return the Dataset an earlier run left in `folder`, or None if there is none whole."""
        try:
            return netcdf.load(Path(folder) / RESULT)
        except FileError:
            return None

    def assemble(self, solved: Mapping[str, xr.Dataset]) -> xr.Dataset:
        """Return the Dataset of the study from its predictions by their keys."""
        moving = {point.index: solved[point.task.key] for point in self.points}
        rest = {point.index: solved[point.task.key] for point in self.static_points}
        rubbers = {point.index: point.task.rubber for point in self.points}
        result = assemble.combined(moving, self.axes)
        result = result.assign(assemble.by_decade(moving, self.axes, rubbers))
        if rest:
            at_rest = _at_rest(assemble.combined(rest, self.static_axes))
            result = xr.merge([result, at_rest], join="outer", compat="no_conflicts")
        result = result.assign_coords(assemble.coordinates(self.axes))
        return result.drop_attrs(deep=False).assign_attrs(self._provenance())

    def _points(self, axes: tuple[Axis, ...], *, static: bool) -> list[Point]:
        points = []
        for index in product(*(range(len(axis.values)) for axis in axes)):
            chosen = {axis.name: axis.values[i] for axis, i in zip(axes, index, strict=True)}
            place = {axis.name: i for axis, i in zip(axes, index, strict=True)}
            words = [
                f"{axis.name} {axis.labels[i]}{_unit(axis)}"
                for axis, i in zip(axes, index, strict=True)
            ]
            label = ", ".join(["static", *words] if static else words)
            points.append(Point(index, label, self._task(chosen, place, static=static)))
        return points

    def _task(self, chosen: dict[str, Any], place: dict[str, int], *, static: bool) -> Task:
        load = self.file.case.load
        speed = 0.0 if static else chosen.get("speed", load.speed)
        return Task(
            rubber=self.rubbers[place.get("rubber", 0)],
            surface=self._surface(place.get("surface", 0), chosen),
            load=NominalLoad(
                pressure=chosen.get("pressure", load.pressure),
                speed=speed,
                footprint=load.footprint,
                load_time=load.load_time if speed > 0.0 else "passage",
            ),
            model=self.model,
        )

    def _surface(self, number: int, chosen: dict[str, Any]) -> PreparedSurface:
        """Return the surface of a point; each choice of waves is fitted once."""
        changes = {
            name: chosen[name]
            for name in ("factors", "waves", "smallest_wavelength")
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
            "rubber_parameters": json.dumps(exact(self.rubbers)),
            "software": software(),
            "model": self.model.name,
            **versions.attributes(),
        }


def _at_rest(data: xr.Dataset) -> xr.Dataset:
    """Return what `data` says of rubber at rest, where there is no friction, as `static_...`."""
    moving = ("friction", "angular_frequency", "loss_factor", "load_time", "speed")
    names = [str(name) for name in data.data_vars if not any(word in str(name) for word in moving)]
    return data[names].rename({name: f"static_{name}" for name in names})


def _unit(axis: Axis) -> str:
    return f" {unit}" if axis.numeric and (unit := _UNIT.get(axis.name)) else ""


_UNIT = {"speed": "m/s", "pressure": "Pa", "smallest_wavelength": "m"}
