"""Strain sweeps as laboratories deliver them: which rows are one sweep, and what they mean."""

from dataclasses import replace

import numpy as np
import pytest

from gripscale.core import FileError, InputError
from gripscale.rubber import StrainSweep, read_strain_sweeps
from gripscale.rubber.softening import Kraus, SofteningTable, assumptions, softening_of_sweeps
from gripscale.rubber.strain_sweeps import holds_strain_sweeps

STRAIN = np.geomspace(1e-4, 0.25, 35)
TITLES = "temperature [C],frequency [Hz],strain amplitude [%],E' [MPa],E'' [MPa]"


def moduli(strain, critical):
    """Kraus' law written out, m = 1/2, in MPa."""
    ratio = strain / critical
    return 2.0 + 6.0 / (1.0 + ratio), 0.3 + 1.6 * np.sqrt(ratio) / (1.0 + ratio)


def rows(celsius, hertz, critical):
    """Rows of a sweep, its temperature and frequency as an instrument prints them."""
    real, imaginary = moduli(STRAIN, critical)
    return [
        f"{celsius + 0.1 * (at % 2):.1f},{hertz * (1 + 0.002 * (at % 3)):.4g},"
        f"{100 * strain:.6g},{e1:.7g},{e2:.7g}"
        for at, (strain, e1, e2) in enumerate(zip(STRAIN, real, imaginary, strict=True))
    ]


def test_temperatures_of_a_file_are_sweeps(written):
    parts = [rows(29.9, 1.0, 0.02), rows(0.0, 1.0, 0.01), rows(50.0, 1.0, 0.03)]
    mixed = [line for three in zip(*parts, strict=True) for line in three]
    sweeps = read_strain_sweeps(written([TITLES, *mixed]))
    kelvin = [sweep.temperature for sweep in sweeps]
    assert kelvin == pytest.approx([273.15 + 0.05, 303.05 + 0.05, 323.15 + 0.05], abs=5e-3)
    for sweep, critical in zip(sweeps, (0.01, 0.02, 0.03), strict=True):
        assert sweep.strain == pytest.approx(STRAIN, rel=1e-5)
        assert sweep.storage == pytest.approx(1e6 * moduli(STRAIN, critical)[0], rel=1e-5)
        assert sweep.frequency == pytest.approx(1.0, rel=3e-3)
        # the title says amplitude and no more; Young's moduli do not say tension
        assert (sweep.amplitude_assumed, sweep.deformation) == (True, None)


def test_of_several_frequencies_the_highest_counts(written):
    lines = [*rows(20.0, 1.0, 0.02), *rows(20.0, 10.0, 0.03), *rows(60.0, 10.0, 0.05)]
    file = written([TITLES, *lines])
    sweeps = read_strain_sweeps(file, deformation="tension")
    assert [round(sweep.frequency) for sweep in sweeps] == [1, 10, 10]
    law = softening_of_sweeps(sweeps)
    assert len(law.strain) == 2
    at = np.array([1e-3, STRAIN[20]])
    real = moduli(at, 0.03)[0]
    # 1e-3 lies between rows a tenth of a decade apart
    assert law.factors(at[1], law.temperature[0]).storage == pytest.approx(
        real[1] / real[0], rel=1e-3
    )


def test_tables_below_each_other_and_files_with_the_temperature_in_their_name(written):
    title = "Shear strain 0-p (%)\tG' (MPa)\tG'' (MPa)"
    table = ["0.1\t3\t0.3", "1\t2\t0.3", "10\t1\t0.2"]
    blocks = [part for t in (20, 40) for part in (f"T = {t} °C", "f = 5 Hz", title, *table)]
    sweeps = read_strain_sweeps(written(blocks, "blocks.txt"))
    assert [sweep.condition for sweep in sweeps] == ["20.0 °C, 5 Hz", "40.0 °C, 5 Hz"]
    assert sweeps[0].storage == pytest.approx([9e6, 6e6, 3e6])
    assert (sweeps[0].deformation, sweeps[0].amplitude_assumed) == ("shear", False)
    files = [written([title, *table], f"payne_{t}C.txt") for t in (-20, 30)]
    assert [round(s.temperature - 273.15) for s in read_strain_sweeps(files)] == [-20, 30]


def test_published_factors_need_no_moduli(written):
    title = "strain [-],f = storage over its small-strain value [-],g = loss over its value [-]"
    file = written([title, "0.001,0.95,1.04", "0.01,0.75,1.0", "0.1,0.40,0.65"])
    with pytest.raises(InputError, match="amplitude must be given"):
        read_strain_sweeps(file)
    (sweep,) = read_strain_sweeps(file, amplitude="single", deformation="tension")
    law = softening_of_sweeps([sweep])
    assert law.factors(0.1).storage == pytest.approx(0.40 / 0.95)
    assert law.factors(0.1).loss == pytest.approx(0.65 / 1.04)
    normalised = written(["single strain [%],G'/G'0,G''/G''0", "0.1,1,1", "10,.4,.6"])
    assert softening_of_sweeps(read_strain_sweeps(normalised)).deformation == "shear"


