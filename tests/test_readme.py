"""The README's Python example runs and prints what the README says."""

import re

import pytest

from tests.samples import ROOT

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?")


def blocks(language):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)


def test_python_examples_print_what_stands_below_them(monkeypatch, capsys):
    examples, outputs = blocks("python"), blocks("text")
    assert len(examples) == len(outputs) >= 1
    monkeypatch.chdir(ROOT)
    for example, output in zip(examples, outputs, strict=True):
        exec(compile(example, "README.md", "exec"), {"__name__": "readme"})
        printed = capsys.readouterr().out
        # The words exactly, the numbers to 1 %: processors round differently.
        assert NUMBER.sub("#", printed) == NUMBER.sub("#", output)
        for got, stated in zip(NUMBER.findall(printed), NUMBER.findall(output), strict=True):
            assert float(got) == pytest.approx(float(stated), rel=0.01)
