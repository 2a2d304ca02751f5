"""Tables as an Excel file, by the standard library alone: a zip file of XML.

ECMA-376 (Office Open XML), part 1, section 18: a sheet for each table, whose texts stand in its
cells and whose first row stays in sight.
"""

from __future__ import annotations

import math
import re
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr

from gripscale.core.errors import InputError
from gripscale.io.netcdf import write_whole
from gripscale.io.table import Table

MOST_ROWS = 1_048_576
"""Rows of an Excel sheet, its heading included."""
MOST_LETTERS = 32_767
"""Letters of an Excel cell."""
MOST_TITLE = 31
"""Letters of the title of an Excel sheet."""
CUT = " ... [cut: longer than a cell of a workbook; csv has all of it]"
_NO_LETTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""What XML 1.0 cannot hold."""
_WIDEST = 40
"""Letters of the widest column."""

_HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_CONTENT = "application/vnd.openxmlformats-officedocument.spreadsheetml"


def write_workbook(tables: Sequence[Table], path: Path) -> Path:
    """Write tables as the sheets of an xlsx file; return its path.

    Missing values are empty cells, infinite ones texts; texts longer than a cell are cut and say
    so. Raises `InputError` if a table has more rows than a sheet, `FileError` if the file cannot be
    written.
    """
    titles = _sheet_titles([table.name for table in tables])
    sheets = [[table.titles, *table.rows()] for table in tables]
    for title, rows in zip(titles, sheets, strict=True):
        if len(rows) > MOST_ROWS:
            raise InputError(
                f"tables must have at most {MOST_ROWS - 1} rows for xlsx; got {len(rows) - 1} in "
                f"{title}: csv has no limit"
            )

    def write(part: Path) -> None:
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as file:
            for name, text in _frame(titles):
                file.writestr(name, _HEAD + text)
            for number, rows in enumerate(sheets, start=1):
                with file.open(f"xl/worksheets/sheet{number}.xml", "w") as sheet:
                    sheet.writelines(line.encode("utf-8") for line in _sheet(rows))

    return write_whole(path, write)


def _frame(titles: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield name and XML of what holds the sheets together."""
    numbers = range(1, len(titles) + 1)
    types = [
        f'<Override PartName="/{name}.xml" ContentType="{_CONTENT}.{kind}+xml"/>'
        for name, kind in (
            ("xl/workbook", "sheet.main"),
            *((f"xl/worksheets/sheet{number}", "worksheet") for number in numbers),
        )
    ]
    yield (
        "[Content_Types].xml",
        f'<Types xmlns="{_PACKAGE}/content-types"><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f"{''.join(types)}</Types>",
    )
    yield "_rels/.rels", _relationships({"officeDocument": ["xl/workbook.xml"]})
    sheets = [
        f'<sheet name={quoteattr(title)} sheetId="{number}" r:id="r{number}"/>'
        for number, title in zip(numbers, titles, strict=True)
    ]
    yield (
        "xl/workbook.xml",
        f'<workbook xmlns="{_MAIN}" xmlns:r="{_OFFICE}"><bookViews><workbookView/></bookViews>'
        f"<sheets>{''.join(sheets)}</sheets></workbook>",
    )
    targets = [f"worksheets/sheet{number}.xml" for number in numbers]
    yield "xl/_rels/workbook.xml.rels", _relationships({"worksheet": targets})


def _relationships(targets: dict[str, list[str]]) -> str:
    """Return the XML of relationships r1, r2, ... by their kind."""
    pairs = [(kind, target) for kind, names in targets.items() for target in names]
    parts = [
        f'<Relationship Id="r{number}" Type="{_OFFICE}/{kind}" Target="{target}"/>'
        for number, (kind, target) in enumerate(pairs, start=1)
    ]
    return f'<Relationships xmlns="{_PACKAGE}/relationships">{"".join(parts)}</Relationships>'


def _sheet(rows: Sequence[Sequence[Any]]) -> Iterator[str]:
    """Yield the XML of a sheet, whose first row holds the titles of its columns."""
    letters = [_letters(at) for at in range(len(rows[0]))]
    widths = [min(max(len(title) + 2, 9), _WIDEST) for title in rows[0]]
    columns = [
        f'<col min="{at}" max="{at}" width="{width}" customWidth="1"/>'
        for at, width in enumerate(widths, start=1)
    ]
    yield (
        f'{_HEAD}<worksheet xmlns="{_MAIN}"><sheetViews><sheetView workbookViewId="0"><pane '
        'ySplit="1" topLeftCell="A2" activePane="bottomLeft" state="frozen"/></sheetView>'
        "</sheetViews>"
    )
    yield f"<cols>{''.join(columns)}</cols><sheetData>" if columns else "<sheetData>"
    for number, row in enumerate(rows, start=1):
        cells = (
            _cell(f"{letter}{number}", value) for letter, value in zip(letters, row, strict=True)
        )
        yield f'<row r="{number}">{"".join(cells)}</row>'
    yield "</sheetData></worksheet>"


def _letters(at: int) -> str:
    """Return the name of a column, counted from 0: A, ..., Z, AA."""
    before, letter = divmod(at, 26)
    return (_letters(before - 1) if before else "") + chr(ord("A") + letter)


def _cell(name: str, value: Any) -> str:
    """Return the XML of a cell; texts stay texts, whatever they begin with."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return f'<c r="{name}" t="b"><v>{int(value)}</v></c>'
    if isinstance(value, float | int) and math.isfinite(value):
        return f'<c r="{name}"><v>{value}</v></c>'
    text = _NO_LETTER.sub("?", str(value))
    if len(text) > MOST_LETTERS:
        text = text[: MOST_LETTERS - len(CUT)] + CUT
    words = f'<t xml:space="preserve">{escape(text)}</t>'
    return f'<c r="{name}" t="inlineStr"><is>{words}</is></c>'


def _sheet_titles(names: Sequence[str]) -> list[str]:
    """Return titles of sheets, no two alike, also where large and small letters are."""
    titles: list[str] = []
    for name in names:
        title, number = name[:MOST_TITLE], 2
        while title.lower() in map(str.lower, titles):
            end = f"_{number}"
            title, number = name[: MOST_TITLE - len(end)] + end, number + 1
        titles.append(title)
    return titles
