"""The example in the docstring of each public name gives what it shows."""

import doctest
import inspect

import pytest

import gripscale as gs
from gripscale.core.errors import GripscaleError
from gripscale.questions.result import Result
from tests.public_objects import public_objects, write_files

SLOW = {"calibrate", "uncertainty"}
"""Seconds each."""
MADE_BY_FUNCTIONS = {
    *("BelowMeasurement", "ChainResult", "GapFlow", "HeightDifference", "RoughContact"),
    *("ScaleResult", "SelfAffineFit", "TransientResult"),
}
"""Classes whose objects functions return, which have the example."""


def with_examples():
    """Return the public functions, and the classes that a user makes objects of."""
    names = []
    for name in sorted(gs.__all__):
        item = getattr(gs, name)
        if inspect.isclass(item):
            if issubclass(item, GripscaleError | Warning | Result) or name in MADE_BY_FUNCTIONS:
                continue
        elif not inspect.isfunction(item):
            continue
        names.append(name)
    return names


@pytest.fixture(scope="module")
def objects(tmp_path_factory):
    """Return what examples name, and the folder of their files."""
    names, folder = public_objects(), tmp_path_factory.mktemp("files")
    write_files(folder, names)
    gs.answer(names["case"]).save(folder / "answer.nc")
    return names, folder


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.verification] if name in SLOW else [])
        for name in with_examples()
    ],
)
def test_an_example_gives_what_it_shows(name, objects, monkeypatch):
    names, folder = objects
    monkeypatch.chdir(folder)
    item = getattr(gs, name)
    tests = list(doctest.DocTestFinder(recurse=False).find(item, name, globs=dict(names)))
    assert any(test.examples for test in tests), f"{name} has no example"
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    texts = []
    for test in tests:
        runner.run(test, out=texts.append)
    assert runner.summarize(verbose=False).failed == 0, "".join(texts)
