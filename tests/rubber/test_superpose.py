"""Known rubbers measured at ten temperatures, with scatter: are shifts and moduli found again?"""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.rubber import (
    WLF,
    ShiftTable,
    Sweeps,
    fit_wlf,
    read_shift_table,
    springpot_modulus,
    superpose_report,
    write_master_curve,
)
from tests.samples import EXAMPLES

ROOM = 293.15
TRUE = WLF(8.86, 101.6, ROOM)
HERTZ = np.geomspace(0.1, 50.0, 12)
TRANSITION = np.linspace(-15.0, 21.0, 10)
"""Temperatures at which the springpots are on their flank within the frequencies measured [C]."""
POLYMER = EXAMPLES / "data/rubber/multi_temperature_polymer"


def measured(celsius, noise, seed=0, hertz=HERTZ, modulus=springpot_modulus, lift=0.0):
    """Sweeps with relative scatter; b_T grows by `lift` for every kelvin above room temperature."""
    generator = np.random.default_rng(seed)
    rows = []
    for degrees in celsius:
        kelvin = 273.15 + degrees
        value = modulus(2 * np.pi * hertz * TRUE.a(kelvin, ROOM)) / (1 + lift * (kelvin - ROOM))
        scatter = np.exp(noise * generator.standard_normal((2, len(hertz))))
        printed = kelvin + 0.05 * np.round(generator.standard_normal(len(hertz)), 1)
        rows.append([printed, hertz, value.real * scatter[0], value.imag * scatter[1]])
    return Sweeps(*np.hstack(rows))


def shift_errors(sweeps, table):
    return table.log_a(table.temperature, ROOM) - TRUE.log_a(sweeps.temperatures, ROOM)


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.02])
def test_ten_sweeps_of_a_known_rubber(noise):
    sweeps = measured(TRANSITION, noise)
    master = gs.superpose(sweeps, reference_temperature=ROOM)
    assert np.abs(shift_errors(sweeps, master.shift)).max() < (0.03 if noise else 0.01)
    truth = springpot_modulus(master.angular_frequency)
    assert np.median(np.abs(master.storage / truth.real - 1.0)) < 0.05
    assert np.median(np.abs(master.loss / truth.imag - 1.0)) < 0.05
    assert (master.reference_temperature, len(master)) == (ROOM, 120)


def test_standard_errors_are_those_of_the_scatter():
    celsius, off = np.linspace(-15.0, 75.0, 10), []
    for seed in range(12):
        sweeps = measured(celsius, 0.02, seed)
        table = gs.superpose(sweeps, reference_temperature=ROOM).shift
        known = table.horizontal_error > 0.0
        off.append((shift_errors(sweeps, table) / table.horizontal_error)[known])
        # Wide on the rubbery plateau, which says little; narrow in the transition.
        assert table.horizontal_error[-1] > 3.0 * table.horizontal_error[0]
    # 12 draws of 9 to 10 shifts, correlated along the chain: a third or so about one.
    assert np.sqrt(np.mean(np.concatenate(off) ** 2)) == pytest.approx(1.0, abs=0.4)


def test_sweeps_that_may_not_meet_have_a_bound_for_a_shift():
    """With c1 = 7.4, c2 = 121.6 K sweeps of 2.7 decades at -50 and -40 C are 2.8 decades apart."""
    law, celsius = WLF(7.4, 121.6, ROOM), [-50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0]
    kelvin = 273.15 + np.array(celsius)
    rows = []
    for at, shift in zip(kelvin, law.a(kelvin, ROOM), strict=True):
        value = springpot_modulus(2 * np.pi * HERTZ * shift)
        rows.append([np.full(HERTZ.size, at), HERTZ, value.real, value.imag])
    master, report = superpose_report(Sweeps(*np.hstack(rows)), reference_temperature=ROOM)
    table = master.shift
    off = np.abs(table.log_a(kelvin, ROOM) - law.log_a(kelvin, ROOM))
    assert off[0] > 0.3
    assert off[0] < table.horizontal_error[0] < 3.0 * off[0]
    assert off[1:].max() < 0.05
    assert table.horizontal_error[1:].max() < 0.05
    assert "or not at all" in report.summary()


def test_reference_between_two_sweeps():
    sweeps = measured(TRANSITION, 0.0)
    at = 273.15 - 7.3
    table = gs.superpose(sweeps, reference_temperature=at).shift
    assert table.log_a(at, at) == 0.0
    assert table.log_a(sweeps.temperatures, at) == pytest.approx(
        TRUE.log_a(sweeps.temperatures, at), abs=0.02
    )
    assert (table.horizontal_error > 0.0).all()
    law = fit_wlf(table, reference_temperature=ROOM)
    assert law.shift.c2 == pytest.approx(101.6, abs=5 * law.errors["c2"] + 2.0)
    # Beyond the last sweep by what is printed otherwise than meant: it is the one at the reference.
    beyond = gs.superpose(sweeps, reference_temperature=273.15 - 15.2).shift
    assert beyond.temperature[0] == 273.15 - 15.2
    assert beyond.horizontal_error[0] == 0.0


