"""Files of power spectra: columns, units and the conventions of their densities."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core import InputError

Q = np.geomspace(1e3, 1e6, 40)
C = 1e-10 * (Q / 1e3) ** -3.6
TWO_PI = 2.0 * np.pi


def written(path, titles, *columns):
    sep = next((sep for sep in (";", "\t", ",") if sep in titles), " ")
    rows = (sep.join(map(repr, row)) for row in zip(*(c.tolist() for c in columns), strict=True))
    path.write_text("\n".join([titles, *rows, ""]), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("titles", "wavenumber", "density"),
    [
        ("q (1/m),C (m^4)", Q, C),
        ("wavenumber q [1/m],areal spectrum C(q) [m^4]", Q, C),
        ("q [um^-1]\tC(q) [um^4]", 1e-6 * Q, 1e24 * C),
        ("q [µm⁻¹];C [µm⁴]", 1e-6 * Q, 1e24 * C),
        ("q / mm^-1;C / nm^2·mm^2", 1e-3 * Q, 1e24 * C),
        ("q [1/m],C(q) [nm^4]", Q, 1e36 * C),
        ("q [rad/m],C [m**4]", Q, C),
        ("log10(q / (1/m)),log10(C / m^4)", np.log10(Q), np.log10(C)),
        ("log10 q [1/um],lg C(q) [um^4]", np.log10(1e-6 * Q), np.log10(1e24 * C)),
        ("ln(q) [1/m],ln(C(q)) [nm^2 um^2]", np.log(Q), np.log(1e30 * C)),
        ("wavelength [mm],C [m4]", 1e3 * TWO_PI / Q, C),
        ("1/wavelength [1/mm],C(q) [mm^4]", 1e-3 * Q / TWO_PI, 1e12 * C),
        ("spatial frequency [cycles/m],C(q) [m^4]", Q / TWO_PI, C),
        ("Wavevector (µm⁻¹);q/π × 2D PSD (µm³)", 1e-6 * Q, 1e18 * 4.0 * np.pi * Q * C),
        ("Wavevector [1/m],C_iso [m^4]", Q, 4.0 * np.pi**2 * C),
    ],
)
def test_units_and_conventions(tmp_path, titles, wavenumber, density):
    found = gs.read_spectrum(written(tmp_path / "psd.csv", titles, wavenumber, density))
    np.testing.assert_allclose(found.wavenumber, Q, rtol=1e-9)
    np.testing.assert_allclose(found.density, C, rtol=1e-9)
    assert found.name == "psd"
    assert found.source.endswith("psd.csv")


@pytest.mark.parametrize(
    ("titles", "factor"),
    [
        ("q [1/m],C_1 [m^3]", 1.0),
        ("Wavevector [1/m],1D PSD along x [m^3]", np.pi),
        ("q [1/m],C_1(q) [mm^3]", 1e9),
    ],
)
def test_spectrum_of_lines_becomes_that_of_their_surface(tmp_path, titles, factor):
    true = gs.Spectrum(Q, C)
    file = written(tmp_path / "line.csv", titles, Q, factor * true.of_lines(Q))
    found = gs.read_spectrum(file)
    assert found.rms_gradient() == pytest.approx(true.rms_gradient(), rel=0.02)
    middle = slice(5, -5)
    np.testing.assert_allclose(found.density[middle], true.at(found.wavenumber[middle]), rtol=0.1)


@pytest.mark.parametrize(
    ("options", "divisor"),
    [
        ({"normalization": "q"}, 1.0),
        ({"normalization": "1/wavelength"}, 4.0 * np.pi**2),
        ({"normalization": "contact.engineering"}, 4.0 * np.pi**2),
    ],
)
def test_a_psd_has_the_stated_convention(tmp_path, options, divisor):
    file = written(tmp_path / "psd.csv", "q [1/m],PSD [m^4]", Q, C)
    np.testing.assert_allclose(gs.read_spectrum(file, **options).density, C / divisor)
    with pytest.raises(InputError, match=r"normalization must be given .q, 1/wavelength") as error:
        gs.read_spectrum(file)
    assert error.value.missing == "normalization"


def test_units_of_the_caller(tmp_path):
    file = written(tmp_path / "psd.csv", "q,C", 1e-6 * Q, 1e24 * C)
    found = gs.read_spectrum(file, wavenumber_unit="1/um", density_unit="um^4")
    np.testing.assert_allclose(found.density, C)
    np.testing.assert_allclose(found.wavenumber, Q)


@pytest.mark.parametrize(
    ("titles", "message", "missing"),
    [
        ("q [1/ly],C [m^4]", r"q is in '1/ly', which is no unit of it \(1/m, um\^-1", ""),
        ("q [1/m],C [Pa]", "C is in 'Pa', which is no unit of it", ""),
        ("q [1/m],C [m^2]", "C is in 'm.2', which is no unit of it", ""),
        ("q [mm],C [m^4]", "q is in 'mm', which is no unit of it", ""),
        ("wavelength [1/m],C [m^4]", "wavelength is in '1/m', which is no unit of it", ""),
        ("q,C [m^4]", "wavenumber_unit must be given .* nothing states it of q", "wavenumber_unit"),
        ("q [1/m],C(q)", "density_unit must be given .* nothing states it of C", "density_unit"),
        ("q [1/m],C", "density_unit must be given .* nothing states it of C", "density_unit"),
        ("x [m],z [m]", "expected columns titled q and C", ""),
    ],
)
def test_units_are_never_guessed(tmp_path, titles, message, missing):
    with pytest.raises(InputError, match=message) as error:
        gs.read_spectrum(written(tmp_path / "psd.csv", titles, Q, C))
    assert error.value.missing == missing


def test_rows_may_fall_and_miss(tmp_path):
    values = np.append(C[::-1], np.nan)
    file = written(tmp_path / "psd.csv", "q [1/m],C [m^4]", np.append(Q[::-1], 1.0), values)
    np.testing.assert_allclose(gs.read_spectrum(file).density, C)
