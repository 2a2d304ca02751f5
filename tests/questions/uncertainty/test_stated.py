"""What a case states of its uncertainty: read, listed, and overridden by whoever asks."""

from typing import get_args

import pytest

from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.tables import RangesTable, SourceName
from gripscale.core.errors import InputError
from gripscale.io import netcdf
from gripscale.questions import Uncertainty
from gripscale.questions.uncertainty.sources import SOURCES

from .sampled import propagate

STATED = """
[uncertainty]
samples = 12
seed = 3
model = "chain"
without = ["waves", "modulus"]
block_length = "60 mm"
[uncertainty.ranges]
cut_off = ["0.9 mm", "1.2 mm"]
load_time = [0.5, 1, 2]
"""


@pytest.fixture
def case(folder):
    """Write the small case with more tables."""

    def write(also):
        path = folder / "stated.toml"
        path.write_text((folder / "case.toml").read_text() + also)
        return path

    return write


def stated_in(path):
    """Return the table of the uncertainty in a case file."""
    return read_case_file(path).case.uncertainty.model_dump(exclude_none=True)


def test_the_case_knows_the_sources_there_are():
    assert get_args(SourceName) == tuple(SOURCES)
    assert set(RangesTable.model_fields) == set(SOURCES) - {"profile", "modulus", "grid"}


def test_a_case_states_all_of_it(case):
    table = stated_in(case(STATED))
    assert (table["samples"], table["seed"], table["block_length"]) == (12, 3, 0.06)
    choice = Uncertainty.of_case(table)
    assert (choice.without, choice.block_length) == (("waves", "modulus"), 0.06)
    assert choice.ranges["cut_off"] == pytest.approx([9e-4, 1.2e-3])
    assert choice.ranges["load_time"] == [0.5, 1.0, 2.0]


def test_a_case_states_standard_errors(case):
    stated = 'ranges = { temperature = "2 K", pressure = "0.1 bar", height_noise = "5 um" }'
    choice = Uncertainty.of_case(stated_in(case(f"[uncertainty]\n{stated}\n")))
    assert choice.ranges.pop("height_noise") == pytest.approx(5e-6)
    assert choice.ranges == {"temperature": 2.0, "pressure": "0.1 bar"}


def test_who_asks_goes_before_the_case(case):
    table = stated_in(case(STATED))
    given = {"cut_off": "1 mm", "waves": "4,5"}
    changed = Uncertainty.of_case(table, ranges=given, block_length=0.08)
    assert changed.without == ("modulus",)
    assert changed.ranges == {"load_time": [0.5, 1.0, 2.0], **given}
    assert changed.block_length == 0.08
    left = Uncertainty.of_case(table, without=["cut_off"])
    assert left.without == ("cut_off",)
    assert set(left.ranges) == {"load_time"}
    with pytest.raises(InputError, match="cut_off must be left out or given; got both"):
        Uncertainty.of_case(table, without=["cut_off"], ranges={"cut_off": "1 mm"})


def test_what_is_stated_is_sampled_as_if_it_were_asked_for(case, small_case):
    choice = Uncertainty(
        ["waves", "modulus"], {"cut_off": "0.9 mm:1.2 mm", "load_time": "0.5,1,2"}, 0.06
    )
    asked = propagate(small_case, choice, samples=12, seed=3, models=["chain"])
    stated = propagate(read_case(case(STATED)))
    assert stated.friction.values.tolist() == asked.friction.values.tolist()


def test_options_of_the_command_go_before_the_case(shell, case, tmp_path):
    options = ("--samples", 10, "--without", "waves", "--output", tmp_path / "out")
    shell("uncertainty", case(STATED), *options)
    data = netcdf.load_dataset(tmp_path / "out" / "uncertainty.nc")
    assert data.sizes["sample"] == 10
    assert data.attrs["seed"] == 3
    assert "modulus" in data.source.values
    assert 9e-4 < float(data.cut_off.min()) < float(data.cut_off.max()) < 1.2e-3


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("samples = 5", "samples"),
        ('without = ["weather"]', "profile"),
        ('ranges = { cut_off = ["2 mm", "1 mm"] }', "rising"),
        ('ranges = { cut_off = "2 mm" }', "a list of two ends or of equally likely values"),
        ("ranges = { load_time = [0, 1] }", "expected a number, above 0"),
        ("ranges = { profile = [1, 2] }", "profile"),
        ('block_length = "0 mm"', "block_length"),
        ('ranges = { temperature = "0 K" }', "greater than zero"),
        ('ranges = { pressure = "much" }', 'a share such as "3 %", or a pressure'),
        ('ranges = { height_noise = "3 %" }', "unknown unit"),
    ],
)
def test_what_cannot_be_stated(case, wrong, said):
    with pytest.raises(InputError, match=said):
        read_case_file(case(f"[uncertainty]\n{wrong}\n"))
