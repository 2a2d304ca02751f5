"""What a run records of its inputs for its report."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gripscale.case_file import read_case
from gripscale.questions.inputs.record import sine_curves
from gripscale.rubber.material import fast_end

from .conftest import read


def test_run_records_its_inputs_beside_the_prediction(run_folder: Path) -> None:
    data, _ = read(run_folder / "chain.nc")
    inputs = read(run_folder / "answer.nc")[1]["inputs"]
    assert data.sizes["wave"] == 3
    assert inputs.sizes["profile"] == 2
    np.testing.assert_allclose(inputs.attrs["sines_s_wavelength"], 3.0, rtol=1e-12)
    assert inputs.sizes["row"] == 60
    lowest, highest = inputs["read_lowest"].values, inputs["read_highest"].values
    known = np.isfinite(lowest)
    assert (lowest[known] <= highest[known]).all()
    heights = np.loadtxt(run_folder.parent / "road.txt", skiprows=1)[:, 1] * 1e-3
    np.testing.assert_allclose(np.nanmax(highest[0]), heights.max(), rtol=1e-12)
    np.testing.assert_allclose(np.nanmin(lowest[0]), heights.min(), rtol=1e-12)
    assert data["mesh_x"].shape == (3, 9, 33)
    assert (data["columns"] == 32).all()


def test_recorded_curves_are_those_of_the_fits(run_folder: Path) -> None:
    """What the page plots is what the prepared inputs evaluate to."""
    made = read_case(run_folder.parent / "case.toml")
    inputs = read(run_folder / "answer.nc")[1]["inputs"]
    correlation, measured = made.surface.correlation, made.surface.measured
    rubber = made.measured_rubber
    assert correlation is not None
    assert measured is not None
    fitted, _ = sine_curves(made.surface.sines, correlation.lag)
    np.testing.assert_array_equal(inputs["correlation_sines"], fitted)
    fine = inputs["fine_lag"].values
    assert fine[0] == correlation.lag[0]
    assert fine[-1] == pytest.approx(made.surface.sines.wavelength[0], rel=1e-12)
    np.testing.assert_allclose(
        inputs["fine_pure_sines"], made.surface.sines.height_difference(fine), rtol=1e-12
    )
    assert (measured.self_affine is None) == ("correlation_self_affine" not in inputs)
    modulus = rubber.rubber.complex_modulus(inputs["series_omega"].values)
    np.testing.assert_array_equal(inputs["series_storage"], modulus.real)
    np.testing.assert_array_equal(inputs["series_loss"], modulus.imag)
    low, high = rubber.rubber.complex_modulus_band(inputs["series_omega"].values)
    np.testing.assert_array_equal(inputs["series_low_storage"], low.real)
    np.testing.assert_array_equal(inputs["series_high_loss"], high.imag)
    assert rubber.fit is not None
    assert inputs.attrs["prony_findings"] == "\n".join(rubber.fit.findings)
    end = fast_end(rubber.rubber)
    assert inputs.attrs["fast_end_modulus_Pa"] == end.modulus
    assert inputs.attrs["fast_end_plateau"] == end.plateau
    assert rubber.master is not None
    at_rows = rubber.rubber.complex_modulus(rubber.master.angular_frequency)
    np.testing.assert_array_equal(inputs["master_series_loss"], at_rows.imag)
