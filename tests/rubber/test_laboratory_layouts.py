"""Moduli in files as laboratories have them: read right at first try, or refused by name."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, GripscaleError, InputError
from gripscale.rubber.prony import holds_prony_table, read_prony_table

HERTZ = np.geomspace(0.1, 100.0, 16)
STORAGE, LOSS = 5e6 * HERTZ**0.1, 8e5 * HERTZ**0.12
PSI = 6894.757293168


def rows(*columns, separator=",", before=""):
    lines = zip(*columns, strict=True)
    return "\n".join(before + separator.join(f"{value:.8g}" for value in line) for line in lines)


def two(size, frequency=HERTZ):
    return rows(frequency, STORAGE / size, LOSS / size)


OMEGA = 2.0 * np.pi * HERTZ
SQUARE = STORAGE**2 + LOSS**2
WORDS = rows(HERTZ, STORAGE, LOSS, separator=";", before="sweep;")
PLAIN = {
    "Frequency (Hz),E' (bar),E'' (bar)": 1e5,
    "Frequency (Hz),E' (kgf/cm2),E'' (kgf/cm2)": 98066.5,
    "f (Hz),E' (kgf/mm2),E'' (kgf/mm2)": 9806650.0,
    "Frequency (Hz),E' (ksi),E'' (ksi)": 1e3 * PSI,
    "f (Hz),E' (atm),E'' (atm)": 101325.0,
    "f (Hz),E' (N/cm2),E'' (N/cm2)": 1e4,
    "Frequency (Hz),E' (N/mm2),E'' (N/mm2)": 1e6,
    "Frequency (Hz),E' (kN/m²),E'' (kN/m2)": 1e3,
    "Frequency (1/s),E' (MPa),E'' (MPa)": 1e6,
    "FREQUENCY (HZ),E' (MPA),E'' (MPA)": 1e6,
    "f [Hz],Re(E) [MPa],Im(E) [MPa]": 1e6,
    "Frequentie (Hz),Opslagmodulus E (MPa),Verliesmodulus E (MPa)": 1e6,
    "Freq (Hz),E prime (MPa),E double prime (MPa)": 1e6,
}
"""Titles, and the size of the unit of their moduli [Pa]."""
CURVES = {
    **{titles: (f"{titles}\n{two(size)}", {}) for titles, size in PLAIN.items()},
    "angular in 1/s": ("Angular Frequency (1/s),E' (MPa),E'' (MPa)\n" + two(1e6, OMEGA), {}),
    "rotations": ("Frequency (rpm),E' (MPa),E'' (MPa)\n" + two(1e6, 60.0 * HERTZ), {}),
    "angular without a unit": ("Angular Frequency,E' (MPa),E'' (MPa)\n" + two(1e6, OMEGA), {}),
    "French": (
        "Fréquence (Hz),Module de conservation (MPa),Module de perte (MPa)\n" + two(1e6),
        {"modulus": "E"},
    ),
    "Chinese": ("频率/Hz,储能模量/MPa,损耗模量/MPa\n" + two(1e6), {"modulus": "E"}),
    "components": (
        "Step;Time (s);Frequency(Hz);Shear modulus (elastic component)(Pa);"
        "Shear modulus (viscous component)(Pa)\n"
        + rows(HERTZ, STORAGE / 3, LOSS / 3, separator=";", before="sweep;1;"),
        {},
    ),
    "force F beside frequency f": (
        "f\tF\tE'\tE''\n[Hz]\t[N]\t[MPa]\t[MPa]\n"
        + rows(HERTZ, 0.0 * HERTZ + 1.5, STORAGE / 1e6, LOSS / 1e6, separator="\t"),
        {},
    ),
    "columns counted with words": (
        "what;x1;x2;x3\n" + WORDS,
        {"columns": (2, 3, 4), "modulus": "E", "modulus_unit": "Pa", "frequency_unit": "Hz"},
    ),
    "tensile compliance": (
        "f (Hz),D' (1/MPa),D'' (1/MPa)\n"
        + rows(HERTZ, 1e6 * STORAGE / SQUARE, 1e6 * LOSS / SQUARE),
        {},
    ),
    "shear compliance": (
        "f (Hz),J' (1/Pa),J'' (1/Pa)\n" + rows(HERTZ, 3 * STORAGE / SQUARE, 3 * LOSS / SQUARE),
        {},
    ),
    "cycles a minute": ("Frequency (cycles/min),E' (MN/m2),E'' (㎫)\n" + two(1e6, 60 * HERTZ), {}),
    "dynes": ("f (rad/sec),E' (dynes/cm2),E'' (dynes/cm2)\n" + two(0.1, OMEGA), {}),
    "phase": (
        "f (Hz),|E*| (Pa),phase (°)\n"
        + rows(HERTZ, np.sqrt(SQUARE), np.degrees(np.arctan(LOSS / STORAGE))),
        {},
    ),
    "Modulus E'": ("Frequency;Modulus E';Modulus E''\nHz;Pa;Pa\n" + two(1).replace(",", ";"), {}),
    "Mettler": ("f\tM'\tM''\n[Hz]\t[MPa]\t[MPa]\n" + two(1e6).replace(",", "\t"), {"modulus": "E"}),
    "Portuguese": (
        "Frequência (Hz);Módulo de armazenamento E (MPa);Módulo de perda E (MPa)\n"
        + two(1e6).replace(",", ";").replace(".", ","),
        {},
    ),
    "Polish": (
        "Częstotliwość (Hz),Moduł zachowawczy E (MPa),Moduł stratności E (MPa)\n" + two(1e6),
        {"modulus": "E"},
    ),
    "Russian": (
        "Частота (Hz),Модуль накопления E (MPa),Модуль потерь E (MPa)\n" + two(1e6),
        {"modulus": "E"},
    ),
    "other primes": ("f / Hz;E′ / MPa;E″ / MPa\n" + two(1e6).replace(",", ";"), {}),
    "primes as letters": ("Freq (Hz),Ep (MPa),Epp (MPa)\n" + two(1e6), {"modulus": "E"}),
    "units behind numbers": (
        "f,E',E''\n"
        + "\n".join(
            f"{f:.8g} Hz,{e / 1e6:.8g} MPa,{loss / 1e6:.8g} MPa"
            for f, e, loss in zip(HERTZ, STORAGE, LOSS, strict=True)
        ),
        {},
    ),
    "a mark and a footer": (
        "\ufefff (Hz)\tE' (MPa)\tE'' (MPa)\n" + two(1e6).replace(",", "\t") + "\n\nEnd of test\n",
        {},
    ),
    "Universal Analysis": (
        "OrgMethod\tsweep\nSig1\tTime (min)\nSig2\tFrequency (Hz)\nSig3\tStorage Modulus (MPa)\n"
        "Sig4\tLoss Modulus (MPa)\nStartOfData\n"
        + rows(HERTZ, HERTZ, STORAGE / 1e6, LOSS / 1e6, separator="\t"),
        {"modulus": "E"},
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", CURVES)
def test_a_master_curve_is_read_at_first_try(written, kind):
    text, options = CURVES[kind]
    path = written(text, encoding="gb18030" if kind == "Chinese" else "utf-8")
    master = gs.read_master_curve(path, **options)
    np.testing.assert_allclose(master.frequency, HERTZ, rtol=1e-6)
    np.testing.assert_allclose(master.storage, STORAGE, rtol=1e-6)
    np.testing.assert_allclose(master.loss, LOSS, rtol=1e-6)
    assert master.notes == ()


REFUSED = {
    "furlongs": ("Frequency (Hz),E' (furlong),E'' (furlong)\n" + two(1e6),
                 r"modulus_unit .* the unknown unit 'furlong'"),
    "a temperature in an unknown unit": (
        "f (Hz),E' (Pa),E'' (Pa),T (°R)\n" + rows(HERTZ, STORAGE, LOSS, 528 + 0 * HERTZ),
        r"temperature_unit .* the unknown unit '°R'"),
    "creep": ("Time (s),Creep compliance (1/Pa)\n" + rows(HERTZ, 1 / STORAGE),
              "creep is not read"),
    "relaxation": ("t [s],E(t) [MPa]\n" + rows(HERTZ, STORAGE / 1e6), "a relaxation modulus"),
    "a loss factor alone": ("Frequency (Hz),tan delta\n" + rows(HERTZ, LOSS / STORAGE),
                            "the loss factor alone"),
    **{title: (f"f (Hz),{title},{title.replace(chr(39), 2 * chr(39))}\n" + two(1e6),
               r"modulus_unit must be given .* the unknown unit")
       for title in ("E' x10^6 (Pa)", "E' (10^6 Pa)", "E'/10^6 Pa", "E' ×1e6 (Pa)")},
}  # fmt: skip
"""Units and quantities that are not known; a factor of a title is never left out."""


@pytest.mark.parametrize("kind", REFUSED)
def test_what_is_not_known_is_never_guessed(written, kind):
    text, words = REFUSED[kind]
    path = written(text)
    with pytest.raises(GripscaleError, match=words) as refused:
        gs.read_master_curve(path)
    assert kind != "furlongs" or refused.value.missing == ""
    if "10^6" in kind:
        found = gs.read_master_curve(path, modulus_unit="MPa").storage
        np.testing.assert_allclose(found, STORAGE, rtol=1e-6)


@pytest.mark.parametrize(
    ("line", "kelvin"),
    [
        ("# Master curve, Tref = 25 °C", 298.15),
        ("Reference temperature;25;°C", 298.15),
        ("T0 = 298 K", 298.0),
        ("Glass transition temperature: -50 °C", None),
        ("t0 = 3", None),
    ],
)
def test_the_reference_that_a_line_states(written, line, kelvin):
    path = written(f"{line}\nf (Hz),E' (Pa),E'' (Pa)\n" + two(1.0))
    reference = gs.read_master_curve(path).reference_temperature
    assert reference == (kelvin and pytest.approx(kelvin))


def test_a_line_about_the_room_is_not_that_of_a_column(written):
    both = [rows(0.0 * HERTZ + celsius, HERTZ, STORAGE, LOSS) for celsius in (0.0, 40.0)]
    for line in ("Laboratory, temperature: 23 °C", "Reference temperature: 20 °C"):
        titles = f"{line}\nT (°C),f (Hz),E' (Pa),E'' (Pa)\n"
        found = gs.read_sweeps(written(titles + "\n".join(both)))
        np.testing.assert_allclose(found.temperatures, [273.15, 313.15])


def test_german_letters_are_no_chinese(written):
    text = "Prüfkörper für Öl, Maß °C\nFrequenz [Hz],Speichermodul [MPa],Verlustmodul [MPa]\n"
    path = written(text + two(1e6), encoding="cp1252")
    assert len(gs.read_master_curve(path, modulus="E")) == len(HERTZ)


@pytest.mark.parametrize(("column", "value"), [(0, 0.0), (2, 0.0), (2, -2e5)])
def test_one_bad_row_is_left_out_and_said(written, column, value):
    data, titles = np.c_[HERTZ, STORAGE, LOSS], "f (Hz),E' (Pa),E'' (Pa)\n"
    data[3, column] = value
    master = gs.read_master_curve(written(titles + rows(*data.T)))
    assert len(master) == len(HERTZ) - 1
    assert master.notes == ("1 of 16 rows left out, a value is zero or less (line 5)",)
    data[:, column] = value  # all rows: no fault of a row
    with pytest.raises(FileError, match="above zero"):
        gs.read_master_curve(written(titles + rows(*data.T)))


def test_a_frequency_in_the_title(written):
    celsius = np.arange(-30.0, 61.0, 5.0)
    moduli = 1e2 * np.exp(-celsius / 40.0)
    body = rows(celsius, moduli, 0.1 * moduli, 1.3 * moduli, 0.2 * moduli, separator=";")
    title = "##Temp./°C;E'(1,000Hz)/MPa;E''(1,000Hz)/MPa;E'(10,000Hz)/MPa;E''(10,000Hz)/MPa\n"
    sweeps = gs.read_sweeps(written(title + body.replace(".", ","), encoding="cp1252"))
    assert np.unique(sweeps.frequency).tolist() == [1.0, 10.0]
    np.testing.assert_allclose(sweeps.storage[sweeps.frequency == 10.0], 1.3e6 * moduli, rtol=1e-6)


def test_times_and_temperatures_are_told_apart_by_their_units(written):
    tables = "".join(
        f"Intervalle:\t{celsius}\nDonnées:\tTemps\tPulsation\tModule de Stockage\tModule de Perte\t"
        "Température\n\t[s]\t[rad/s]\t[Pa]\t[Pa]\t[°C]\n"
        + rows(HERTZ, OMEGA, STORAGE, LOSS, celsius + 0.0 * HERTZ, separator="\t", before="\t")
        + "\n"
        for celsius in (10, 20)
    )  # fmt: skip
    sweeps = gs.read_sweeps(written(tables, encoding="utf-16"), modulus="E", tolerance=0.5)
    np.testing.assert_allclose(sweeps.temperatures, [283.15, 293.15])


@pytest.mark.parametrize(("unit", "kelvin"), [("K", 298.0), ("C", 571.15), (None, None)])
def test_a_temperature_too_hot_for_its_unit(written, unit, kelvin):
    table = rows(OMEGA, STORAGE / 3, LOSS / 3, separator=" ")
    path = written(f"T=298;Mw=1;\n{table}", "sweep.tts")
    if kelvin is None:
        with pytest.raises(InputError, match="too hot for a rubber") as refused:
            gs.read_sweeps(path)
        assert refused.value.missing == "temperature_unit"
    else:
        sweeps = gs.read_sweeps(path, temperature_unit=unit)
        assert sweeps.temperatures == pytest.approx([kelvin])


def test_a_column_of_one_temperature_is_that_of_the_curve(written):
    table = rows(HERTZ, STORAGE, LOSS, 20.9 + 0.0 * HERTZ)
    path = written("f (Hz),E' (Pa),E'' (Pa),T (°C)\n" + table)
    assert gs.read_master_curve(path).reference_temperature == pytest.approx(294.05)


@pytest.mark.parametrize(("title", "size"), [("E_i (MPa)", 1.0), ("G_i (MPa)", 3.0)])
def test_a_prony_series_in_a_table(written, title, size):
    path = written(f"tau (s),{title}\n0.001,5\n1,3\n100,1.5\ninf,2\n")
    assert holds_prony_table(path)
    assert read_prony_table(path) == {
        "equilibrium_modulus": 2e6 * size,
        "moduli": [5e6 * size, 3e6 * size, 1.5e6 * size],
        "relaxation_times": [0.001, 1.0, 100.0],
    }
    with pytest.raises(FileError, match="one row with inf as relaxation time"):
        read_prony_table(written(f"tau (s),{title}\n0.001,5\n1,3\n"))