def test_vertical_shift_is_found_where_the_moduli_tell():
    sweeps = measured(TRANSITION, 0.002, lift=0.004)
    master, report = superpose_report(sweeps, reference_temperature=ROOM, vertical=True)
    assert "a_T and b_T were found together" in report.summary()
    table = master.shift
    true = np.log10(1.0 + 0.004 * (sweeps.temperatures - ROOM))
    assert table.vertical - np.interp(ROOM, table.temperature, table.vertical) == pytest.approx(
        true, abs=0.006
    )
    assert np.abs(shift_errors(sweeps, table)).max() < 0.03
    # Moduli are multiplied by b_T, in the curve as in the report: there neighbours then agree.
    lifted = np.repeat(table.b(table.temperature, ROOM), len(HERTZ)) * sweeps.storage
    assert np.sort(lifted) == pytest.approx(np.sort(master.storage))
    assert max(one.storage for one in report.overlaps) < 0.003
    flat = gs.superpose(sweeps, reference_temperature=ROOM)
    assert (flat.shift.vertical == 0.0).all()


@pytest.mark.parametrize("moduli", ["storage", "loss", "loss_factor"])
def test_one_modulus_alone(moduli):
    sweeps = measured(TRANSITION, 0.01)
    table = gs.superpose(sweeps, reference_temperature=ROOM, moduli=moduli).shift
    # E''/E' of a springpot flank hardly changes with frequency: a third of the information.
    most = 0.3 if moduli == "loss_factor" else 0.06
    assert np.abs(shift_errors(sweeps, table)).max() < most


def test_a_given_shift_is_honoured():
    sweeps = measured(TRANSITION, 0.01)
    master, report = superpose_report(
        sweeps, reference_temperature=ROOM, shift=WLF(TRUE.c1, TRUE.c2)
    )
    assert not report.fitted
    assert master.shift == TRUE
    kelvin = np.repeat(sweeps.temperatures, len(HERTZ))
    assert np.sort(sweeps.frequency * TRUE.a(kelvin, ROOM)) == pytest.approx(master.frequency)
    # A table is read at its own temperatures, although sweeps were at 20.03 or 19.98 °C.
    edited = ShiftTable(273.15 + TRANSITION, np.arange(10.0)[::-1], np.zeros(10))
    first = gs.superpose(sweeps, reference_temperature=273.15 + 21.0, shift=edited)
    assert first.frequency[-1] == pytest.approx(50.0 * 1e9)
    with pytest.raises(InputError, match="vertical must be False with a shift that is given"):
        gs.superpose(sweeps, reference_temperature=ROOM, shift=TRUE, vertical=True)


def test_how_neighbours_meet():
    sweeps = measured([-10.0, 0.0, 10.0], 0.02)
    _, report = superpose_report(sweeps, reference_temperature=273.15, shift=TRUE)
    for one in report.overlaps:
        apart = TRUE.log_a(one.colder, one.warmer)
        assert one.decades == pytest.approx(np.log10(500.0) - apart, abs=1e-9)
        # Two scatters of 2 %, the interpolated one less.
        assert one.storage == pytest.approx(np.sqrt(1.6) * 0.02 / np.log(10.0), rel=0.4)
    assert report.findings == ()
    _, wrong = superpose_report(sweeps, reference_temperature=273.15, shift=WLF(7.0, 101.6, ROOM))
    assert any("E'' of 2 of 2 neighbours does not superpose" in one for one in wrong.findings)


def test_sweeps_without_anything_in_common():
    with pytest.raises(InputError, match=r"those at -1\d\.\d\d and 60\.0\d °C do not"):
        gs.superpose(measured([-15.0, 60.0], 0.01), reference_temperature=ROOM)
    single = Sweeps([280.0, 290.0], [1.0, 1.0], [2e6, 1e6], [1e6, 1e6])
    with pytest.raises(InputError, match="must overlap"):
        gs.superpose(single, reference_temperature=285.0)
    shifted = gs.superpose(single, reference_temperature=285.0, shift=TRUE)
    assert shifted.frequency == pytest.approx(np.sort(TRUE.a([280.0, 290.0], 285.0)))


