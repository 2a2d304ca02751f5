"""Storage and loss modulus exchanged: noticed in every rubber we have, never where they are not."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.rubber import MasterCurve, fit_prony_report, read_master_curve, springpot_modulus
from gripscale.rubber.prony_report import SwappedModuli
from tests.rubber.test_sweeps_reader import POLYMER
from tests.rubber.truths import TREAD, TRUTHS, curve_of, fractional_zener


def turned(curve):
    return MasterCurve(curve.frequency, curve.loss, curve.storage)


def polymer():
    return gs.rubber.superpose(gs.read_sweeps(POLYMER), reference_temperature=293.15)


def part(curve, rows):
    return MasterCurve(curve.frequency[rows], curve.storage[rows], curve.loss[rows])


MEASURED = {
    "tread": lambda: read_master_curve(TREAD),
    "polymer": polymer,
    "SBR": lambda: curve_of(springpot_modulus, np.geomspace(1e-2, 1e10, 97)),
}


@pytest.mark.parametrize("name", MEASURED)
def test_exchanged_moduli_are_refused_and_others_are_not(name):
    curve = MEASURED[name]()
    assert not SwappedModuli(curve).likely
    with pytest.raises(InputError, match=r"storage and loss modulus look exchanged.*\(columns\)"):
        fit_prony_report(turned(curve), bulk_modulus=1e10)


@pytest.mark.parametrize("where", ["whole", "no glass", "no rubber", "flank"])
@pytest.mark.parametrize("name", TRUTHS)
def test_no_rubber_of_ours_is_taken_for_an_exchanged_one(name, where):
    """With errors of ten per cent; what a wrong alarm begins with is more than twice away."""
    truth = TRUTHS[name]
    for seed in range(3):
        found = SwappedModuli(truth.measured(*truth.cut(where), 0.1, seed))
        assert found.as_given < 0.25
        assert not found.likely


@pytest.mark.parametrize("exponent", [0.3, 0.6, 0.8])
def test_transitions_with_a_large_loss_factor(exponent):
    omega = np.geomspace(1e0, 1e8, 65)
    modulus = fractional_zener(omega, 1e6, 2e9, 1e-6, exponent)
    curve = MasterCurve(omega, modulus.real, modulus.imag)
    assert max(curve.loss_factor) > {0.3: 0.4, 0.6: 1.0, 0.8: 2.5}[exponent]
    for rows in (slice(None), slice(0, 25), slice(20, 45), slice(40, 65)):
        assert not SwappedModuli(part(curve, rows)).likely
    assert SwappedModuli(turned(curve)).certain


def test_parts_of_the_tread_curve_and_single_sweeps():
    tread = read_master_curve(TREAD)
    for rows in (slice(0, 30), slice(30, 60), slice(60, 105), slice(10, 20)):
        assert not SwappedModuli(part(tread, rows)).likely
        assert SwappedModuli(turned(part(tread, rows))).certain
    for sweep in gs.read_sweeps(POLYMER):
        one = MasterCurve(sweep.frequency, sweep.storage, sweep.loss)
        assert not SwappedModuli(one).likely
        assert SwappedModuli(turned(one)).likely


def test_a_melt_is_no_exchanged_rubber():
    """One Maxwell element that flows: E' rises with the square of the frequency, E'' with it."""
    fluid = curve_of(lambda w: 1e6 * 1j * w / (1.0 + 1j * w), np.geomspace(1e-3, 1e1, 33))
    assert not SwappedModuli(fluid).likely


def test_what_looks_exchanged_is_said():
    """Where the loss factor passes one, each curve is nearly the other: said, not refused."""
    omega = np.geomspace(1e2, 1e6, 41)
    curve = turned(curve_of(lambda w: fractional_zener(w, 1e6, 2e9, 1e-5, 0.6), omega))
    found = SwappedModuli(curve)
    assert found.likely
    assert not found.certain
    report = fit_prony_report(curve, bulk_modulus=1e10)[1]
    assert report.findings[0].startswith("storage and loss modulus look exchanged")
    assert "storage and loss modulus look exchanged" in str(report.doubts[0])
