"""What the variables of results are: roles, intervals, and the names of an earlier version."""

import numpy as np
import pytest
import xarray as xr

from gripscale.io import netcdf
from gripscale.questions.answer.answer import Answer
from gripscale.questions.answer.variables import believed, described
from gripscale.questions.page_of_folder import load


def with_interval(start, value):
    return {start: value, f"{start}_low": 0.9 * value, f"{start}_high": 1.1 * value}


def earlier():
    """Return an answer with an area term as version 0.1 named its numbers."""
    friction = with_interval("answer_friction", 0.2) | with_interval("answer_total_friction", 0.9)
    area = with_interval("answer_contact_fraction", 0.03)
    others = {"answer_adhesive_friction": 0.7, "total_friction": 0.21, "nominal_speed": 0.3}
    return xr.Dataset(friction | area | others)


def test_a_variable_names_its_role_and_its_interval_in_the_file(tmp_path):
    data = xr.Dataset(with_interval("answer_friction", 0.2) | {"total_friction": 0.21})
    netcdf.save(described(data), tmp_path / "answer.nc")
    read = netcdf.load_dataset(tmp_path / "answer.nc")
    assert read.answer_friction.attrs["role"] == "answer"
    low, high = read.answer_friction.attrs["interval"].split()
    assert float(read[low]) < float(read.answer_friction) < float(read[high])
    assert read.total_friction.attrs["role"] == "number"


def test_without_an_answer_the_total_is_to_be_believed():
    data = described(xr.Dataset({"total_friction": 0.21, "answer_friction": np.nan}))
    assert data.total_friction.attrs["role"] == "answer"
    assert believed(data, "friction") == "total_friction"


def test_a_file_of_an_earlier_version_has_the_names_of_today(tmp_path):
    netcdf.save(earlier().assign_attrs(kind="answer"), tmp_path / "answer.nc")
    answer = load(tmp_path / "answer.nc")
    assert isinstance(answer, Answer)
    assert answer.friction == pytest.approx(0.9)
    assert answer.friction_interval == pytest.approx((0.81, 0.99))
    assert answer.hysteresis_friction == pytest.approx(0.2)
    assert answer.interface_friction == pytest.approx(0.7)
    assert believed(answer.data, "friction") == "answer_friction"
