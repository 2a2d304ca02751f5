"""Conditions, shifts and sweeps as a case file states them, and what is said of bad ones."""

import numpy as np
import pytest

from gripscale.case_file import (
    prepare_conditions,
    prepare_rubber,
    read_case,
    read_case_file,
)
from gripscale.conditions import Conditions, GaussianStress, ThermalProperties
from gripscale.core.errors import InputError
from gripscale.rubber import WLF
from gripscale.rubber.softening import Kraus
from tests.case_file.cases import refusal, written
from tests.samples import SOFTENING

BASE = """
[surface]
sines = [{ wavelength = "5 mm", amplitude = "0.2 mm" }, { wavelength = "1 mm", amplitude = "9 um" }]

[rubber]
name = "styrene_butadiene"
shift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }

[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"

[solver]
model = "half_plane"
"""
TEMPERATURE = '[conditions]\ntemperature = "40 C"\n'
HEAT = """[conditions.heat]
conductivity = "0.25 W/(m K)"
density = "1.15 g/cm^3"
specific_heat = "1500 J/(kg K)"
"""
AREA = """[conditions.shear_stress]
kind = "gaussian"
stress_0 = "5 MPa"
width = 0.1
speed_0 = "6 mm/s"
activation_energy = "0.97 eV"
reference_temperature = "20 C"
"""
ALL = BASE + TEMPERATURE + SOFTENING + HEAT + AREA


def stated(file):
    return prepare_conditions(file.case.conditions, file.resolve)


def test_every_effect_with_its_units(tmp_path):
    file = read_case_file(written(tmp_path, ALL))
    assert stated(file) == Conditions(
        temperature=313.15,
        softening=Kraus(0.3, 0.2, 0.02, 1e-3, "shear"),
        heat=ThermalProperties(0.25, 1150.0, 1500.0),
        shear_stress=GaussianStress(5e6, 0.1, 6e-3, 0.97, 293.15),
    )
    rubber = prepare_rubber(file.case.rubber).rubber
    assert rubber.shift == WLF(8.0, 120.0).bound(293.15)


def test_a_case_without_effects_has_no_conditions(tmp_path):
    assert stated(read_case_file(written(tmp_path, BASE))) is None


STRAIN = np.geomspace(1e-3, 0.3, 7)


def strain_sweep(folder, name, celsius, drop):
    rows = [
        f"{100 * s:.5g},"
        f"{10 / (1 + drop * s / 0.02):.6g},{2 / (1 + drop * s / 0.05):.6g},{celsius:g}"
        for s in STRAIN
    ]
    titles = "strain single amplitude (%),E' (MPa),E'' (MPa),temperature (C)"
    (folder / name).write_text("\n".join([titles, *rows]))


def test_strain_sweeps_at_two_temperatures(tmp_path):
    strain_sweep(tmp_path, "warm.csv", 60.0, 0.5)
    strain_sweep(tmp_path, "cold.csv", 20.0, 1.0)
    sweeps = (
        '[conditions.softening]\nkind = "table"\nfiles = ["warm.csv", "cold.csv"]\n'
        'measured_at = "0.2 %"\ndeformation = "tension"\n'
    )
    file = read_case_file(written(tmp_path, BASE + sweeps))
    assert file.case.named_files() == [("conditions", "warm.csv"), ("conditions", "cold.csv")]
    found = stated(file)
    measured_at, strain = 2e-3, STRAIN[4]
    for kelvin, drop in ((293.15, 1.0), (333.15, 0.5)):
        left = found.softening.factors(strain, kelvin)
        exact = (1 + drop * measured_at / 0.02) / (1 + drop * strain / 0.02)
        # interpolated between strains 2.6 times apart, at measured_at
        assert float(left.storage) == pytest.approx(exact, rel=1e-2)


def sweeps_file(folder):
    """Ten frequencies at each of five temperatures, shifted by WLF."""
    frequency, rows = (
        np.geomspace(0.1, 100.0, 10),
        ["temperature (C),frequency (Hz),E' (MPa),E'' (MPa)"],
    )
    for celsius in (0.0, 10.0, 20.0, 30.0, 40.0):
        above = celsius - 20.0
        shifted = 2 * np.pi * frequency * 10 ** (-8.0 * above / (120.0 + above))
        modulus = 1e6 + sum(
            3e6 * 1j * shifted * t / (1 + 1j * shifted * t) for t in np.geomspace(1e-6, 1e2, 9)
        )
        rows += [
            f"{celsius},{f:.8g},{m.real / 1e6:.8g},{m.imag / 1e6:.8g}"
            for f, m in zip(frequency, modulus, strict=True)
        ]
    (folder / "sweeps.csv").write_text("\n".join(rows))


