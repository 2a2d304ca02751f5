"""What a report says of a master curve, and what it must not say."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError, RubberWarning
from gripscale.rubber import MasterCurve, Rubber, fit_prony_report
from gripscale.rubber.material import fast_end, require_load_bearing, slow_end
from tests.rubber.truths import TRUTHS, curve_of, fractional_zener

SINES = gs.SineStack([1e-2], [1e-3])


def curve(modulus, low, high, noise=0.0):
    omega = np.geomspace(low, high, round(8 * np.log10(high / low)) + 1)
    return curve_of(modulus, omega, noise, seed=3)


def zener(omega):
    return fractional_zener(omega, 2e6, 1.5e9, 1e-7, 0.6)


def test_inconsistency_is_found_where_it_was_planted():
    """E' raised by 12 % over two decades: the joint fit shares that among both moduli."""
    clean = curve(zener, 1e-2, 1e9, 0.01)
    omega = clean.angular_frequency
    raised = np.where((omega > 1e4) & (omega < 1e6), 1.12, 1.0) * clean.storage
    report = fit_prony_report(MasterCurve(clean.frequency, raised, clean.loss))[1]
    assert len(report.inconsistencies) == 1
    (found,) = report.inconsistencies
    # a window of nine rows is a decade wide
    assert 1e3 < found.low < 1e5
    assert 1e5 < found.high < 1e7
    assert -0.12 < found.storage < -0.03
    assert not report.consistent
    assert f"{found.low:.3g} to {found.high:.3g} rad/s (E' {found.storage:+.0%}" in report.summary()
    assert fit_prony_report(clean)[1].consistent


def test_plateaus_are_only_said_where_they_were_measured():
    """E*(w) of a Zener solid is within 1 % of its plateaus two decades from its one time."""
    single = Rubber(2e6, [18e6], [1e-3])
    rubber, report = fit_prony_report(curve(single.complex_modulus, 1e-1, 1e7))
    assert slow_end(rubber).plateau
    assert fast_end(rubber).plateau
    assert slow_end(rubber).modulus == pytest.approx(2e6, rel=0.01)
    assert fast_end(rubber).modulus == pytest.approx(20e6, rel=0.01)
    assert report.findings == ()
    rubber, report = fit_prony_report(curve(single.complex_modulus, 1e2, 1e4))
    assert not slow_end(rubber).plateau
    assert not fast_end(rubber).plateau
    assert slow_end(rubber).modulus == pytest.approx(single.complex_modulus(1e2).real, rel=0.02)
    assert "no plateau at the slow end: the equilibrium modulus" in report.summary()
    assert "no plateau at the fast end" in report.summary()


def test_a_rubber_by_its_numbers_is_what_they_say():
    rubber = Rubber(2e6, [18e6], [1e-3])
    assert (slow_end(rubber).modulus, fast_end(rubber).modulus) == (2e6, 20e6)
    assert slow_end(rubber).plateau
    assert fast_end(rubber).plateau
    bare = Rubber(2e6, [18e6], [1e-3], valid_band=(1e2, 1e4))
    assert not slow_end(bare).plateau
    assert slow_end(bare).modulus == pytest.approx(bare.complex_modulus(1e2).real)


def test_a_bulk_modulus_too_small_for_the_glass_is_said():
    """E' = 1.48 GPa at 1e10 rad/s, G a third of it: (3K - 2G)/(2(3K + G)) is 0.18 for 0.6 GPa and
    0.3 for 2.6/1.2 G."""
    master = curve(zener, 1e-2, 1e10)
    assert "Poisson" not in fit_prony_report(master, bulk_modulus=2e9)[1].summary()
    text = fit_prony_report(master, bulk_modulus=0.6e9)[1].summary()
    assert "the bulk modulus, 600 MPa, gives Poisson's ratio 0.18" in text
    wanted = float(text.split(" MPa would give 0.3")[0].split()[-1])
    assert wanted == pytest.approx(2.6 / 1.2 * abs(zener(1e10)) / 3e6, rel=0.005)


def test_a_rubber_made_by_hand_is_warned_of_once():
    """E = 3 GPa is G = 1 GPa; K = 2 GPa gives (3*2 - 2)/(2 (3*2 + 1)) = 0.286, 13/6 GPa 0.3."""
    with pytest.warns(
        RubberWarning, match="2000 MPa, gives Poisson's ratio 0.29 at high freq"
    ) as w:
        soft = Rubber(1e6, [2.999e9], [1e-7])
    assert "2167 MPa would give 0.3" in str(w[0].message)
    assert w[0].filename == __file__
    # the same numbers again, in whatever way: nothing is said, and a warning would fail the test
    assert Rubber(1e6, [2.999e9], [1e-7]) == soft
    assert Rubber.from_dict(soft.to_dict()) == soft
    # within its band it is soft enough; |E*| at 1e8 rad/s is nearly all of it
    Rubber(1e6, [2.999e9], [1e-7], valid_band=(1.0, 1e5))
    with pytest.warns(RubberWarning, match=r"at 1e\+08 rad/s"):
        Rubber(1e6, [2.999e9], [1e-7], valid_band=(1.0, 1e8))
    # of a fitted one the report says it, and of what fits as well nothing is said again
    fitted, report = fit_prony_report(curve(zener, 1e-2, 1e10), bulk_modulus=0.6e9)
    assert any("Poisson" in one for one in report.findings)
    assert len(fitted.admissible_rubbers()) > 0


def melt():
    """A Maxwell liquid with a modulus of 1 MPa above 1 rad/s, measured three decades below."""
    fluid = curve(lambda w: 1e6 * 1j * w / (1 + 1j * w) + 1e6 * 1j * w * 1e-3, 1e-3, 1e3)
    return fit_prony_report(fluid)


def test_a_melt_is_told_before_any_solve():
    rubber, report = melt()
    assert "the data are those of a melt" in report.summary()
    assert rubber.equilibrium_modulus < 1e2
    load = {"pressure": 3e5, "footprint": 0.1}
    with pytest.raises(
        InputError, match=r"equilibrium_modulus \[Pa\] must be at least 1/10 .*3e.04"
    ):
        gs.solve_chain(rubber, SINES, speed=0.0, **load)
    wave = {"wavelength": 1e-2, "amplitude": 1e-3, "pressure": 3e5, "speed": 0.0}
    x = np.linspace(0.0, 1e-2, 65)
    line = gs.Profile(x, 1e-3 * np.cos(2e2 * np.pi * x))
    at_rest = {"pressure": 3e5, "speed": 0.0}
    for solve in (
        lambda: gs.solve_scale(rubber, **wave),
        lambda: gs.theory.solve_half_plane(rubber, **wave),
        lambda: gs.solve_profile(rubber, line, **at_rest),
        lambda: gs.solve_rough_contact(rubber, line, **at_rest),
    ):
        with pytest.raises(InputError, match=r"a melt at rest, .* leave out the static contact"):
            solve()
    with pytest.raises(InputError, match=r"the relaxation modulus after 100 s .* at least 1/10"):
        gs.solve_chain(rubber, SINES, speed=1e-3, **load)
    # a footprint of 0.1 m passes in 0.1 s, a tenth of the relaxation time: exp(-0.1) MPa are left
    require_load_bearing(rubber, 3e5, 0.1)


def test_a_curve_cut_in_the_transition_is_no_melt():
    truth = TRUTHS["Havriliak-Negami"]
    report = fit_prony_report(truth.measured(*truth.cut("flank"), 0.02, 0))[1]
    assert "melt" not in report.summary()
    assert "no plateau at the slow end" in report.summary()
