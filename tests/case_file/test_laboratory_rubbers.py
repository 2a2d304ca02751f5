"""Rubbers of a case as laboratories have them: several files, ramps, shifts in the file.

The moduli are those of a Maxwell solid whose times shift by WLF.
"""

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import RubberSource, prepare_rubber, validate
from gripscale.core.errors import FileError, InputError
from gripscale.rubber import WLF

SHIFT = {"kind": "wlf", "c1": 8.86, "c2": "101.6 K"}
SOLID = gs.Rubber(3e6, [2e6, 20e6, 200e6], [1e-1, 1e-3, 1e-5], reference_temperature=293.15,
                  shift=WLF(8.86, 101.6))  # fmt: skip


def modulus(kelvin, hertz):
    return complex(SOLID.at(kelvin).complex_modulus(2.0 * np.pi * hertz))


def prepared(**keys):
    return prepare_rubber(validate(RubberSource, keys, "rubber"))


def row(*numbers):
    return ",".join(f"{number:.7g}" for number in numbers)


def write(path, *text):
    path.write_text("\n".join(text) + "\n", encoding="utf-8")
    return str(path)


def ramp(folder):
    """Rows every 2 K at a frequency that wanders by a tenth of a per cent."""
    celsius = np.arange(-20.0, 61.0, 2.0)
    hertz = 10.0 + 0.01 * np.sin(np.arange(celsius.size))
    body = [
        row(t, f, (e := modulus(t + 273.15, f)).real / 1e6, e.imag / 1e6)
        for t, f in zip(celsius, hertz, strict=True)
    ]
    return write(folder / "ramp.csv", "Temperature [°C],Frequency [Hz],E' [MPa],E'' [MPa]", *body)


def test_a_ramp_at_one_frequency_is_a_master_curve_by_the_shift_that_is_stated(tmp_path):
    rubber = prepared(file=ramp(tmp_path), reference_temperature="20 C", shift=SHIFT)
    expected = SOLID.complex_modulus(rubber.master.angular_frequency)
    # printed with seven digits
    np.testing.assert_allclose(rubber.master.storage, expected.real, rtol=1e-6)
    np.testing.assert_allclose(rubber.master.loss, expected.imag, rtol=1e-6)
    assert rubber.rubber.at(313.15).relaxation_times[0] == pytest.approx(
        rubber.rubber.relaxation_times[0] * float(WLF(8.86, 101.6).a(313.15, 293.15))
    )
    assert any("temperature ramp at one frequency" in text for text in rubber.fit.findings)


def test_a_ramp_without_a_shift_is_refused_with_what_cures_it(tmp_path):
    words = r"shift must be given, such as shift = .*\(10 Hz, -20 to 60 °C\) makes no master curve"
    with pytest.raises(InputError, match=words):
        prepared(file=ramp(tmp_path), reference_temperature="20 C")


def test_one_file_a_temperature_which_stands_in_its_name(tmp_path):
    hertz = np.geomspace(0.1, 100.0, 13)
    files = []
    for celsius in (0, 10, 20, 30):
        body = [row(f, (e := modulus(celsius + 273.15, f)).real, e.imag) for f in hertz]
        name = f"sweep_{celsius}C.csv"
        files.append(write(tmp_path / name, "Frequency [Hz],E' [Pa],E'' [Pa]", *body))
    rubber = prepared(file=files, reference_temperature="20 C", shift=SHIFT)
    assert rubber.sweeps.temperatures == pytest.approx([273.15, 283.15, 293.15, 303.15])
    expected = SOLID.complex_modulus(rubber.master.angular_frequency)
    np.testing.assert_allclose(rubber.master.storage, expected.real, rtol=1e-6)
    found = prepared(file=files, reference_temperature="20 C").master
    # of a found shift by the roughness of interpolated sweeps
    decades = WLF(8.86, 101.6).log_a(303.15, 293.15)
    assert found.shift.log_a(303.15, 293.15) == pytest.approx(decades, abs=0.1)


def test_a_folder_is_refused_with_what_cures_it(tmp_path):
    with pytest.raises(FileError, match="got a folder: `gripscale new` writes the list"):
        prepared(file=str(tmp_path))


MASTER = [
    (2.0 * np.pi * hertz, modulus(293.15, hertz) / 3.0) for hertz in np.geomspace(1e-2, 1e6, 25)
]
"""Angular frequency and G* at 20 °C."""


@pytest.mark.parametrize("isofrictional", [True, False])
def test_constants_of_wlf_in_a_file_of_reptate(tmp_path, isofrictional):
    """B1 and B2 as the program writes them: c2 = B2 + Tr and c1 = B1/c2, 10 °C from T = 20."""
    head = f"B1=900;B2=80;CTg=15;Mw=30;Tr=20;T=20;chem=X;dx12=0;iso={isofrictional};vert=True;"
    body = [f"{w:.7g}\t{g.real:.7g}\t{g.imag:.7g}\t20\t" for w, g in MASTER]
    remark = "# Master curve predicted with WLF Theory"
    file = write(tmp_path / "x.tts", head, remark, "w\tG'\tG''\tT \t", *body)
    rubber = prepared(file=file)
    assert rubber.rubber.reference_temperature == pytest.approx(293.15)
    expected = SOLID.complex_modulus(rubber.master.angular_frequency)
    np.testing.assert_allclose(rubber.master.storage, expected.real, rtol=1e-6)
    moved = 15.0 / 30.0 if isofrictional else 0.0

    def log_a(celsius):
        """RepTate's formula, in degrees Celsius."""
        second, reference = 80.0 + moved, 20.0 - moved
        return -900.0 * (celsius - reference) / ((second + reference) * (second + celsius))

    for celsius in (0.0, 10.0, 60.0):
        shift = rubber.master.shift.log_a(celsius + 273.15, 293.15)
        assert shift == pytest.approx(log_a(celsius) - log_a(20.0), rel=1e-9)


def test_constants_of_an_older_reptate(tmp_path):
    """log10 a = -C1 (T - T0)/(C2 + T), of a polyisoprene at -35 °C; untitled columns."""
    head = (
        "C1=8.77210163229153;C2=114.03;Rho0=0.928;C3=0.61;T=-35;CTg=14.65;dx12=0;isof=true;Mw=33.6;"
    )
    body = [
        f" {w:.7E}      {g.real:.7E}      {g.imag:.7E}     -1.0E+01   0.0     " for w, g in MASTER
    ]
    rubber = prepared(file=write(tmp_path / "PI.tts", head, *body))
    moved = 14.65 / 33.6

    def log_a(celsius):
        return -8.77210163229153 * (celsius + 35.0 + moved) / (114.03 + moved + celsius)

    shift = rubber.master.shift.log_a(258.15, 238.15)
    assert shift == pytest.approx(log_a(-15.0) - log_a(-35.0), rel=1e-9)


def test_a_shift_of_the_case_goes_before_that_of_the_file(tmp_path):
    body = [f"{w:.7g} {g.real:.7g} {g.imag:.7g}" for w, g in MASTER]
    file = write(tmp_path / "x.tts", "T=20;B1=900;B2=80;Mw=30;", *body)
    shift = prepared(file=file, shift=SHIFT).rubber.shift
    assert isinstance(shift, WLF)
    assert (shift.c1, shift.c2) == (8.86, 101.6)
