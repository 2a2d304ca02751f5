"""Cases on a surface that is known by its spectrum only."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file.kinds import FileKeys, take
from gripscale.case_file.look import parts_of
from gripscale.core import InputError
from gripscale.rubber import styrene_butadiene
from gripscale.surface.random_phases import REAL_PHASES
from tests.samples import MEASURED_DMA

LOAD = {"pressure": 3e5, "speed": 0.3}


def spectrum(phases="real"):
    """Return that of a surface with waves of 10 to 1 mm."""
    q = 2.0 * np.pi * np.geomspace(1e2, 1e3, 21)
    return gs.Spectrum(q, 1e-12 * (q / q[0]) ** -3.6, name="psd", phases=phases)


@pytest.fixture
def folder(tmp_path):
    surface = spectrum()
    rows = zip(surface.wavenumber.tolist(), surface.density.tolist(), strict=True)
    text = "\n".join(["q [1/m],C(q) [m^4]", *(f"{q!r},{c!r}" for q, c in rows), ""])
    (tmp_path / "psd.csv").write_text(text, encoding="utf-8")
    return tmp_path


def case_text(surface):
    return (
        f'[surface]\n{surface}\n[rubber]\nname = "styrene_butadiene"\nfilled = false\n'
        "[load]\npressure = 3e5\nspeed = 0.3\nfootprint = 0.1\n"
    )


def test_a_case_file_is_the_case_in_python(folder):
    path = folder / "case.toml"
    path.write_text(case_text('spectrum = "psd.csv"\nscales = 8\ncut_off = "instrument"'))
    read = gs.read_case(path)
    made = gs.Case(spectrum(), styrene_butadiene(), filled=False, **LOAD)
    for ours, theirs in zip(
        read.surface.measured.cleaned, made.surface.measured.cleaned, strict=True
    ):
        np.testing.assert_array_equal(ours.z, theirs.z)
    np.testing.assert_array_equal(read.surface.sines.amplitude, made.surface.sines.amplitude)
    assert (read.load, read.rubber, read.surface.spectrum.phases) == (
        made.load,
        made.rubber,
        made.surface.spectrum.phases,
    )


def test_a_saved_case_is_the_same(tmp_path):
    made = gs.Case(spectrum("random"), styrene_butadiene(), filled=False, **LOAD)
    read = gs.read_case(made.save(tmp_path / "case.toml"))
    np.testing.assert_array_equal(
        read.surface.measured.cleaned[3].z, made.surface.measured.cleaned[3].z
    )
    assert read.surface.spectrum.phases == "random"


def test_real_phases_are_a_factor_and_random_ones_are_said():
    random, real, worn = (
        gs.answer(gs.Case(spectrum(phases), styrene_butadiene(), filled=False, **LOAD))
        for phases in ("random", "real", "worn")
    )
    assert "roughness down to 1 mm, for random phases." in str(random)
    assert "Solved on lines of your spectrum with random phases" in str(real)
    for answer, phases in ((real, "real"), (worn, "worn")):
        for at, name in enumerate(("contact_fraction", "friction")):
            ratio = getattr(answer, name) / getattr(random, name)
            free = 1.0 - float(random.data.total_contact_fraction)
            assert ratio == pytest.approx(REAL_PHASES[phases][at][0] ** free)
        assert answer.half_widths == {} or answer.half_widths["area"] > 0.5
    assert "random to real phases" in str(real)
    assert "a spectrum does not tell the phases" in " ".join(str(real).split())
    assert random.reliable


def test_questions_on_a_spectrum():
    """The chain has the closed form; what needs heights says so."""
    case = gs.Case(spectrum(), styrene_butadiene(), filled=False, **LOAD)
    closed = spectrum().height_difference(case.surface.correlation.lag)
    np.testing.assert_array_equal(case.surface.correlation.value, closed.value)
    assert not case.surface.doubts
    with pytest.raises(InputError, match="water needs a map"):
        case.replace(water=True)
    with pytest.raises(InputError, match="cleaning must be left out for a spectrum"):
        case.replace(cleaning={})
    assert "random to real phases" in str(gs.compare(case, models=["direct"]))
    shorter = case.replace(smallest_wavelength=2e-3)
    assert shorter.surface.measured.cleaned[0].step == pytest.approx(2e-3 / 8)


def test_a_spectrum_is_recognised(shell, folder):
    file = take(folder / "psd.csv", FileKeys())
    assert (file.kind, file.columns[2].name) == ("spectrum", "C(q)")
    assert "21 points, rms height" in file.why
    assert any("wavenumber" in str(part) for part in parts_of(file, FileKeys()))
    out = folder / "new.toml"
    shell("new", folder / "psd.csv", MEASURED_DMA, "--temperature", "20 C", "--output", out)
    assert gs.read_case(out).surface.spectrum == replace(spectrum(), source=str(folder / "psd.csv"))
