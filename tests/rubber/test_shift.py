"""Shift factors: closed forms, chains of temperatures, tables by hand, formulas fitted."""

import json
import math

import numpy as np
import pytest

from gripscale.core.errors import FileError, InputError
from gripscale.rubber import (
    SHIFTS,
    WLF,
    Arrhenius,
    MasterCurve,
    Rubber,
    ShiftTable,
    WLFArrhenius,
    fit_arrhenius,
    fit_prony,
    fit_wlf,
    read_shift_table,
    shift_from_dict,
    temperature_doubts,
    write_shift_table,
)

ROOM = 293.15
TABLE = ShiftTable(
    [253.15, 273.15, ROOM, 313.15],
    [4.0, 1.7, 0.0, -1.3],
    [0.2, 0.1, 0.0, math.nan],
    [-0.02, -0.01, 0.0, 0.01],
    [0.002, 0.001, 0.0, 0.001],
    reference_temperature=ROOM,
)
LAWS = [
    WLF(8.86, 101.6, ROOM),
    Arrhenius(1.2e5),
    WLFArrhenius(8.86, 101.6, 2e5, 263.15, ROOM, valid_range=(240.0, 330.0)),
    TABLE,
]


def test_closed_forms():
    assert WLF(8.86, 101.6).log_a(ROOM + 50.0, ROOM) == pytest.approx(-8.86 * 50.0 / 151.6)
    assert WLF(8.86, 101.6).log_a(ROOM - 20.0, ROOM) > 0.0
    energy = 8.314462618 * math.log(10.0) / (1 / 273.15 - 1 / ROOM)
    assert Arrhenius(energy).log_a(273.15, ROOM) == pytest.approx(1.0)


def test_glass_takes_over_continuously():
    law, wlf = LAWS[2], LAWS[0]
    assert law.log_a(300.0, ROOM) == pytest.approx(wlf.log_a(300.0, ROOM))
    assert law.log_a(263.15 - 1e-6, ROOM) == pytest.approx(law.log_a(263.15 + 1e-6, ROOM), abs=1e-5)
    step = Arrhenius(2e5).log_a(250.0, 255.0)
    assert law.log_a(250.0, 255.0) == pytest.approx(step)
    assert step < wlf.log_a(250.0, 255.0)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
def test_shifts_one_after_the_other_are_one(law):
    one, two, three = 260.0, 281.0, 310.0
    assert law.log_a(one, one) == 0.0
    assert law.log_a(one, three) == pytest.approx(law.log_a(one, two) + law.log_a(two, three))
    assert law.log_b(one, three) == pytest.approx(law.log_b(one, two) + law.log_b(two, three))
    assert law.a([one, two], three) == pytest.approx(10.0 ** law.log_a([one, two], three))


@pytest.mark.parametrize("law", [*LAWS, WLF(5.0, 60.0)], ids=repr)
def test_round_trip_by_kind(law):
    values = json.loads(json.dumps(law.to_dict()))
    assert SHIFTS[values["kind"]] is type(law)
    back = shift_from_dict(values)
    assert back == law
    assert hash(back) == hash(law)


def test_other_reference_of_wlf():
    other = LAWS[0].referred_to(253.15)
    assert other.reference_temperature == 253.15
    kelvin = np.array([230.0, 273.15, 340.0])
    assert other.log_a(kelvin, 300.0) == pytest.approx(LAWS[0].log_a(kelvin, 300.0), abs=1e-12)


