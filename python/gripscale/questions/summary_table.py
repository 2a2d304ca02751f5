"""The answers of a result as one flat table: a row for each, all its numbers in it.

A row is a place on the dimensions of the status of a result: a prediction, a model of a comparison,
a point of a study. What holds for several rows stands in each of them; of models side by side, the
answer in that of the direct contact.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from gripscale.core.finding import sentences
from gripscale.io.table import Column, Table
from gripscale.model import STATUS, input_doubts_of
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.reliance import no_answer
from gripscale.questions.answer.variables import ANSWER_NUMBERS, has_answer

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
    """Return the answers of a result as one table, with units in its headings.

    Rubber at rest has no friction. An answer is made of the direct contact: it stands in its row,
    not in that of each model.
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
            everywhere = np.full(rows.size, value, object)
            columns[name] = Column(name, everywhere, unit=_UNITS.get(name, ""))
    order = {name: at for at, name in reversed([*enumerate([*map(str, rows.dims), *FIRST])])}
    return Table("summary", sorted(columns.values(), key=lambda c: order.get(c.name, len(order))))