def test_bad_arguments():
    sweeps = measured(TRANSITION, 0.01)
    with pytest.raises(InputError, match="must lie within the temperatures measured"):
        gs.superpose(sweeps, reference_temperature=320.0)
    with pytest.raises(InputError, match="moduli must be one of both, storage, loss, loss_factor"):
        gs.superpose(sweeps, reference_temperature=ROOM, moduli="all")
    with pytest.raises(InputError, match="shift must be a Shift"):
        gs.superpose(sweeps, reference_temperature=ROOM, shift=3.0)


def test_the_rubber_of_the_sweeps_at_any_temperature():
    sweeps = measured(TRANSITION, 0.01)
    rubber = gs.fit_prony(gs.superpose(sweeps, reference_temperature=ROOM))
    for one in sweeps:
        modulus = rubber.at(one.temperature).complex_modulus(2 * np.pi * one.frequency)
        assert np.median(np.abs(modulus.real / one.storage - 1.0)) < 0.05
        assert np.median(np.abs(modulus.imag / one.loss - 1.0)) < 0.05


def test_master_curve_file(tmp_path):
    master = gs.superpose(measured(TRANSITION, 0.01), reference_temperature=ROOM)
    back = gs.read_master_curve(write_master_curve(tmp_path / "m.csv", master))
    for name in ("frequency", "storage", "loss"):
        assert (getattr(back, name) == getattr(master, name)).all()


def test_measured_polymer_against_published_shift_factors():
    sweeps = gs.read_sweeps(POLYMER / "freq_user_raw.csv")
    published = read_shift_table(POLYMER / "published_shift_factors.csv")
    master, own = superpose_report(sweeps, reference_temperature=268.15)
    _, theirs = superpose_report(sweeps, reference_temperature=268.15, shift=published)
    warm = sweeps.temperatures[sweeps.temperatures > 273.0] - 0.05
    apart = master.shift.log_a(warm, 268.15) - published.log_a(warm, 268.15)
    # Found: -0.9 to +0.4; the published factors part E' by up to 0.033 decades, ours by 0.010.
    assert np.abs(apart).max() < 1.0
    worst = [max(one.storage for one in report.overlaps) for report in (own, theirs)]
    assert worst[0] < 0.5 * worst[1]
    assert any(f.startswith("E'' of 12 of 20 neighbours") for f in own.findings)


@pytest.mark.parametrize("seed", range(60))
def test_whatever_is_measured_is_superposed_or_refused(seed):
    """One to five sweeps of one to six rows, far apart, flat, scattered or at one frequency."""
    generator = np.random.default_rng(seed)
    rows = []
    for at in range(generator.integers(1, 6)):
        count = generator.integers(1 if at else 2, 7)
        hertz = np.sort(10.0 ** generator.uniform(-2.0, 3.0, count))
        if generator.random() < 0.3:
            hertz = np.ones(count)
        scatter = generator.choice([0.0, 0.01, 0.5]) * generator.standard_normal((2, count))
        kelvin = 250.0 + 5.0 * at
        decades = np.array([[6.0], [5.0]]) + 0.3 * np.log10(hertz) - 0.2 * at + scatter
        rows.append([np.full(count, kelvin), hertz, *10.0**decades])
    sweeps = Sweeps(*np.hstack(rows))
    for vertical in (False, True):
        at = float(sweeps.temperatures[0])
        try:
            master = gs.superpose(sweeps, reference_temperature=at, vertical=vertical)
        except InputError as error:
            assert "must overlap" in str(error)  # noqa: PT017
            continue
        assert np.isfinite([master.frequency, master.storage, master.loss]).all()
        assert np.isfinite(master.shift.horizontal_error).all()


@pytest.mark.parametrize("noise", [0.005, 0.01])
def test_a_vertical_shift_that_was_left_out_is_said_and_in_the_errors(noise):
    """b_T grows by 0.34 % a kelvin, as density and temperature make it; without it nothing is."""
    sweeps = measured(TRANSITION, noise, lift=0.0034)
    master, report = superpose_report(sweeps, reference_temperature=ROOM)
    assert "try vertical" in report.findings[0]
    table = master.shift
    error = np.abs(shift_errors(sweeps, table))
    assert error.max() > 0.1
    assert (error <= 2.0 * table.horizontal_error + 1e-9).all()
    lifted, report = superpose_report(sweeps, reference_temperature=ROOM, vertical=True)
    assert np.abs(shift_errors(sweeps, lifted.shift)).max() < 0.02
    assert not any("try vertical" in finding for finding in report.findings)
    for seed in range(4):
        _, report = superpose_report(measured(TRANSITION, noise, seed), reference_temperature=ROOM)
        assert not report.findings
