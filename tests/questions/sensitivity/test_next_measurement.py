"""What to measure next: the arithmetic, and the narrowing against measurements withheld."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.half_space import DirectContact
from gripscale.questions.sensitivity.next_measurement import AGAIN, next_measurements
from gripscale.questions.uncertainty.first_order import first_order
from gripscale.questions.uncertainty.sampling import Uncertainty
from gripscale.questions.uncertainty.sources import SOURCES
from gripscale.surface import self_affine_profile
from tests.questions.answer.test_answer_object import made
from tests.samples import POWER_LAW


@pytest.fixture(scope="module")
def result() -> gs.Sensitivity:
    return gs.sensitivity(made())


def rows(result: gs.Sensitivity) -> dict[str, tuple[float, float]]:
    """Return half width of the friction and share taken by measurement."""
    table = next_measurements(result.data)
    assert table is not None
    columns = {column.name: column.values for column in table.columns}
    pairs = zip(columns["friction_width"], columns["takes"], strict=True)
    return dict(zip(columns["measurement"], pairs, strict=True))


def test_measurements_are_ranked_by_what_they_take(result: gs.Sensitivity) -> None:
    """The table stands in the answer; a map takes the step from lines to a surface."""
    found = rows(result)
    widths = [width for width, _ in found.values()]
    assert widths[1:] == sorted(widths[1:])
    assert all(width <= widths[0] for width in widths)
    assert next(iter(found)) == "none"
    assert any(name.startswith("a map in place of lines") for name in found)
    assert "What to measure next" in str(result)


def test_a_measurement_leaves_the_rest_of_the_variance(result: gs.Sensitivity) -> None:
    """All errors but one are zero: the share left is that of the error; a road gains freedom."""
    data = result.data.copy()
    only = xr.where(data.source == "cut_off", 0.1, 0.0)
    data = data.assign(source_friction_error=only, source_contact_fraction_error=only)
    found = rows(gs.Sensitivity(data))
    others = math.asinh(found["a finer profile, to where the roughness ends"][0])
    now = math.asinh(found["none"][0])
    assert now**2 - others**2 == pytest.approx((1.645 * 0.1) ** 2, rel=0.25)
    taken = found["a finer profile, to where the roughness ends"][1]
    assert taken == pytest.approx(1.0 - math.sinh(others) / math.sinh(now))


def test_a_sweep_of_the_compound_takes_the_scatter_between_treads() -> None:
    """What is not known of softening is in the interval, as it is in that of the answer."""
    case = made(filled=True)
    result = gs.sensitivity(case)
    found = rows(result)
    assert found["strain sweeps of the compound"][1] > 0.0
    assert found["whether the strain sweeps are in tension or in shear"][1] > 0.0
    assert found["none"][0] > rows(gs.sensitivity(made()))["none"][0]
    # as the answer, which has the error of its grid and none of the inputs
    answered = float(gs.answer(case).data["answer_friction_half_width"])
    assert found["none"][0] == pytest.approx(answered, rel=0.05)


def road(seed: int) -> gs.Profile:
    return self_affine_profile(0.8, 4e-3, 3e-4, length=0.4, step=2e-4, seed=seed)


def case_of(
    roads: list[gs.Profile], rubber: gs.MasterCurve | None = None, end: float = 1e-3
) -> gs.Case:
    rubber = rubber or made().measured_rubber.master
    return gs.Case(roads, rubber, pressure=3e5, speed=0.3, smallest_wavelength=end)


def error_of(source: str, case: gs.Case) -> float:
    """Return the first-order error of the friction by one source."""
    options = Uncertainty(without=[name for name in SOURCES if name != source])
    errors = first_order(case, options, count=256).friction_error
    return float(errors.sel(source=source))


def noisy(seed: int, step: int) -> gs.MasterCurve:
    """Return a master curve with scatter of 4 %, each or every second of its points."""
    frequency = np.geomspace(1e-2, 1e7, 120)[::step]
    modulus = POWER_LAW.complex_modulus(2.0 * np.pi * frequency)
    noise = 1.0 + 0.04 * np.random.default_rng(seed).standard_normal((2, frequency.size))
    return gs.MasterCurve(frequency, modulus.real * noise[0], modulus.imag * noise[1])


@pytest.mark.verification
def test_what_withheld_measurements_would_have_taken() -> None:
    """Ten cases: a withheld profile, half of a sweep, the last octave.

    Profile and sweep leave 1/sqrt(2) of the error with the whole of what the half leaves. The error
    of an error from some twenty pieces, or a hundred points, is a sixth: five ratios of two hold
    their mean to 0.12, three to 0.14. The octave changes the friction by its exponent, of the
    octave before: within a third on three roads.
    """
    profiles = [
        error_of("profile", case_of([road(2 * i), road(2 * i + 1)]))
        / error_of("profile", case_of([road(2 * i)]))
        for i in range(5)
    ]
    sweeps = [
        error_of("modulus", case_of([road(0)], noisy(seed, 1)))
        / error_of("modulus", case_of([road(0)], noisy(seed, 2)))
        for seed in range(2)
    ]
    octaves = []
    for seed in range(3):
        coarse, fine = (
            DirectContact(tolerance=None).predict(case.rubber, case.surface, case.load)
            for case in (case_of([road(seed)], end=end) for end in (2e-3, 1e-3))
        )
        name = "total_friction_from_dissipation"
        gained = np.log(float(fine[name] / coarse[name]))
        octaves.append(-gained / np.log(2.0) / float(coarse.total_friction_cut_off_exponent))
    print("profiles", profiles, "sweeps", sweeps, "octaves", octaves)
    assert np.exp(np.mean(np.log(profiles))) == pytest.approx(AGAIN, abs=0.15)
    assert np.exp(np.mean(np.log(sweeps))) == pytest.approx(AGAIN, abs=0.2)
    assert np.mean(octaves) == pytest.approx(1.0, abs=0.33)