NAMED = 'name = "styrene_butadiene"\nshift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }'


def test_sweeps_at_several_temperatures_make_the_rubber(tmp_path):
    sweeps_file(tmp_path)
    text = BASE.replace(NAMED, 'file = "sweeps.csv"\nreference_temperature = "20 C"')
    results = read_case(written(tmp_path, text + TEMPERATURE))
    rubber = results.rubber
    assert float(rubber.shift.log_a(313.15, 293.15)) == pytest.approx(-8 * 20 / 140, abs=0.02)
    assert results.measured_rubber.superposition is not None
    assert results.rubber_before.reference_temperature == pytest.approx(313.15)


WRONG = [
    ('temperature = "40 C"', "temperature = 313.15",
     "[conditions] temperature = 313.15: the unit is"),
    ('"1.15 g/cm^3"', '"1150 kg"',
     "[conditions] heat: density = '1150 kg': unknown unit 'kg'; expected"),
    ('"6 mm/s"', '"0 mm/s"',
     "shear_stress: speed_0 = '0 mm/s': expected a value greater than zero"),
    ('c2 = "120 K"', 'c2 = "120 kg"', "[rubber] shift: c2 = '120 kg': unknown unit"),
    ('measured_at = "0.1 %"\n', "", "[conditions] softening: measured_at is missing"),
    ('kind = "kraus"\n', "",
     "[conditions] softening: kind is missing; expected one of kraus, table"),
    ('reference_temperature = "20 C"', "",
     "reference_temperature must be given with an activation_energy"),
    ('kind = "kraus"', 'kind = "kraus"\nfiles = ["a.csv"]',
     "[conditions] softening: unknown key files"),
    (NAMED, NAMED + "\nvertical = true", "vertical belongs to a measured file"),
    (NAMED, 'file = "a.csv"\nvertical = true\nshift = "b.csv"', "either shift (given) or vertical"),
    ("storage_ratio", "storage_ration",
     "softening: unknown key storage_ration; did you mean storage_ratio"),
    ('kind = "gaussian"', 'kind = "gauss"',
     "shear_stress: kind = 'gauss': expected one of constant,"),
    (SOFTENING, '[conditions.softening]\nkind = "table"\nfiles = ["a.csv"]\nmeasured_at = "0.2 %"\n'
     'modulus_unit = "Mpa"\n',
     "[conditions] softening: modulus_unit = 'Mpa': expected one of Pa, kPa,"),
    ("storage_ratio = 0.3", "storage_ratio = 1.3",
     "softening: storage_ratio = 1.3: expected a number, above 0, at most 1"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), WRONG)
def test_wrong_half_or_twice_is_one_sentence(tmp_path, old, new, words):
    assert words in refusal(read_case_file, tmp_path, ALL, old, new)


UNUSABLE = [
    ('\nshift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }', "",
     "heat needs a rubber with reference_temperature and shift"),
    ('temperature = "40 C"', 'temperature = "-150 C"', "[conditions] temperature"),
    ('kind = "wlf", c1 = 8.0, c2 = "120 K"',
     'kind = "arrhenius", activation_energy = "80 kJ/mol", valid_range = ["60 C", "20 C"]',
     "valid_range"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), UNUSABLE)
def test_conditions_the_rubber_cannot_follow_are_refused_before_solving(tmp_path, old, new, words):
    assert words in refusal(read_case, tmp_path, ALL, old, new)


def test_a_key_of_sweeps_is_refused_with_a_master_curve(tmp_path):
    rows = [f"{10.0**i} {2 + i} {1 + 0.1 * i}" for i in range(6)]
    (tmp_path / "dma.txt").write_text("\n".join(["f (Hz)  E' (MPa)  E'' (MPa)", *rows]))
    text = BASE.replace(NAMED, 'file = "dma.txt"\nvertical = true')
    with pytest.raises(InputError, match="vertical is for sweeps at several temperatures"):
        read_case(written(tmp_path, text))
    text = BASE.replace(NAMED, 'file = "dma.txt"\nshift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }')
    with pytest.raises(InputError, match="reference_temperature must be given with shift"):
        read_case(written(tmp_path, text))


def test_sweeps_ask_for_the_temperature_they_are_shifted_to(tmp_path):
    sweeps_file(tmp_path)
    text = BASE.replace(NAMED, 'file = "sweeps.csv"')
    with pytest.raises(InputError, match='reference_temperature must be given, such as "20 C"'):
        read_case(written(tmp_path, text))