def test_table_is_met_at_its_rows_and_refuses_beyond():
    assert TABLE.log_a(TABLE.temperature, ROOM) == pytest.approx(TABLE.horizontal)
    assert TABLE.b(TABLE.temperature, ROOM) == pytest.approx(10.0**TABLE.vertical)
    between = TABLE.log_a(np.linspace(253.15, 313.15, 50), ROOM)
    assert (np.diff(between) < 0.0).all()
    assert TABLE.range == (253.15, 313.15)
    with pytest.raises(InputError, match=r"within -20 to 40 °C.*got -23.15 °C \(250 K\)"):
        TABLE.log_a(250.0, ROOM)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: WLF(-1.0, 50.0), "c1 must be greater than zero"),
        (lambda: WLF(8.0, 50.0, valid_range=(300.0, 200.0)), "a lower and a higher value"),
        (lambda: WLF(8.0, 50.0).log_a(240.0, ROOM), r"within -29\.95 to 9727 °C"),
        (lambda: WLF(8.0, 50.0).a(243.5, ROOM), "log10 a_T of the shift .* at most 100; got 1.1"),
        (lambda: WLFArrhenius(8.0, 50.0, 1e5, 200.0, ROOM), "glass_temperature must lie above"),
        (lambda: ShiftTable([300.0, 300.0], [0.0, 1.0]), "temperature .* must not repeat"),
        (lambda: ShiftTable([300.0], [0.0, 1.0]), "same length"),
        (lambda: ShiftTable([300.0], [0.0], [-1.0]), "horizontal_error must not be negative"),
        (
            lambda: shift_from_dict({"kind": "wlf", "c1": 1.0}),
            "wlf takes c1, c2, .* of which c1, c2 must be given; got c1",
        ),
        (lambda: shift_from_dict({"kind": "power"}), "kind must be one of wlf, arrhenius"),
        (lambda: shift_from_dict({"kind": "wlf", "c3": 1.0}), "wlf takes c1, c2, .* got c3"),
        (lambda: Rubber(1e6, shift=WLF(8.0, 50.0)), "reference_temperature"),
        (lambda: MasterCurve([1, 2], [1, 2], [1, 2], shift=8.0), "shift must be a Shift"),
        (lambda: Rubber(2e6).at(300.0), r"known at one temperature, not at 26\.85 C"),
        (lambda: rubber().at(300.0), "time-temperature shift is missing"),
        # ten decades in 10 K, or a_T itself
        *(
            (
                lambda rows=rows: ShiftTable([283.15, 293.15, 303.15], rows),
                "horizontal must be log10 a_T",
            )
            for rows in ([10.0, 0.0, -1.0], [30.0, 1.0, 0.05])
        ),
    ],
)
def test_bad_values(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_csv_round_trip(tmp_path):
    path = write_shift_table(tmp_path / "shift.csv", TABLE)
    back = read_shift_table(path)
    assert back.reference_temperature == pytest.approx(ROOM, abs=1e-9)
    for name in ("temperature", "horizontal", "horizontal_error", "vertical", "vertical_error"):
        assert getattr(back, name) == pytest.approx(getattr(TABLE, name), abs=1e-12, nan_ok=True)


def test_csv_edited_by_hand(tmp_path):
    path = write_shift_table(tmp_path / "shift.csv", TABLE)
    text = path.read_text(encoding="utf-8")
    assert "\n0.0,1.7," in text
    path.write_text(text.replace("\n0.0,1.7,", "\n0.0,1.9,"), encoding="utf-8")
    assert read_shift_table(path).log_a(273.15, ROOM) == pytest.approx(1.9)
    for rows in ("log_aT\n°C;-\n20;0\n-20;4,5", "aT\n°C;-\n20;1\n-20;31622,8"):
        path.write_text(f"T;{rows}\n", encoding="utf-8")
        assert read_shift_table(path).log_a(253.15, ROOM) == pytest.approx(4.5)
    path.write_text("T,log_aT\n20,0\n", encoding="utf-8")
    with pytest.raises(InputError, match="temperature_unit must be given"):
        read_shift_table(path)
    path.write_text("T (C),shift\n20,0\n", encoding="utf-8")
    with pytest.raises(FileError, match="expected columns of temperature and a_T or log10 a_T"):
        read_shift_table(path)


def scattered(law, kelvin, error, seed):
    noise = error * np.random.default_rng(seed).standard_normal(len(kelvin))
    log_a = law.log_a(kelvin, ROOM) + np.where(kelvin == ROOM, 0.0, noise)
    return ShiftTable(kelvin, log_a, np.full(len(kelvin), error), reference_temperature=ROOM)


def test_wlf_is_found_within_its_errors():
    kelvin = ROOM + np.arange(-40.0, 61.0, 10.0)
    found = [fit_wlf(scattered(LAWS[0], kelvin, 0.05, seed)) for seed in range(40)]
    for name, true in (("c1", 8.86), ("c2", 101.6)):
        off = [(getattr(fit.shift, name) - true) / fit.errors[name] for fit in found]
        assert abs(np.mean(off)) < 0.5
        assert 0.7 < np.std(off) < 1.4  # 40 draws: one, within 0.2 or so
    assert np.median([fit.misfit for fit in found]) == pytest.approx(0.045, abs=0.01)
    assert found[0].shift.valid_range == pytest.approx((ROOM - 40.0, ROOM + 60.0))


def test_arrhenius_of_the_glass_alone():
    kelvin = np.array([223.15, 233.15, 243.15, 253.15, 273.15, ROOM])
    law = WLFArrhenius(8.86, 101.6, 2e5, 255.0, ROOM)
    table = ShiftTable(kelvin, law.log_a(kelvin, ROOM), reference_temperature=ROOM)
    fit = fit_arrhenius(table, highest=254.0)
    assert fit.shift.activation_energy == pytest.approx(2e5, rel=1e-9)
    assert fit.misfit < 1e-12
    with pytest.raises(InputError, match="at least 3 rows"):
        fit_wlf(table, lowest=273.0)
    rising = ShiftTable(kelvin, -table.horizontal, reference_temperature=ROOM)
    with pytest.raises(InputError, match="fall with temperature"):
        fit_arrhenius(rising)


def rubber(**more):
    omega = np.geomspace(1e-2, 1e6, 60)
    modulus = Rubber(2e6, [3e6, 8e6], [1e-1, 1e-4]).complex_modulus(omega)
    curve = MasterCurve(
        omega / 2 / np.pi, modulus.real, modulus.imag, reference_temperature=ROOM, **more
    )
    return fit_prony(curve, terms=8)


def test_rubber_at_another_temperature():
    cold, here = 273.15, rubber(shift=TABLE)
    there = here.at(cold)
    a, b = float(TABLE.a(cold, ROOM)), float(TABLE.b(cold, ROOM))
    assert a > 1.0
    omega = np.geomspace(1e-6, 1e8, 40)
    assert there.complex_modulus(omega) == pytest.approx(here.complex_modulus(a * omega) / b)
    assert there.equilibrium_modulus == pytest.approx(here.equilibrium_modulus / b)
    assert there.bulk_modulus == here.bulk_modulus
    assert np.array(there.valid_band) == pytest.approx(np.array(here.valid_band) / a)
    assert there.reference_temperature == cold
    low, high = there.complex_modulus_band(omega)
    own_low, own_high = here.complex_modulus_band(a * omega)
    assert low == pytest.approx(own_low / b)
    assert high == pytest.approx(own_high / b)


@pytest.mark.parametrize("law", [WLF(8.86, 101.6), *LAWS[1:]], ids=lambda law: law.kind)
def test_at_goes_on_from_any_temperature(law):
    here = Rubber(2e6, [3e6, 8e6], [1e-1, 1e-4], reference_temperature=ROOM, shift=law)
    there, around = here.at(260.0), here.at(305.0).at(281.0).at(260.0)
    assert around.relaxation_times == pytest.approx(there.relaxation_times)
    assert around.moduli == pytest.approx(there.moduli)
    back = around.at(ROOM)
    assert back.relaxation_times == pytest.approx(here.relaxation_times)
    assert Rubber.from_dict(json.loads(json.dumps(there.to_dict()))) == there


def test_temperature_and_shift_come_from_the_master_curve():
    one = rubber(shift=WLF(8.86, 101.6))
    assert one.reference_temperature == ROOM
    assert one.shift == WLF(8.86, 101.6, ROOM)
    assert all(other.shift == one.shift for other in one.admissible_rubbers())
    older = {k: v for k, v in one.to_dict().items() if k not in ("shift", "reference_temperature")}
    assert Rubber.from_dict(older).shift is None


def test_beyond_the_range_of_the_shift_is_said():
    law = WLF(8.86, 101.6, valid_range=(263.15, 323.15))
    here = Rubber(2e6, [3e6], [1e-1], name="tread", reference_temperature=ROOM, shift=law)
    assert not here.at(270.0).shift_extrapolated
    far = here.at(350.0)
    assert far.shift_extrapolated
    assert not far.at(ROOM).shift_extrapolated
    said = temperature_doubts({"cold": here, "hot": far, "unknown": Rubber(2e6)})
    assert len(said) == 3
    assert "cold 20.0 °C, hot 76.9 °C" in said[0]
    assert "unknown" in said[1]
    assert said[2].endswith("hot")
    assert temperature_doubts({"a": here, "b": here, "c": here}) == ()


def test_a_temperature_beyond_the_sweeps_is_refused_in_celsius_with_its_cure():
    swept = ShiftTable([243.15, 293.15, 313.15], [5.0, 0.0, -1.5])
    with pytest.raises(InputError) as caught:
        swept.a(333.15, 293.15)
    assert str(caught.value) == (
        "temperature must lie within -30 to 40 °C, where the sweeps of the shift lie; got 60 °C "
        '(333.15 K): measure sweeps up to there, or state shift = { kind = "wlf", ... } in [rubber]'
    )
    with pytest.raises(InputError, match=r"where the shift \(wlf\) has values; got -150 °C") as far:
        WLF(8.86, 101.6).a(123.15, 293.15)
    assert "sweeps" not in str(far.value)


def test_a_steep_table_is_one_near_its_glass_transition():
    steep = ShiftTable([283.15, 293.15, 303.15], [6.0, 0.0, -2.0])
    assert steep.a(283.15, 293.15) == pytest.approx(1e6)
