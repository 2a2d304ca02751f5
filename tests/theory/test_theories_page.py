"""The examples of the page on theories run and print what stands below them."""

import re

import pytest

from tests.samples import ROOT

NUMBER = re.compile(r"\d+(?:\.\d+)?")


TEXT = (ROOT / "docs" / "theories.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```python\n(.*?)```.*?```text\n(.*?)```", TEXT, re.DOTALL)


@pytest.mark.parametrize(("example", "shown"), EXAMPLES, ids=["road and tread"])
def test_an_example_prints_what_stands_below_it(example, shown, monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    exec(compile(example, "theories.md", "exec"), {"__name__": "theories"})
    printed = capsys.readouterr().out
    # The words exactly, the numbers to 1 %: the last digit shown, and processors round differently.
    assert NUMBER.sub("#", printed) == NUMBER.sub("#", shown)
    for got, stated in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True):
        assert float(got) == pytest.approx(float(stated), rel=0.01)
