"""One table in the terminal, on a page, in CSV and in Excel."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
from rich.console import Console

from gripscale.io.table import Column, Table, as_text, percent
from gripscale.report.elements import with_code

PRESSURE = Column("pressure", np.array([3e5, math.nan]), "p", "bar", 1e5, group="load")
RANGE = Column("range", np.array([[-0.1, 0.2], [0.3, math.nan]]), group="result", bad=[True, False])
SHARE = Column("share", [0.25, math.inf], format=percent, marks=["*", ""], group="result")
TABLE = Table(
    "loads",
    [Column("model", ["<b>chain</b>", "direct"]), PRESSURE, RANGE, SHARE],
    "Loads & ranges",
    ["A note."],
    strong=[1],
)


def test_terminal_shows_groups_units_and_marks() -> None:
    lines = as_text(TABLE, width=80).splitlines()
    assert lines[0] == "Loads & ranges"
    assert lines[1].split() == ["load", "result"]
    assert lines[2].split() == ["p"]
    assert lines[3].split() == ["model", "bar", "range", "share"]
    assert lines[5].split() == ["<b>chain</b>", "3.00", "-0.100", "to", "0.200", "25", "%*"]
    assert lines[6].split() == ["direct", "-", "-", "∞"]
    assert lines[5].index("%") == lines[6].index("∞"), "digits stand below digits"
    assert lines[-1] == "A note."


def test_a_table_that_is_too_wide_is_divided_between_groups() -> None:
    lines = as_text(TABLE, width=38).splitlines()
    heads = [line.split() for line in lines if line.startswith("model")]
    assert heads == [["model", "bar"], ["model", "range", "share"]]
    assert max(map(len, lines)) <= 38


def test_a_table_without_groups_is_divided_between_columns() -> None:
    model = Column("model", ["chain", "direct"])
    parts = [Column(f"part {i}", np.array([1.0, 2.0])) for i in range(8)]
    lines = as_text(Table("parts", [model, *parts]), width=30).splitlines()
    heads = [line for line in lines if line.startswith("model")]
    assert len(heads) == 3
    assert " ".join(heads).count("part") == 8
    assert max(map(len, lines)) <= 30


def test_what_must_not_be_trusted_is_red() -> None:
    console = Console(width=80, record=True, force_terminal=True, color_system="standard")
    with console.capture() as capture:
        console.print(TABLE)
    red = [line for line in capture.get().splitlines() if "\x1b[1;31m" in line]
    assert len(red) == 1
    assert "-0.100 to 0.200" in red[0]


def test_a_page_escapes_texts_and_sets_minus_signs() -> None:
    page = TABLE.__html__()
    assert "&lt;b&gt;chain&lt;/b&gt;" in page
    assert "<b>" not in page
    assert "−0.100 to 0.200" in page
    assert page.count(' bad"') == 1
    assert '<td class="">–</td>' in page
    assert '<th scope="colgroup" colspan="2">result</th>' in page
    assert page.count('<tr class="strong">') == 1


def test_a_long_heading_breaks_into_few_lines_on_a_narrow_page() -> None:
    """A heading of many words would be one word a line where a table is wider than the page."""
    long = "low end of the 90 % interval, over that of the first, answer of the friction"
    page = Table("t", [Column("low", np.array([1.0]), long)]).__html__()
    head = re.search(r'<th scope="col" class="">(low[^<]*)</th>', page)
    assert head is not None
    assert " ".join(head[1].split()) == long
    assert len(head[1].split(" ")) <= 6


def test_commands_of_a_text_are_code_and_markup_is_not() -> None:
    text, page = "<b> is; `gripscale run` runs", "&lt;b&gt; is; <code>gripscale run</code> runs"
    assert with_code(text) == page
    assert f'<p class="note">{page}</p>' in replace(TABLE, notes=[text]).__html__()
