"""The flat table of a command: a row for each answer, with interval, units, doubts and files."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from gripscale.core.finding import doubt, to_json
from gripscale.questions.result_json import summary_table

UNIT = {"units": "1"}


def study(**attributes: object) -> xr.Dataset:
    """A study over two speeds and two rubbers, of which one prediction failed."""
    place = ("speed", "rubber")
    status = np.array([["converged", "wave 2 failed"], ["converged", "converged"]], dtype=object)
    return xr.Dataset(
        {
            "prediction_status": (place, status),
            "prediction_key": (place, np.array([["a", "b"], ["c", "d"]], dtype=object)),
            "answer_friction": (place, [[0.2, math.nan], [0.4, 0.8]], UNIT),
            "answer_friction_low": (place, [[0.1, math.nan], [0.2, 0.3]], UNIT),
            "upper_height": ((), 1.7, UNIT),
            "hardness": ("rubber", [60.0, 70.0], {"units": "Pa"}),
            "friction": ((*place, "scale"), np.zeros((2, 2, 3)), UNIT),
        },
        {"speed": ("speed", [0.1, 1.0], {"units": "m/s"}), "rubber": ["soft", "hard"]},
        {
            "model": "direct",
            "nominal_speed": 0.3,
            "nominal_pressure": np.float64(3e5),
            "case_file": "case.toml",
            **attributes,
        },
    )


def rows(result: xr.Dataset) -> list[dict[str, object]]:
    table = summary_table(result)
    titles = [f"{c.name} [{c.unit.replace('1', '-')}]" if c.unit else c.name for c in table.columns]
    values = [[None if x != x else x for x in column.values] for column in table.columns]
    return [dict(zip(titles, row, strict=True)) for row in zip(*values, strict=True)]


def test_a_row_for_each_point_of_a_study() -> None:
    first, failed, _, last = rows(study())
    assert (first["speed [m/s]"], first["rubber"]) == (0.1, "soft")
    assert (failed["speed [m/s]"], failed["rubber"]) == (0.1, "hard")
    assert failed["answer_friction [-]"] is None
    assert failed["prediction_status"] == "wave 2 failed"
    assert last["answer_friction [-]"] == 0.8
    assert last["answer_friction_low [-]"] == 0.3
    assert [row["hardness [Pa]"] for row in (first, failed)] == [60.0, 70.0]
    assert first["upper_height [-]"] == last["upper_height [-]"] == 1.7
    assert first["nominal_pressure [Pa]"] == 3e5
    assert first["case_file"] == "case.toml"
    assert list(first)[:4] == ["speed [m/s]", "rubber", "model", "answer_friction [-]"]
    # what is varied, or of no answer
    assert not {"nominal_speed [m/s]", "prediction_key", "friction [-]"} & set(first)


def test_doubts_stand_in_each_row() -> None:
    doubted = rows(study(input_doubts=to_json([doubt("The unit of heights looks wrong.")])))
    assert {row["not_to_rely_on"] for row in doubted} == {"The unit of heights looks wrong."}
    assert "not_to_rely_on" not in rows(study())[0]


def test_models_of_a_comparison_and_points_of_a_design_are_rows() -> None:
    words = np.array(["converged", "none"], dtype=object)
    comparison = xr.Dataset({"status": ("model", words)}, {"model": ["chain", "direct"]})
    assert [row["model"] for row in rows(comparison)] == ["chain", "direct"]
    design = xr.Dataset({"gain": ("point", [0.1, 0.2], UNIT), "rolling": ("point", [1.0, 1.1])})
    assert [(row["point"], row["gain [-]"]) for row in rows(design)] == [(0, 0.1), (1, 0.2)]


def test_the_answer_stands_beside_the_direct_contact() -> None:
    words = np.array(["converged", "converged"], dtype=object)
    comparison = xr.Dataset(
        {
            "status": ("model", words),
            "answer_friction": ((), 0.2, UNIT),
            "answer_friction_low": ((), 0.1, UNIT),
            "cutoff_wavelength": ((), 1e-4, {"units": "m"}),
        },
        {"model": ["chain", "direct"]},
    )
    chain, direct = rows(comparison)
    assert (chain["answer_friction [-]"], direct["answer_friction [-]"]) == (None, 0.2)
    assert chain["answer_friction_low [-]"] is None
    assert chain["cutoff_wavelength [m]"] == direct["cutoff_wavelength [m]"] == 1e-4


def test_rubber_at_rest_has_no_friction() -> None:
    results = (
        xr.Dataset({"prediction_status": "converged", "nominal_speed": v, "total_friction": 0.0})
        for v in (1.0, 0.0)
    )
    assert [row["total_friction"] for result in results for row in rows(result)] == [0.0, None]
