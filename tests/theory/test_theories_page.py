"""The example of the page on theories runs and prints what stands below it."""

from __future__ import annotations

import re

import pytest

from tests.samples import ROOT

NUMBER = re.compile(r"\d+(?:\.\d+)?")


def test_the_example_prints_what_stands_below_it(monkeypatch, capsys):
    text = (ROOT / "docs" / "theories.md").read_text(encoding="utf-8")
    [(example, shown)] = re.findall(r"```python\n(.*?)```.*?```text\n(.*?)```", text, re.DOTALL)
    monkeypatch.chdir(ROOT)
    exec(compile(example, "theories.md", "exec"), {"__name__": "theories"})
    printed = capsys.readouterr().out
    # The words exactly, the numbers to 1 %: the last digit shown, and processors round differently.
    assert NUMBER.sub("#", printed) == NUMBER.sub("#", shown)
    for got, stated in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True):
        assert float(got) == pytest.approx(float(stated), rel=0.01)
