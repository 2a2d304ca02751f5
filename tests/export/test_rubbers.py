"""Rubbers for other programs say what gripscale says: read back by the rules of their manuals."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from gripscale.core.errors import FileError, InputError
from gripscale.export import rubber_file, write_rubber
from gripscale.export.rubber import reduced
from gripscale.rubber import (
    WLF,
    Arrhenius,
    Isihara,
    MooneyRivlin,
    NeoHookean,
    Rubber,
    ShiftTable,
    StrainEnergy,
    WLFArrhenius,
    Yeoh,
    fit_prony,
    read_master_curve,
    styrene_butadiene,
)
from tests.export.readers import READERS, read_abaqus, read_ansys
from tests.samples import MEASURED_DMA as DMA
from tests.samples import write_maxwell

ENERGIES = (NeoHookean(), MooneyRivlin(0.3), Yeoh(-0.05, 0.004), Isihara(0.2, -0.02))


@pytest.fixture(scope="module")
def measured():
    """The measured tread: 23 elements, a thousand times stiffer at once than relaxed."""
    return fit_prony(read_master_curve(DMA))


def band(rubber):
    return np.geomspace(0.01 / rubber.relaxation_times.max(), 100 / rubber.relaxation_times.min())


@pytest.mark.parametrize("program", READERS)
@pytest.mark.parametrize("unit", ["Pa", "MPa"])
def test_the_complex_modulus_is_that_of_the_rubber(measured, program, unit):
    """E_inf comes out of 1 - sum g_i: 15 digits, of which a thousand costs three."""
    found = READERS[program](rubber_file(measured, to=program, modulus_unit=unit).text)
    omega = band(measured)
    size = {"Pa": 1.0, "MPa": 1e6}[unit]
    own = measured.complex_modulus(omega)
    ratio = found.complex_modulus(omega) * size
    np.testing.assert_allclose(ratio.real, own.real, rtol=1e-11)
    np.testing.assert_allclose(ratio.imag, own.imag, rtol=1e-11)
    assert found.bulk * size == pytest.approx(measured.bulk_modulus, rel=1e-13)


@pytest.mark.parametrize("program", READERS)
@pytest.mark.parametrize("energy", ENERGIES, ids=lambda energy: energy.kind)
def test_the_relaxed_rubber_is_that_of_the_strain_energy(program, energy):
    rubber = Rubber(6e6, [3e6, 5e6], [1e-2, 1e-4], strain_energy=energy)
    if program == "febio" and energy.kind == "isihara":
        with pytest.raises(InputError, match="for FEBio; got isihara"):
            rubber_file(rubber, to="febio")
        return
    found = READERS[program](rubber_file(rubber, to=program).text)
    s = np.array([0.5, 0.9, 1.2, 2.0, 3.0])
    own = 2e6 * (s - s**-2) * energy.uniaxial_factor(s)
    np.testing.assert_allclose(found.uniaxial_stress(s), own, rtol=1e-12)
    omega = band(rubber)
    np.testing.assert_allclose(
        found.complex_modulus(omega), rubber.complex_modulus(omega), rtol=1e-12
    )


@pytest.mark.parametrize("program", READERS)
def test_an_elastic_rubber_has_no_series(program):
    text = rubber_file(Rubber(3e6), to=program).text
    found = READERS[program](text)
    assert found.complex_modulus(np.array([1.0])) == pytest.approx(3e6)
    assert not any(word in text for word in ("PRONY", "viscoelastic"))


@pytest.mark.parametrize(("program", "read"), [("abaqus", read_abaqus), ("ansys", read_ansys)])
@pytest.mark.parametrize("unit", ["K", "C"])
def test_the_shift_is_that_of_the_rubber(program, read, unit):
    """The law holds for 300 K, the rubber for 320 K: the constants must be those of 320 K."""
    law = WLF(8.0, 120.0, 300.0)
    rubber = Rubber(6e6, [3e6], [1e-2], reference_temperature=320.0, shift=law)
    reference, c1, c2 = read(rubber_file(rubber, to=program, temperature_unit=unit).text).wlf
    kelvin = np.array([290.0, 310.0, 350.0])
    above = kelvin - (273.15 if unit == "C" else 0.0) - reference
    np.testing.assert_allclose(-c1 * above / (c2 + above), law.log_a(kelvin, 320.0), rtol=1e-12)


def test_a_shift_table_becomes_the_law_that_fits_it_and_says_by_how_much():
    law = WLF(8.0, 120.0, 300.0)
    kelvin = np.linspace(270.0, 350.0, 9)
    off = 0.03 * (-1.0) ** np.arange(9)
    table = ShiftTable(kelvin, law.log_a(kelvin, 300.0) + off, vertical=0.001 * (kelvin - 300.0))
    rubber = Rubber(6e6, [3e6], [1e-2], reference_temperature=300.0, shift=table)
    made = rubber_file(rubber, to="abaqus")
    said = made.remarks[-1]
    reference, c1, c2 = read_abaqus(made.text).wlf
    above = kelvin - reference
    missed = table.log_a(kelvin, 300.0) + c1 * above / (c2 + above)
    assert f"{np.sqrt(np.mean(missed**2)):.2g} decades rms" in said
    assert f"{np.abs(missed).max():.2g} at most" in said
    assert "vertical shift, up to a factor of 1.12, is not carried" in said


@pytest.mark.parametrize(
    ("shift", "carried", "said"),
    [
        (None, False, "no shift"),
        (Arrhenius(1e5), False, "(arrhenius) is not carried"),
        (WLFArrhenius(8.0, 120.0, 2e5, 250.0), True, "Arrhenius law below it is not carried"),
        (ShiftTable([290.0, 300.0], [1.0, 0.0]), False, "table is not carried"),
    ],
)
def test_what_of_a_shift_is_not_carried_is_said(shift, carried, said):
    rubber = Rubber(6e6, [3e6], [1e-2], reference_temperature=300.0, shift=shift)
    for program, read in (("abaqus", read_abaqus), ("ansys", read_ansys)):
        found = rubber_file(rubber, to=program)
        assert (read(found.text).wlf is not None) == carried
        assert said in found.remarks[-1]
    if carried:
        remarks = rubber_file(rubber, to="febio").remarks
        assert "FEBio has no time-temperature shift" in remarks[-1]
        assert "Moduli and times are those at 300 K." in remarks


def test_all_remarks_stand_in_the_file():
    rubber = Rubber(6e6, [3e6], [1e-2], name="tread -- A", source="made\nup", valid_band=(1.0, 1e3))
    for program in READERS:
        found = rubber_file(rubber, to=program)
        text = " ".join(found.text.replace("**", " ").replace("!", " ").split())
        for remark in found.remarks:
            plain = remark.replace("--", "- -") if program == "febio" else remark
            assert plain in text, remark
        assert "from 1 to 1000 rad/s" in text
    ET.fromstring(rubber_file(rubber, to="febio").text.encode())


def test_odd_names_do_not_break_the_file():
    rubber = Rubber(6e6, [3e6], [1e-2], name="80 µm --- <&> \x00 *MATERIAL")
    for program, read in READERS.items():
        text = rubber_file(rubber, to=program).text
        assert text.isascii()
        assert read(text).bulk == pytest.approx(2e9)


def test_a_melt_is_refused_where_its_relaxed_modulus_would_be_lost():
    melt = Rubber(10.0, [1e9], [1e-6])
    for program in ("abaqus", "ansys"):
        with pytest.raises(InputError, match="at least 1e-07 of E_inf"):
            rubber_file(melt, to=program)
    found = READERS["febio"](rubber_file(melt, to="febio").text)
    np.testing.assert_allclose(found.complex_modulus(np.array([0.0])), 10.0, rtol=1e-14)


def test_numbers_fit_into_what_abaqus_reads():
    """The reader refuses more than 20 characters; three digits of an exponent and a sign are 19."""
    rubber = Rubber(6e-99, [3e-98], [1e-100], bulk_modulus=1e-90, strain_energy=Yeoh(-0.05, 0.004))
    found = read_abaqus(rubber_file(rubber, to="abaqus").text)
    assert found.relaxed[2, 0] == pytest.approx(-5e-101, rel=1e-12)


class Other(StrainEnergy):
    """An energy of somebody else."""

    kind: ClassVar[str] = "other"

    def slopes(self, first, second):
        return np.ones_like(first), np.zeros_like(second)


@pytest.mark.parametrize(
    ("change", "options", "sentence"),
    [
        *(({"strain_energy": Other()}, {"to": to}, "to be exported; got other") for to in READERS),
        ({}, {"to": "ansys", "modulus_unit": "torr"}, "modulus_unit must be one of Pa"),
        (
            {"strain_energy": MooneyRivlin(1.0)},
            {"to": "febio"},
            r"mooney_rivlin with a share below 1 .*: 1\.0",
        ),
        ({}, {"to": "abaqus", "temperature_unit": "F"}, "must be one of K, C; got 'F'"),
        ({}, {"to": "abaqus", "name": "a, b"}, "name must be at most 38"),
        ({}, {"to": "ansys", "material": 0}, "material must be a whole number"),
        ({}, {"to": "nastran"}, "to must be one of abaqus, ansys, febio; got 'nastran'"),
        ({}, {"to": "febio", "temperature_unit": "C"}, "unknown option of febio temperature_unit"),
    ],
)
def test_what_cannot_be_exported_is_refused(tmp_path, change, options, sentence):
    rubber = replace(Rubber(6e6, [3e6], [1e-2]), **change)
    with pytest.raises(InputError, match=sentence):
        write_rubber(rubber, tmp_path / "a", **options)
    assert not list(tmp_path.iterdir())


def test_the_file_is_the_text(tmp_path):
    rubber = Rubber(6e6, [3e6], [1e-2])
    made = write_rubber(rubber, tmp_path / "a.inp", to="abaqus", name="tread")
    assert (tmp_path / "a.inp").read_text() == made.text
    assert "*MATERIAL, NAME=tread" in made.text
    with pytest.raises(FileError, match="cannot be written"):
        write_rubber(rubber, tmp_path / "none" / "a", to="febio")


SBR = styrene_butadiene()
BAND = (1.0, 1e5)


def errors(rubber):
    """Return the largest relative errors of E', E'' and E''/E' over the band, at 1000 points."""
    omega = 2.0 * np.pi * np.geomspace(*BAND, 1000)
    here, exact = rubber.complex_modulus(omega), SBR.complex_modulus(omega)
    parts = here.real / exact.real, here.imag / exact.imag
    return [float(np.abs(part - 1.0).max()) for part in (*parts, parts[1] / parts[0])]


def test_the_misfit_is_that_within_the_band():
    reduction = reduced(SBR, band=BAND, terms=10)
    stated = [reduction.storage, reduction.loss, reduction.loss_factor]
    # 20 points per decade miss the largest by less than a tenth of it
    assert stated == pytest.approx(errors(reduction.rubber), rel=0.1)
    # ten elements for five decades: two a decade, as the rubber itself has
    assert max(stated) < 0.08
    assert reduction.rubber.valid_band == pytest.approx([2.0 * np.pi * end for end in BAND])
    assert f"Reduced to {len(reduction.rubber.moduli)} Maxwell elements" in reduction.rubber.source
    assert f"E' {reduction.storage:.2%}" in str(reduction)
    for kept in ("bulk_modulus", "reference_temperature", "strain_energy"):
        assert getattr(reduction.rubber, kept) == getattr(SBR, kept)


def test_fewer_terms_miss_more_and_all_of_them_nothing():
    worst = [max(errors(reduced(SBR, band=BAND, terms=terms).rubber)) for terms in (2, 4, 8, 16)]
    assert worst == sorted(worst, reverse=True)
    single = Rubber(2e6, [5e6], [1e-3])
    again = reduced(single, band=(1.0, 1e5), terms=41)
    assert max(again.storage, again.loss) < 0.01


def test_what_cannot_be_reduced_is_refused():
    with pytest.raises(InputError, match="got an elastic one"):
        reduced(Rubber(2e6, [], []))
    with pytest.raises(InputError, match="terms must be a whole number from 1 to 200; got 0"):
        reduced(SBR, terms=0)
    with pytest.raises(InputError, match=r"band .* must be a lower and a higher value"):
        reduced(SBR, band=(1e3, 1.0))


def test_the_command_states_the_misfit(shell, tmp_path):
    write_maxwell(tmp_path / "dma.txt")
    target = tmp_path / "rubber.inp"
    arguments = ("export", "rubber", tmp_path / "dma.txt", "--to", "abaqus", "--output", target)
    options = ["--band", "1..1e3 Hz", "--terms", "3"]
    outcome = shell(*arguments, *options)
    words = "Reduced to 3 Maxwell elements for 1 to 1000 Hz; largest errors there"
    assert words in " ".join(outcome.output.split())
    assert words in " ".join(target.read_text().replace("**", "").split())
