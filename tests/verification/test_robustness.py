"""Random loads, solved cold: as real roads bring them, and how a wave ends on other meshes."""

import os
import time
import warnings
from collections import Counter

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import RubberWarning
from tests.verification.load_grid import cases
from tests.verification.random_waves import FAR, ORDINARY, random_waves, solve

COUNT = int(os.environ.get("GRIPSCALE_RANDOM_WAVES", "1000"))
"""Random waves of the ordinary box that are verified, and five times those far outside of it."""
with warnings.catch_warnings(action="ignore", category=RubberWarning):  # nearly no bulk modulus
    VISCOUS = gs.Rubber(5.73e6, [5.76e9, 3.80e9], [1.12e-7, 1.73e-7], bulk_modulus=2.2e9)
"""E* ~ i w over the harmonics: entering and leaving edge of a contact differ most."""


@pytest.mark.parametrize("mesh", [(48, 10), (64, 12), (80, 14), (96, 16), (112, 18)])
def test_a_viscous_wave_has_no_fold_on_any_mesh(mesh):
    """Its contact sets cycle when nodes change sides in the order of their errors.

    At 2 % strain the linearised problem has exactly one solution: the symmetric part of the
    compliance is positive definite. Seven or eight load steps are what easy waves need.
    """
    columns, rows = mesh
    load = {"wavelength": 1e-3, "amplitude": 8e-6, "pressure": 0.95e6, "speed": 1.0}
    result = gs.solve_scale(VISCOUS, **load, columns=columns, rows=rows)
    assert result.status == "converged"
    assert result.details["load_steps"] <= 10
    # Full contact, whose closed form is good to (k A)^2 = 0.0025.
    full = VISCOUS.plane_strain_modulus(2e3 * np.pi).imag * (2e3 * np.pi * 8e-6) ** 2 / 4 / 0.95e6
    assert result.contact_fraction == 1.0
    assert result.friction == pytest.approx(full, rel=0.01)


def test_a_wave_that_a_coarse_mesh_cannot_carry_is_solved_on_a_finer_one():
    """Elastic, steep, near full contact: stretches of 0.13 on 64 columns, 0.40 on 128."""
    (wave,) = random_waves(ORDINARY, 1, first=153)
    found = solve(wave)
    assert (found.status, found.details["columns"]) == ("converged", 128)
    assert found.friction_mismatch < 0.01
    (wave,) = random_waves(FAR, 1, first=172)
    assert solve(wave).status == "mean shear too large"


@pytest.mark.parametrize("speed", [0.0, 1.0])
@pytest.mark.parametrize("share", [1e-12, 1e-9, 1e-6])
def test_a_contact_narrower_than_a_node_is_refused_at_once(speed, share):
    """Shares of the pressure of full contact; Hertz's width is 2/pi sqrt(share) at rest."""
    rubber = gs.Rubber(3e6, [2e7], [1e-5])
    full = np.pi * rubber.plane_strain_modulus(0.0).real * 0.02
    start = time.process_time()
    result = gs.solve_scale(
        rubber, wavelength=1e-3, amplitude=2e-5, pressure=share * full, speed=speed
    )
    assert time.process_time() - start < 0.5
    assert result.status == "contact too narrow"
    expected = result.details["expected_contact_width"]
    assert result.details["smallest_contact_width"] == pytest.approx(1e-3 / 512)
    assert f"{expected:.2g} m is expected" in result.why
    if speed == 0.0:
        assert expected == pytest.approx(1e-3 * 2 / np.pi * np.sqrt(share), rel=0.01)
    else:
        assert expected < 1e-3 * 2 / np.pi * np.sqrt(share)


@pytest.mark.parametrize(
    "wave", list(random_waves(ORDINARY, 60)), ids=lambda wave: f"wave {wave.number}"
)
def test_an_ordinary_random_wave_converges_cold(wave):
    result = solve(wave)
    assert result.status == "converged"
    # 64 columns, or more where narrow, nearly elastic contacts ask for them
    assert abs(result.friction - result.friction_from_dissipation) <= result.friction_bound
    assert 0.0 < result.contact_fraction <= 1.0
    assert 0.0 < result.min_stretch < 1.0 < result.max_stretch


@pytest.mark.verification
@pytest.mark.parametrize(("box", "count"), [(ORDINARY, COUNT), (FAR, max(COUNT // 5, 1))])
def test_random_waves_converge_cold_or_end_for_a_stated_cause(box, count):
    """999 of 1000 of the ordinary box; GRIPSCALE_RANDOM_WAVES says how many are drawn.

    Far outside 87 of 100 converge (785 of 904). Others end for mean shear beyond what a bonded
    block carries, for contacts of too few nodes, or for frictions that differ; 3 of the 904 as
    folds. Bounds leave twice the scatter of 200 waves.
    """
    found = [solve(wave) for wave in random_waves(box, count)]
    solved = [result.friction_mismatch for result in found if result.converged]
    statuses = Counter(str(result.status) for result in found)
    print(statuses, "mismatch", np.quantile(solved, (0.5, 0.9, 0.95, 0.99, 1.0)).round(4))
    failed = count - statuses["converged"]
    if box is ORDINARY:
        assert failed <= max(1, COUNT // 1000)
        return
    assert failed <= 0.13 * count + 2.0 * (0.12 * count) ** 0.5
    causes = ("mean shear too large", "contact too narrow", "frictions disagree")
    assert failed - sum(statuses[cause] for cause in causes) <= 0.01 * count + 1


@pytest.mark.verification
@pytest.mark.parametrize(("columns", "rows", "typical"), [(64, 12, 0.002), (128, 20, 0.001)])
def test_three_hundred_random_loads_converge_cold(columns, rows, typical):
    """All of them, where 99 % is asked, with a mismatch above 2 % only in contacts of few nodes.

    Half the loads have many. The columns are doubled where the frictions differ by more than 5 %.
    """
    results = [
        gs.solve_scale(case.rubber, **case.arguments(), columns=columns, rows=rows)
        for case in cases()
    ]
    assert Counter(result.status for result in results) == {"converged": 300}
    mismatch = [result.friction_mismatch for result in results]
    assert np.median(mismatch) < typical
    nodes = [result.details["columns"] * result.contact_fraction for result in results]
    for many, off in zip(nodes, mismatch, strict=True):
        assert off < 0.02 or many < 24.0
