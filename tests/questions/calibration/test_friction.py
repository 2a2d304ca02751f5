"""Measured friction from files: columns by name, units from titles, what is bad in a sentence."""

import numpy as np
import pytest

from gripscale.core.errors import FileError, InputError
from gripscale.core.finding import sentences
from gripscale.experiment import MeasuredFriction, read_measured_friction
from gripscale.experiment.measured_friction import friction_doubts, speed_doubts


def written(folder, text):
    path = folder / "measured.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_columns_are_found_by_name_and_brought_to_si(tmp_path):
    path = written(
        tmp_path, "temperature [°C];Speed [mm/s];std;µ\n20,5;1000;0,02;0,4\n5;10;nan;0,3\n"
    )
    found = read_measured_friction(path)
    assert found.speed.tolist() == [1.0, 0.01]
    assert found.friction.tolist() == [0.4, 0.3]
    assert found.temperature == pytest.approx([293.65, 278.15])
    np.testing.assert_array_equal(found.spread, [0.02, np.nan])
    assert found.source == str(path)


def test_plain_titles_are_si(tmp_path):
    found = read_measured_friction(written(tmp_path, "speed,friction [-]\n0.1,0.3\n1,0.5\n"))
    assert found.speed.tolist() == [0.1, 1.0]
    assert np.isnan(found.temperature).all()
    assert np.isnan(found.spread).all()


def test_a_unit_that_is_not_stated_is_a_doubt_with_its_cure(tmp_path):
    stated = read_measured_friction(written(tmp_path, "speed [m/s],mu\n0.1,0.3\n1,0.5\n"))
    assert stated.assumed == ""
    bare = read_measured_friction(written(tmp_path, "speed,mu,p\n0.1,0.3,1e5\n1,0.5,1e5\n"))
    assert [str(doubt) for doubt in friction_doubts(bare, 1.0)] == [bare.assumed]
    assert "m/s is assumed: write it in the title, such as 'speed [mm/s]'." in bare.assumed
    assert "The unit of pressure in measured.csv is not stated and Pa is assumed" in bare.assumed
    assert friction_doubts(None, 1.0) == []


@pytest.mark.parametrize(
    ("speeds", "words"),
    [
        ((0.01, 30.0), ""),
        ((31.0, 60.0), "all more than 30 times above that of the case, 1 m/s"),
        ((1e-3, 0.03), "all more than 30 times below"),
        ((0.5, 1000.0), "0.5 to 1000 m/s, are not all below 100 m/s: is their unit right?"),
    ],
)
def test_speeds_far_from_that_of_the_case_have_another_unit(speeds, words):
    said = sentences(speed_doubts(MeasuredFriction(speeds, (0.3, 0.3)), 1.0))
    assert words in said
    assert bool(words) == bool(said)
    assert ("not all below" in words) == bool(
        speed_doubts(MeasuredFriction(speeds, (0.3, 0.3)), 0.0)
    )


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("speed,force\n1,2\n2,3\n", "expected a column named friction; got speed, force"),
        ("1,2\n2,3\n", "expected a column named speed; got no titles"),
        ("speed,friction,v\n1,2,3\n2,3,4\n", "expected one column of speed; got two"),
        ("speed [ft/s],friction\n1,0.2\n", "mm/min, m/min, mph; got 'ft/s'"),
        ("speed,friction [%]\n1,20\n", "friction has no unit; got '%' in its title"),
        ("speed,friction\n0,0.2\n", "speed must be greater than zero [m/s]; got 0 at index 0"),
        ("speed,friction\n1,nan\n", "line 2: expected a friction; got 'nan'"),
        ("speed,friction,spread\n1,0.2,-0.1\n", "spread must not be negative; got -0.1 at index 0"),
    ],
)
def test_bad_files_are_one_sentence(tmp_path, text, sentence):
    path = written(tmp_path, text)
    with pytest.raises(FileError) as caught:
        read_measured_friction(path)
    assert str(caught.value).startswith(str(path))
    assert sentence in str(caught.value)


def test_lengths_must_agree():
    with pytest.raises(
        InputError, match=r"speed, friction, .* must have the same length.*got 2, 1, 2"
    ):
        MeasuredFriction([0.1, 1.0], [0.3])
