"""The example of the page on inputs runs and prints what stands below it; each case is one."""

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
    tables = [tomllib.loads(text) for text in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)]
    surfaces = [table["surface"] for table in tables if "surface" in table]
    of_map, of_spectrum = (SurfaceTable(**keys) for keys in surfaces)
    assert of_map.crop_across == pytest.approx([5e-3, 45e-3])
    assert (str(of_spectrum.spectrum), of_spectrum.phases) == ("psd.csv", "worn")
