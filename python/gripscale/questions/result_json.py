"""A result for other programs: its answers as one flat table, and all of it as JSON.

Every number is in SI units. A number that is missing or infinite is null, as JSON has no NaN.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import NamedFile
from gripscale.core.finding import sentences
from gripscale.core.provenance import version_of
from gripscale.core.units import si_unit
from gripscale.io.table import Column, Table
from gripscale.model import STATUS, input_doubts_of
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.reliance import no_answer
from gripscale.questions.answer.variables import ANSWER_NUMBERS, answer_number, has_answer
from gripscale.questions.result import Result

# Numbers of which a result has a row for each value: the first that is in it counts.
ROWS = (STATUS, "status", "gain", "force")
DOUBTS = "not_to_rely_on"
# Columns behind those that name the row.
FIRST = (
    *("model", "answer_friction", "answer_friction_low", "answer_friction_high"),
    *("answer_contact_fraction", "answer_contact_fraction_low", "answer_contact_fraction_high"),
    *("total_friction", "total_contact_fraction", STATUS, DOUBTS, "nominal_pressure"),
    *("nominal_speed", "footprint"),
)
# Attributes of a result that are columns.
ABOUT = (
    *("model", "nominal_pressure", "nominal_speed", "footprint", "conditions", "rubber"),
    *("rubber_source", "surface_source", "rubbers", "surfaces", "case_file", "command"),
)
_UNITS = {"nominal_pressure": "Pa", "nominal_speed": "m/s", "footprint": "m"}
LEFT_OUT = ("prediction_key", "seconds")


def summary_table(data: xr.Dataset) -> Table:
    """Return the answers of a result as one flat table: a row for each, all its numbers in it.

    A row is a place on the dimensions of the status of a result: a prediction, a model of a
    comparison, a point of a study. An answer stands in the row of the direct contact.
    """
    rows = data[next(name for name in ROWS if name in data)]  # each of its values is a row
    numbered = {dim: np.arange(n) for dim, n in rows.sizes.items() if dim not in data.coords}
    full, speed = data.assign_coords(numbered), data.get("nominal_speed")
    columns = {}
    for key, number in full.variables.items():
        name = str(key)
        if name.endswith(LEFT_OUT) or not set(number.dims) <= set(rows.dims):
            continue
        values = full[name].broadcast_like(rows)
        if speed is not None and name.startswith(("answer_friction", "total_friction")):
            values = values.where(speed > 0.0)
        if name in ANSWER_NUMBERS and "model" in {*rows.dims} - {*number.dims}:
            values = values.where(full["model"] == DIRECT)
        unit = str(number.attrs.get("units", "")) if number.dtype.kind in "fiu" else ""
        of_rows = values.transpose(*rows.dims).values.astype(object).ravel()
        columns[name] = Column(name, of_rows, unit=unit)
    texts = {name: data.attrs.get(name) for name in ABOUT}
    texts[DOUBTS] = no_answer(data) if has_answer(data) else sentences(input_doubts_of(data))
    for name, value in texts.items():
        varied = {name, name.removeprefix("nominal_")} & columns.keys()
        if not varied and value not in (None, "", "null"):
            columns[name] = Column(name, [value] * rows.size, unit=_UNITS.get(name, ""))
    order = {name: at for at, name in reversed([*enumerate([*map(str, rows.dims), *FIRST])])}
    return Table("summary", sorted(columns.values(), key=lambda c: order.get(c.name, len(order))))


FORMAT = 2  # number of the layout; it rises when a name changes or goes


def result_as_json(result: Result, case: str = "", files: Sequence[NamedFile] = ()) -> str:
    """Return a result as JSON, with the name of its `case` and the files that this names."""
    data = result.data
    answer: dict[str, Any] = {"text": [line.strip() for line in result.lines]}
    if has_answer(data):
        answer["reliable"] = not no_answer(data)
        for name in ("friction", "hysteresis_friction", "interface_friction", "contact_fraction"):
            if f"answer_{name}" in data:
                number = answer_number(data, name)
                answer[name], answer[f"{name}_interval"] = number.value, number[1:]
    content = {
        "format": FORMAT,
        "gripscale": version_of("gripscale"),
        "question": result.kind,
        "case": case,
        "command": data.attrs.get("command", ""),
        "answer": answer,
        "findings": [asdict(f) | {"topic": f.topic.name.lower()} for f in result.findings],
        "failure": result.failure,
        "table": _table(result.table()),
        "summary": _table(summary_table(data)),
        "inputs": [asdict(file) for file in files],
    }
    return json.dumps(_plain(content), ensure_ascii=False, indent=1, allow_nan=False)


def _table(table: Table) -> dict[str, Any]:
    """Return a table as rows of numbers by the names of its columns, with their units."""
    units = {column.name: si_unit(column.unit, column.size) for column in table.columns}
    names = [column.name for column in table.columns]
    rows = zip(*(column.values for column in table.columns), strict=True)
    return {"units": units, "rows": [dict(zip(names, row, strict=True)) for row in rows]}


def _plain(value: Any) -> Any:
    """Return a value made of what JSON knows."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
