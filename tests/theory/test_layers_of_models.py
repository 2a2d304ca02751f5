"""The thickness of the rubber in the half-plane, the chain, Persson's theory and cases."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.half_space.model import DirectContact
from gripscale.surface import ArealSpectrum
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave.problem import Sine, WaveLoad, WaveProblem
from tests.half_space.rough_cases import many_waves

RUBBER = gs.Rubber(2e6, [1e6, 1e6], [1e-2, 1e-3], 2e9)
LENGTH, AMPLITUDE, PRESSURE = 1e-2, 4e-5, 2e4


def case(thickness: float | str | None) -> gs.Case:
    load = {"pressure": "1 bar", "speed": 0.3, "smallest_wavelength": "2 mm"}
    line = many_waves(1000, 60, 2e-4, seed=3)
    return gs.Case(line, RUBBER, **load, waves=3, thickness=thickness)


@pytest.mark.parametrize("speed", [0.0, 0.3])
def test_half_plane_of_a_thickness_is_the_direct_contact_of_one_wave(speed: float) -> None:
    problem = WaveProblem(RUBBER, Sine(LENGTH, AMPLITUDE), WaveLoad(PRESSURE, speed), 2e-3)
    wave = HalfPlane().solve(problem)
    x = np.arange(256) / 256 * LENGTH
    sine = gs.Profile(x, AMPLITUDE * np.cos(2.0 * np.pi * x / LENGTH))
    contact = gs.solve_rough_contact(
        RUBBER, sine, pressure=PRESSURE, speed=speed, periodic=True, thickness=2e-3, tolerance=1e-3
    )
    assert wave.contact_fraction == pytest.approx(contact.contact_fraction, rel=2e-3)
    assert wave.friction_from_dissipation == pytest.approx(
        contact.friction_from_dissipation, rel=2e-3, abs=1e-9
    )


def test_block_of_the_chain_is_no_higher_than_the_rubber() -> None:
    sines = gs.SineStack([LENGTH, 1e-3], [AMPLITUDE, 2e-6])
    load = {"pressure": PRESSURE, "speed": 0.3, "footprint": 0.1}
    none, thick, thin = (
        gs.solve_chain(RUBBER, sines, thickness=d, **load) for d in (None, 1.0, 2e-3)
    )
    assert thick.friction == none.friction
    assert [wave.details["depth"] for wave in thin.scales] == [0.2, 1.5]
    assert float(thin.to_dataset().thickness) == 2e-3
    alone = gs.solve_scale(
        RUBBER,
        wavelength=LENGTH,
        amplitude=AMPLITUDE,
        pressure=PRESSURE,
        speed=0.3,
        load_time=0.1 / 0.3,
        depth=0.2,
    )
    assert thin.scales[0].friction == pytest.approx(alone.friction, rel=1e-9)


def test_persson_theory_of_thick_rubber_is_that_of_the_half_space() -> None:
    wavenumber = np.geomspace(100.0, 1e4, 20)
    spectrum = ArealSpectrum(wavenumber, 1e-3 * wavenumber**-3.6)
    none, thick, thin = (
        gs.theory.persson(RUBBER, spectrum, pressure=1e5, speed=0.3, thickness=d)
        for d in (None, 1.0, 1e-3)
    )
    assert thick.contact_fraction == pytest.approx(none.contact_fraction, rel=1e-12)
    assert thick.friction == pytest.approx(none.friction, rel=1e-12)
    assert thin.contact_fraction < 0.9 * none.contact_fraction


def test_a_case_states_its_thickness_and_saves_it(tmp_path) -> None:  # type: ignore[no-untyped-def]
    thick, none = case("8 mm"), case(None)
    assert thick.load.thickness == 8e-3
    assert thick.key != none.key
    again = gs.read_case(thick.save(tmp_path / "case.toml"))
    assert again.load == thick.load
    assert any("Klüppel" in finding.sentence for finding in thick.findings())
    assert not any("thickness" in finding.sentence for finding in none.findings())
    with pytest.raises(InputError, match="thickness must be greater than zero"):
        case(-1.0)
    with pytest.raises(InputError, match="thickness"):
        case("8 kg")


def test_an_answer_states_its_thickness() -> None:
    answer = gs.answer(case("4 mm"))
    assert "rubber 4 mm thick on a rigid base" in answer.basis[0]
    direct = DirectContact(tolerance=0.05).predict(RUBBER, case(None).surface, case("4 mm").load)
    assert float(direct.thickness) == 4e-3
    assert direct.thickness.attrs["units"] == "m"


def test_thickness_varies_as_rubber_wears_down() -> None:
    study = gs.vary(case(None), thickness=["8 mm", "2 mm"]).to_dataset()
    assert study.thickness.values.tolist() == [8e-3, 2e-3]
    area = study.total_contact_fraction.values
    assert area[0] > 1.1 * area[1]


def test_a_study_of_another_input_states_the_thickness() -> None:
    study = gs.vary(case("4 mm"), speed=[0.1, 0.3])
    assert "rubber 4 mm thick on a rigid base" in str(study)
