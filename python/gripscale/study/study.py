"""A study: one case with one or two of its inputs varied, into one Dataset.

    study = Study("case.toml", vary={"speed": "0.003:30:log9", "pressure": ["1 bar", "3 bar"]})
    result = study.run("results/speed_and_pressure")

Each chain is kept as soon as it is solved. A study that was stopped, however abruptly, goes on
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

from gripscale import dataset
from gripscale.case import CaseFile, read_case
from gripscale.rubber import Rubber
from gripscale.study import assemble
from gripscale.study.assemble import Index
from gripscale.study.axes import Axis, axes_of
from gripscale.study.inputs import Road, case_road, case_rubber, road_of, rubber_of
from gripscale.study.solving import OnCase, solve_all
from gripscale.study.store import Store
from gripscale.study.task import Task, exact, software
from gripscale.surface import SineStack

RESULT = "study.nc"
"""The Dataset, in the folder of the study."""

CASES = "cases"
"""Folder of the finished chains, in the folder of the study."""


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
    ) -> None:
        self.file = case if isinstance(case, CaseFile) else read_case(case)
        self.axes: tuple[Axis, ...] = axes_of(vary)
        self.static = self.file.case.load.static if static is None else static
        own = {axis.name: axis for axis in self.axes}
        surfaces = own["surface"].values if "surface" in own else ()
        rubbers = own["rubber"].values if "rubber" in own else ()
        self.roads: list[Road] = [road_of(value, self.file) for value in surfaces] or [
            case_road(self.file)
        ]
        self.rubbers: list[Rubber] = [rubber_of(value, self.file) for value in rubbers] or [
            case_rubber(self.file)
        ]
        self._stacks: dict[tuple[Any, ...], SineStack] = {}

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
        on_case: OnCase | None = None,
    ) -> xr.Dataset:
        """Solve what `folder` does not have yet, and write and return the Dataset.

        Parameters
        ----------
        folder
            Gets `study.nc`, and the chains in `cases`. Several studies may share one folder for
            their chains, one after the other; the last one's Dataset stays.
        workers, client, on_case
            As for `solve_all`.

        Returns
        -------
        xarray.Dataset
            Per wave and in total, over the varied axes; at rest with the prefix `static_`.
            A chain that did not converge has NaN totals and says why in `case_status`.

        Raises
        ------
        InputError, FileError
            An input that cannot be used, a result that cannot be written.
        """
        folder = Path(folder)
        store = Store(folder / CASES)
        tasks = {point.label: point.task for point in [*self.points, *self.static_points]}
        solved = solve_all(tasks, store, workers=workers, client=client, on_case=on_case)
        result = self.assemble(solved)
        dataset.save(result, folder / RESULT)
        return result

    def assemble(self, solved: Mapping[str, xr.Dataset]) -> xr.Dataset:
        """Return the Dataset of the study from its chains by their keys."""
        moving = {point.index: solved[point.task.key] for point in self.points}
        rest = {point.index: solved[point.task.key] for point in self.static_points}
        rubbers = {point.index: point.task.rubber for point in self.points}
        data = {
            **assemble.totals(moving, self.axes),
            **assemble.per_wave(moving, self.axes),
            **assemble.by_decade(moving, self.axes, rubbers),
        }
        if rest:
            data |= _at_rest(assemble.totals(rest, self.static_axes))
            data |= _at_rest(assemble.per_wave(rest, self.static_axes))
        waves = max(cell.sizes["scale"] for cell in [*moving.values(), *rest.values()])
        data = {name: _padded(variable, waves) for name, variable in data.items()}
        return xr.Dataset(
            data, coords=assemble.coordinates(self.axes, waves), attrs=self._provenance()
        )

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
        case = self.file.case
        speed = 0.0 if static else chosen.get("speed", case.load.speed)
        return Task(
            rubber=self.rubbers[place.get("rubber", 0)],
            sines=self._stack(place.get("surface", 0), chosen),
            pressure=chosen.get("pressure", case.load.pressure),
            speed=speed,
            footprint=case.load.footprint,
            load_time=case.load.load_time if speed > 0.0 else "passage",
            model=case.solver.model,
            options=case.solver.options(),
        )

    def _stack(self, road: int, chosen: dict[str, Any]) -> SineStack:
        """Return the waves of a point; each is fitted once."""
        changes = {
            name: chosen[name]
            for name in ("factors", "waves", "smallest_wavelength")
            if name in chosen
        }
        key = (road, *sorted(changes.items()))
        if key not in self._stacks:
            self._stacks[key] = self.roads[road].stack(**changes)
        return self._stacks[key]

    def _provenance(self) -> dict[str, Any]:
        """Return what the study is of; nothing in it depends on when or how often it was run."""
        return {
            "title": "Study of real contact area and friction of rubber on a rough surface",
            "case": self.file.text,
            "varied": json.dumps({axis.name: list(axis.labels) for axis in self.axes}),
            "surfaces": "; ".join(road.source for road in self.roads),
            "rubbers": "; ".join(f"{rubber.name}: {rubber.source}" for rubber in self.rubbers),
            "rubber_parameters": json.dumps(exact(self.rubbers)),
            "software": software(),
            "method": f"{dataset.LW}, equations 1 to 3",
            **{f"version_{name}": version for name, version in dataset.versions().items()},
        }


def _at_rest(data: dict[str, xr.DataArray]) -> dict[str, xr.DataArray]:
    """Return what `data` says of rubber at rest, where there is no friction, as `static_...`."""
    moving = ("friction", "angular_frequency", "loss_factor", "load_time")
    return {
        f"static_{name}": variable
        for name, variable in data.items()
        if not any(word in name for word in moving)
    }


def _padded(variable: xr.DataArray, waves: int) -> xr.DataArray:
    """Return `variable` with NaN for waves it does not have."""
    if "scale" not in variable.dims or variable.sizes["scale"] == waves:
        return variable
    return variable.pad(scale=(0, waves - variable.sizes["scale"]), keep_attrs=True)


def _unit(axis: Axis) -> str:
    return f" {unit}" if axis.numeric and (unit := _UNIT.get(axis.name)) else ""


_UNIT = {"speed": "m/s", "pressure": "Pa", "smallest_wavelength": "m"}