@pytest.mark.parametrize(
    ("strain", "modulus", "deformation"),
    [
        ("strain", "E", None),
        ("Scherdehnung", "G", "shear"),
        ("strain", "G", "shear"),
        ("gamma", "E", "shear"),
        ("compression strain", "E", "tension"),
        ("uniaxial strain", "E", "tension"),
    ],
)
def test_what_titles_say_of_the_deformation(written, strain, modulus, deformation):
    title = f"{strain} DSA (%),{modulus}' (MPa),{modulus}'' (MPa)"
    (sweep,) = read_strain_sweeps(written([title, "2,2,1", "20,1,1"]))
    assert sweep.deformation == deformation
    assert sweep.strain == pytest.approx([0.01, 0.1])


def test_a_strain_measured_again_is_averaged_and_another_specimen_refused(written):
    title = "single strain (%),E' (MPa),E'' (MPa)"
    again = written([title, "1,4,1", "1,4.41,1", "10,1,1", "10,1,1"])
    (sweep,) = read_strain_sweeps(again)
    assert sweep.storage == pytest.approx([4.205e6, 1e6])
    two = written([title, "1,4,1", "1,8,1", "10,1,1", "10,2,1"])
    with pytest.raises(FileError, match=r"one measurement at each strain; got moduli 2 times"):
        read_strain_sweeps(two)


def test_rows_without_one_of_several_temperatures_are_refused(written):
    lines = ["20,1,0.1,3,1", "20,1,1,2,1", "40,1,0.1,3,1", ",1,1,2,1"]
    with pytest.raises(
        FileError, match=r"a temperature in every row of several; got none in 1 of 4 rows"
    ):
        read_strain_sweeps(written([TITLES, *lines]))


def test_sweeps_that_are_no_softening():
    sweep = StrainSweep([1e-3, 0.1], [2e6, 1e6], [1e5, 1e5], "shear", 293.0, 1.0)
    again = StrainSweep([1e-3, 0.1], [2e6, 1e6], [1e5, 1e5], "shear", 293.0, 1.01)
    other = StrainSweep([1e-3, 0.1], [2e6, 1e6], [1e5, 1e5], None, 313.0)
    with pytest.raises(InputError, match=r"of its own; got 19\.9 °C, 1 Hz; 19\.9 °C, 1\.01 Hz"):
        softening_of_sweeps([sweep, again])
    with pytest.raises(InputError, match="all in shear; got not stated and shear"):
        softening_of_sweeps([sweep, other])


def test_not_stated_is_half_way_between_tension_and_shear():
    table = SofteningTable([STRAIN], *([part] for part in moduli(STRAIN, 0.02)))
    kraus = Kraus(0.25, 0.2, 0.02, 1e-3)
    for law in (table, kraus):
        tension, shear = (replace(law, deformation=kind) for kind in ("tension", "shear"))
        # the same energy: G s^2 = E e^2, so that s = sqrt(3) e, and half-way 3^(1/4)
        at = np.geomspace(2e-3, 0.1, 9)
        middle = law.factors(at)
        assert middle.storage == pytest.approx(tension.factors(3**0.25 * at).storage)
        assert middle.loss == pytest.approx(shear.factors(at / 3**0.25).loss)
        assert (shear.factors(at).storage < middle.storage).all()
        assert (middle.storage < tension.factors(at).storage).all()


def test_without_the_strain_of_the_master_curve():
    fine, coarse = [1e-4, 1e-3, 0.1], [5e-3, 0.05, 0.1]
    law = SofteningTable(
        [fine, coarse], [[3, 2, 1]] * 2, [[1, 1, 1]] * 2, None, "shear", [290.0, 310.0]
    )
    assert (law.reference(0), law.reference(1)) == (1e-3, 5e-3)
    assert law.factors(1.0, 290.0).storage == pytest.approx(1 / 2)
    assert law.factors(1.0, 310.0).storage == pytest.approx(1 / 3)
    assert list(assumptions(law)) == ["moduli taken as measured at a strain of 0.10% to 0.50%"]


def test_assumptions_are_those_of_what_is_not_stated(written):
    law = softening_of_sweeps(read_strain_sweeps(written([TITLES, *rows(0, 1, 0.02)])))
    assert [text.split()[0] for text in assumptions(law)] == ["strain", "moduli", "strain"]
    complete = SofteningTable(law.strain, law.storage, law.loss, 1e-3, "tension")
    assert not list(assumptions(complete))


def test_strain_sweeps_are_told_from_frequency_sweeps(written, tmp_path):
    sweeps = [TITLES, *rows(20.0, 1.0, 0.02), *rows(60.0, 1.0, 0.05)]
    assert holds_strain_sweeps(written(sweeps))
    # a stress-controlled rheometer prints another strain at each frequency
    curve = [f"20,{f:g},{0.1 + 0.1 * at},8,1" for at, f in enumerate(np.geomspace(0.1, 100, 15))]
    assert not holds_strain_sweeps(written([TITLES, *curve]))
    assert not holds_strain_sweeps(written(["f [Hz],E' [MPa],E'' [MPa]", "1,1,1"]))
    assert not holds_strain_sweeps(tmp_path / "none.csv")
