"""A result as JSON, for other programs: its answer, findings, table, and the files it rests on.

Every number is in SI units; the map `units` of the table has the units of its columns. A number
that is missing or infinite is null, as JSON has no NaN.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from gripscale.case import NamedFile
from gripscale.core.provenance import version_of
from gripscale.core.units import si_unit
from gripscale.io.table import Table
from gripscale.questions.answer.reliance import no_answer
from gripscale.questions.answer.variables import answer_number, has_answer
from gripscale.questions.result import Result
from gripscale.questions.summary_table import summary_table

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
    findings = [asdict(each) | {"topic": each.topic.name.lower()} for each in result.findings]
    content = {
        "format": FORMAT,
        "gripscale": version_of("gripscale"),
        "question": result.kind,
        "case": case,
        "command": data.attrs.get("command", ""),
        "answer": answer,
        "findings": findings,
        "failure": result.failure,
        "table": _table(result.table()),
        "summary": _table(summary_table(data)),
        "inputs": [asdict(file) for file in files],
    }
    return json.dumps(_plain(content), ensure_ascii=False, indent=1, allow_nan=False)


def _table(table: Table) -> dict[str, Any]:
    """Return a table as rows of numbers by the names of its columns, with their units."""
    names = [column.name for column in table.columns]
    rows = zip(*(column.values for column in table.columns), strict=True)
    return {
        "units": {column.name: si_unit(column.unit, column.size) for column in table.columns},
        "rows": [dict(zip(names, row, strict=True)) for row in rows],
    }


def _plain(value: Any) -> Any:
    """Return a value made of what JSON knows."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
