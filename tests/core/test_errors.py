"""An error carries what is missing as data, through files and processes."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

import gripscale as gs
from gripscale.core.errors import (
    ConvergenceError,
    FileError,
    GripscaleError,
    InputError,
    about_file,
)
from gripscale.rubber import read_master_curve


@pytest.mark.parametrize("kind", [GripscaleError, InputError, FileError, ConvergenceError])
def test_what_is_missing_goes_with_an_error_to_another_process(kind: type[GripscaleError]) -> None:
    error = pickle.loads(pickle.dumps(kind("moduli of what?", missing="modulus")))
    assert (type(error), str(error), error.missing) == (kind, "moduli of what?", "modulus")
    assert kind("no key helps").missing == ""


def test_an_error_about_a_file_keeps_what_is_missing() -> None:
    with pytest.raises(FileError, match=r"^a\.csv: how far apart") as caught, about_file("a.csv"):
        raise InputError("how far apart are the points?", missing="step")
    assert caught.value.missing == "step"


@pytest.mark.parametrize(
    ("titles", "missing"),
    [
        ("f,E' [MPa],E'' [MPa]", "frequency_unit"),
        ("f [Hz],E',E''", "modulus_unit"),
        ("f [Hz],storage [MPa],loss [MPa]", "modulus"),
        ("f [Hz],E' [MPa],force [N]", "columns"),
    ],
)
def test_a_reader_of_moduli_says_which_key_is_missing(
    tmp_path: Path, titles: str, missing: str
) -> None:
    path = tmp_path / "dma.csv"
    path.write_text(f"{titles}\n1,2,0.2\n10,3,0.3\n")
    with pytest.raises(InputError) as caught:
        read_master_curve(path)
    assert caught.value.missing == missing


@pytest.mark.parametrize(("titles", "missing"), [("x;z [mm]", "x_unit"), ("z", "step")])
def test_a_reader_of_profiles_says_which_key_is_missing(
    tmp_path: Path, titles: str, missing: str
) -> None:
    columns = titles.count(";") + 1
    path = tmp_path / "road.csv"
    path.write_text("\n".join([titles, *(";".join([str(n)] * columns) for n in range(40))]))
    with pytest.raises(FileError) as caught:
        gs.read_profile(path)
    assert caught.value.missing == missing
