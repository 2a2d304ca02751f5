"""The example of the page on inputs runs and prints what stands below it; its case is one."""

from __future__ import annotations

import re
import tomllib

import pytest

from gripscale.case_file import SurfaceTable
from tests.samples import ROOT

PAGE = (ROOT / "docs" / "inputs.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def test_the_example_prints_what_stands_below_it(monkeypatch, capsys):
    [(example, shown)] = re.findall(r"```python\n(.*?)```.*?```text\n(.*?)```", PAGE, re.DOTALL)
    monkeypatch.chdir(ROOT)
    exec(compile(example, "inputs.md", "exec"), {"__name__": "inputs"})
    printed = capsys.readouterr().out
    # The words exactly, the numbers to 1 %: the last digit shown, and processors round differently.
    assert NUMBER.sub("#", printed) == NUMBER.sub("#", shown)
    for got, stated in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True):
        assert float(got) == pytest.approx(float(stated), rel=0.01)


def test_the_case_shown_is_one():
    tables = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    [table] = [text for text in tables if "[surface]" in text]
    surface = SurfaceTable(**tomllib.loads(table)["surface"])
    assert surface.crop_across == pytest.approx([5e-3, 45e-3])
