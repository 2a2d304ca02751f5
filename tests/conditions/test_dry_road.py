"""The shear stress of a dry road: its numbers from measured friction, each compound left out."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import area_term as dry
from gripscale.conditions import shear_stress_from_dict, shear_stress_to_dict
from gripscale.conditions.area_term import DRY_TREAD, DryTread
from gripscale.core import InputError
from studies.dry_law import COMPOUNDS, WITH_RESIN, each_left_out, fitted, judged, points
from studies.measured_road import FINEST, road_lines, spectrum_of_lines, with_spectrum
from studies.treads import SERIES_S, road_spectrum

OF = points()
LAW = fitted({name: OF[name] for name in SERIES_S})


def test_the_numbers_are_those_of_the_points():
    """To their last digit."""
    assert pytest.approx(LAW.stress_0, rel=3e-3) == dry.DRY_STRESS_0
    assert pytest.approx(LAW.width, abs=6e-4) == dry.DRY_WIDTH
    assert pytest.approx(LAW.speed_0, rel=5e-3) == dry.DRY_SPEED_0
    assert pytest.approx(LAW.scatter, abs=6e-3) == dry.STRESS_SCATTER


def test_each_compound_left_out_lies_in_the_interval_of_the_others():
    """At least 85 % of the points, where 90 % is said."""
    for names, count in ((SERIES_S, 17), (COMPOUNDS, 29)):
        rows = each_left_out(OF, names).values()
        assert sum(row.points for row in rows) == count
        assert sum(row.inside for row in rows) >= 0.85 * count


def test_resin_raises_the_stress_as_the_sentence_says():
    raised = [np.exp(judged(LAW, OF[name]).mean) - 1.0 for name in WITH_RESIN]
    low, high = sorted(round(100.0 * each) for each in raised)
    assert f"by {low} to {high} %" in dry.DRY_ASSUMPTIONS


def test_the_law_is_a_bell_held_beyond_the_measured_speeds():
    speed = np.array([1e-3, 0.1])
    expected = dry.DRY_STRESS_0 * np.exp(-dry.DRY_WIDTH * np.log10(speed / dry.DRY_SPEED_0) ** 2)
    np.testing.assert_allclose(DRY_TREAD.stress(speed, 350.0), expected)
    assert DRY_TREAD.stress(1e-9) == DRY_TREAD.stress(dry.DRY_SPEEDS[0])
    assert DRY_TREAD.stress(30.0) == DRY_TREAD.stress(dry.DRY_SPEEDS[1])
    up = np.log(DryTread(1.0).stress(0.1) / DRY_TREAD.stress(0.1))
    assert float(up) == pytest.approx(dry.STRESS_SCATTER)
    with pytest.raises(InputError, match="speed must not be negative"):
        DRY_TREAD.stress(-1.0)


def test_a_case_and_a_result_store_it_by_its_kind():
    assert shear_stress_to_dict(DryTread(0.5)) == {"kind": "dry_tread", "deviation": 0.5}
    assert shear_stress_from_dict({"kind": "dry_tread"}) == DRY_TREAD


def test_lines_of_a_self_affine_surface_in_closed_form():
    """C = L q^-(2 + 2 H), H = 1/2, C_1 = 2 sqrt(pi) Gamma(H + 1/2)/Gamma(H + 1) q C: 4 q C."""
    q = np.geomspace(1e2, 1e7, 200)
    surface = gs.surface.ArealSpectrum(q, 1e-6 * q**-3)
    at = np.array([1e3, 1e4])
    np.testing.assert_allclose(spectrum_of_lines(surface, at), 4.0 * 1e-6 * at**-2, rtol=2e-3)


def test_the_lines_have_the_spectrum_of_the_road():
    """Each tenth of a decade, from ten waves in the line on."""
    surface = road_spectrum(whole=True)
    for line in road_lines():
        again = with_spectrum(line.z, line.step, surface)
        np.testing.assert_allclose(again.std(), line.z.std(), rtol=0.01)
        waves = np.abs(np.fft.rfft(line.z)) ** 2
        q = 2.0 * np.pi * np.fft.rfftfreq(line.z.size, line.step)
        density = line.step / np.pi * waves / line.z.size
        for low in (3e2, 3e3, 3e4):
            inside = (q >= low) & (q < 2.0 * low)
            target = spectrum_of_lines(surface, q[inside][:: inside.sum() // 20])
            assert density[inside].mean() == pytest.approx(target.mean(), rel=0.1)
        assert np.abs(waves[q > 2.0 * np.pi / FINEST]).max() < 1e-9 * waves.max()
