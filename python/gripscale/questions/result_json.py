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
from gripscale.core.finding import Finding
from gripscale.core.provenance import version_of
from gripscale.core.units import si_unit
from gripscale.io.table import Table
from gripscale.questions.answer.reliance import (
    answer_interval,
    answer_number,
    has_answer,
    no_answer,
)
from gripscale.questions.result import Result
from gripscale.questions.summary_table import summary_table

FORMAT = 1
"""Number of the layout; it rises when a name changes or goes."""
_NUMBERS = ("friction", "contact_fraction")


def result_as_json(result: Result, files: Sequence[NamedFile] = ()) -> str:
    """Return a result as JSON.

    `files` are those that the case names, with their checksums.
    """
    attrs = result.data.attrs
    content = {
        "format": FORMAT,
        "gripscale": version_of("gripscale"),
        "question": result.kind,
        "case": attrs.get("case_file", ""),
        "command": attrs.get("command", ""),
        "answer": _answer(result),
        "findings": [_finding(finding) for finding in result.findings],
        "failure": result.failure,
        "table": _table(result.table()),
        "summary": _table(summary_table([result.data])),
        "inputs": [asdict(file) for file in files],
    }
    return json.dumps(_plain(content), ensure_ascii=False, indent=1, allow_nan=False)


def _answer(result: Result) -> dict[str, Any]:
    """Return the answer in words and, where the result has one, in numbers with intervals."""
    words: dict[str, Any] = {"text": [line.strip() for line in result.lines]}
    if not has_answer(result.data):
        return words
    numbers = {name: answer_number(result.data, name) for name in _NUMBERS}
    intervals = {f"{name}_interval": answer_interval(result.data, name) for name in _NUMBERS}
    return {**words, "reliable": not no_answer(result.data), **numbers, **intervals}


def _finding(finding: Finding) -> dict[str, Any]:
    """Return a finding with the relative changes of friction and contact area that it may cause."""
    keys = asdict(finding)
    return keys | {"contact_fraction": keys.pop("area"), "topic": finding.topic.name.lower()}


def _table(table: Table) -> dict[str, Any]:
    """Return a table as rows of numbers by the names of its columns, with their units."""
    rows = zip(*(column.values for column in table.columns), strict=True)
    names = [column.name for column in table.columns]
    return {
        "name": table.name,
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
