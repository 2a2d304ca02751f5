"""An error carries what is missing as data, through files and processes."""

import pickle

import pytest

from gripscale.core.errors import (
    ConvergenceError,
    FileError,
    GripscaleError,
    InputError,
    about_file,
)


@pytest.mark.parametrize("kind", [GripscaleError, InputError, FileError, ConvergenceError])
def test_what_is_missing_goes_with_an_error_to_another_process(kind):
    error = pickle.loads(pickle.dumps(kind("moduli of what?", missing="modulus")))
    assert (type(error), str(error), error.missing) == (kind, "moduli of what?", "modulus")
    assert kind("no key helps").missing == ""


def test_an_error_about_a_file_keeps_what_is_missing():
    with pytest.raises(FileError, match=r"^a\.csv: how far apart") as caught, about_file("a.csv"):
        raise InputError("how far apart are the points?", missing="step")
    assert caught.value.missing == "step"
