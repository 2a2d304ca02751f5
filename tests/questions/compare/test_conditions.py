"""A comparison in its conditions: what reaches which model, and what is said of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.conditions import Conditions
from gripscale.io.table import as_text, significant
from gripscale.questions import SolvedLadder
from gripscale.questions.answer.page import answer_lines
from gripscale.questions.compare.question import comparison_table, temperature_only
from gripscale.surface import self_affine_profile
from tests.samples import SOFTENING

CASE = f"""
[surface]
files = ["road.dat"]
x_unit = "m"
z_unit = "m"
scales = 3
smallest_wavelength = "0.5 mm"
[rubber]
name = "styrene_butadiene"
shift = {{ kind = "wlf", c1 = 8.0, c2 = "120 K" }}
[load]
pressure = "3 bar"
speed = "0.1 m/s"
footprint = "50 mm"
[solver]
model = "half_plane"
[conditions]
temperature = "35 C"
{SOFTENING}[conditions.shear_stress]
kind = "constant"
stress_0 = "2 MPa"
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> SolvedLadder:
    folder = tmp_path_factory.mktemp("conditions")
    line = self_affine_profile(0.8, 5e-3, 0.1e-3, 0.1, 1e-4, seed=4)
    np.savetxt(folder / "road.dat", np.column_stack([line.x, line.z]))
    case = folder / "case.toml"
    case.write_text(CASE, encoding="utf-8")
    models = ["chain_half_plane", "direct", "persson"]
    ladder = gs.compare(read_case(case), seeds=1, models=models).ladder
    assert ladder is not None
    return ladder


def test_chain_and_direct_contact_know_every_effect(made: SolvedLadder) -> None:
    (subject,) = made.setups
    alone = gs.solve_rough_contact(
        subject.rubber,
        subject.surface.measured.cleaned[0],  # type: ignore[union-attr]
        pressure=3e5,
        speed=0.1,
        footprint=0.05,
        smallest_wavelength=float(subject.surface.sines.wavelength[-1]),
        tolerance=subject.tolerance,
        conditions=subject.conditions,
    )
    direct, chain = (made.data.sel(model=name) for name in ("direct", "chain_half_plane"))
    assert direct.total_friction == pytest.approx(alone.friction, rel=1e-12)
    areas = alone.contact_fraction, float(chain.total_contact_fraction)
    for member, area in zip((direct, chain), areas, strict=True):
        assert member.total_adhesive_friction == pytest.approx(2e6 * area / 3e5, rel=1e-12)


def test_a_theory_knows_temperature_and_softening(made: SolvedLadder) -> None:
    subject, persson = made.setups[0], made.data.sel(model="persson")
    line = subject.surface.measured.cleaned[0]  # type: ignore[union-attr]
    spectrum = gs.surface.areal_spectrum(gs.surface.profile_spectrum(line))
    end = 2 * math.pi / spectrum.wavenumber[-1]
    smallest = max(float(subject.surface.sines.wavelength[-1]), end)
    load = {"pressure": 3e5, "speed": 0.1, "smallest_wavelength": smallest}
    asked = Conditions(temperature=308.15, softening=subject.conditions.softening)
    alone = gs.theory.persson(subject.rubber, spectrum, conditions=asked, **load)
    warm = gs.theory.persson(subject.rubber.at(308.15), spectrum, **load)
    assert alone.friction > 1.5 * warm.friction  # full contact: g alone counts, near its peak
    assert persson.total_friction == pytest.approx(alone.friction, rel=1e-9)
    own = 2e6 * alone.contact_fraction / 3e5
    assert persson.total_adhesive_friction == pytest.approx(own, rel=1e-9)
    words = "Softening: in the chains, the direct contacts and Persson"
    assert any(words in line for line in temperature_only(made.data))


def test_table_and_answer_have_the_area_term(made: SolvedLadder) -> None:
    data = made.data
    text = as_text(comparison_table(data))
    direct = made.data.sel(model="direct")
    total = float(direct.total_friction + direct.total_adhesive_friction)
    assert f"{total:.2f}" in text
    # 2 MPa on the contact area of the estimate, not on that of the direct contact
    both = float(data.answer_hysteresis_friction) + 2e6 * float(data.answer_contact_fraction) / 3e5
    assert float(data.answer_friction) == pytest.approx(both, rel=1e-12)
    assert f"μ = {significant(both)}: " in next(answer_lines(data))


def test_a_comparison_over_the_temperature_asks_every_model_at_it(made: SolvedLadder) -> None:
    models, temperatures = ["chain_half_plane", "persson"], {"temperature": "20 C,35 C"}
    over = gs.compare(made.case, vary=temperatures, seeds=1, models=models)
    data = over.data
    warm = data.sel(temperature=308.15)
    for member in models:
        own = float(made.data.total_friction.sel(model=member))
        assert float(warm.total_friction.sel(model=member)) == pytest.approx(own, rel=1e-12)
        cold = float(data.total_friction.sel(temperature=293.15, model=member))
        assert abs(cold / own - 1.0) > 0.01
    assert over.ladder is not None
    kelvins = [setup.continuation.conditions.temperature for setup in over.ladder.setups]
    assert kelvins == [293.15, 308.15], "roughness below the measurement, too"
