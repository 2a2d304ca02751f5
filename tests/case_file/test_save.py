"""A saved case has the same answers, to the last digit, wherever its folder goes."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.case import BelowMeasurement
from gripscale.chain import Chain
from gripscale.conditions import Conditions, ConstantStress
from gripscale.continuation.roughness import HurstExponent
from gripscale.core.errors import FileError, GripscaleError, InputError
from gripscale.experiment import MeasuredFriction
from gripscale.rubber import ShiftTable, Yeoh
from gripscale.rubber.softening import SofteningTable
from gripscale.surface import self_affine_profile
from gripscale.theory import HalfPlane, KlueppelHeinrich
from gripscale.wave import FiniteStrainBlock
from tests.half_space.rough_cases import isotropic_heights
from tests.samples import KRAUS, MEASURED_DMA, SHIFTED_RUBBER, THERMAL

LOAD = {"pressure": "3 bar", "speed": 0.3}
SINES = gs.SineStack([10e-3, 3e-3], [3e-4, 1e-4])
QUICK = Chain(HalfPlane(points=128))


def line(seed=3):
    return self_affine_profile(
        hurst=0.8, xi_parallel=3e-3, xi_perpendicular=0.4e-3, length=0.02, step=0.05e-3, seed=seed
    )


def height_map():
    z = isotropic_heights(64, length=0.0128, rms=1e-4, shortest=8e-4)[:, :32].copy()
    z[30:33, 10:12] = np.nan
    return gs.HeightMap(2e-4 * np.arange(64), 4e-4 * np.arange(32) + 1e-3, z, "ground")


def moved(case, folder):
    """Save a case, move its folder, read it there."""
    written = case.save(folder / "made" / "mine.toml")
    assert written == folder / "made" / "mine.toml"
    shutil.move(folder / "made", folder / "moved")
    return gs.read_case(folder / "moved" / "mine.toml")


def assert_same(case, other, *, answers=True):
    """Compare heights, the chain and, if wanted, all numbers of two answers to the last bit."""
    measured = [each.surface.measured for each in (case, other)]
    for ours, theirs in zip(*(m.surfaces if m else () for m in measured), strict=True):
        np.testing.assert_array_equal(ours.z, theirs.z)
    chains = [
        each.chain.solve(each.rubber, each.surface.sines, each.load) for each in (case, other)
    ]
    assert chains[0].friction == chains[1].friction > 0.0
    if answers:
        before, after = gs.answer(case).to_dataset(), gs.answer(other).to_dataset()
        assert set(before) == set(after)
        for name, values in before.items():
            if values.dtype.kind == "f":
                xr.testing.assert_identical(values.drop_attrs(), after[name].drop_attrs())
        assert measured[0] is None or before["total_friction"] > 0.0


SURFACES = {
    "profile": line(),
    "profiles": [line(1), line(2)],
    "across": [line(1), replace(line(2), lay="across")],
    "map": height_map(),
    "sines": SINES,
}


@pytest.mark.parametrize("surface", SURFACES)
def test_every_surface_comes_back(surface, tmp_path):
    case = gs.Case(SURFACES[surface], SHIFTED_RUBBER, **LOAD, waves=3, chain=QUICK)
    other = moved(case, tmp_path)
    assert_same(case, other, answers=surface in ("profile", "map"))
    assert other.chain == case.chain
    assert other.load == case.load


def test_heights_taken_as_they_are_are_not_cropped(tmp_path):
    case = gs.Case(SURFACES["profiles"], SHIFTED_RUBBER, **LOAD, waves=3, chain=QUICK)
    written = case.save(tmp_path / "case.toml")
    text = written.read_text()
    written.write_text(text.replace("clean = false", "clean = false\ncrop = [0.0, 0.01]"))
    with pytest.raises(InputError, match="crop cleans the heights; expected clean = true"):
        gs.read_case(written)


def test_a_prony_series_needs_its_moduli_only(tmp_path):
    written = gs.Case(SINES, SHIFTED_RUBBER, **LOAD).save(tmp_path / "case.toml")
    series = tmp_path / "inputs" / "rubber.json"
    series.write_text('{"equilibrium_modulus": 1e6, "moduli": [9e6], "relaxation_times": [1e-3]}')
    rubber = gs.read_case(written).rubber
    assert (rubber.equilibrium_modulus, rubber.bulk_modulus) == (1e6, 2e9)
    for text, words in (
        ('{"moduli": [9e6]}', "equilibrium_modulus must be given"),
        ('{"equilibrium_modulus": 1e6, "modulus": 2}', "values must have the keys"),
        ("[1]", "it is no JSON object"),
    ):
        series.write_text(text)
        with pytest.raises(GripscaleError, match=words):
            gs.read_case(written)
    written.write_text(written.read_text().replace("[rubber]", "[rubber]\nterms = 9"))
    series.write_text('{"equilibrium_modulus": 1e6}')
    with pytest.raises(InputError, match="terms is for measured moduli; got a Prony series"):
        gs.read_case(written)


def test_profiles_are_cleaned_as_before(tmp_path):
    """Distances as a file in mm gives them; a spike, a slope and missing heights to clean."""
    x = np.linspace(0.0, 20.0, 401)
    z = 1e3 * line().z[:401] + 0.05 * x
    z[[50, 51, 200]] = np.nan, np.nan, 9.0
    rows = "\n".join(f"{a:.2f} {b:.6f}" for a, b in zip(x, z, strict=True))
    (tmp_path / "road.txt").write_text(f"x [mm] depth [mm]\n{rows}\n")
    road = gs.read_profile(tmp_path / "road.txt")
    cleaning = {"crop": (1e-3, 18e-3), "spike_slope": 2.5}
    case = gs.Case(
        road, SHIFTED_RUBBER, **LOAD, smallest_wavelength=4e-4, cleaning=cleaning, chain=QUICK
    )
    other = moved(case, tmp_path)
    np.testing.assert_array_equal(other.surface.measured.profiles[0][0].x, road.x)
    assert other.cleaning == case.cleaning
    assert len(other.doubts()) == len(case.doubts()) > 0
    assert_same(case, other)


def test_what_an_instrument_resolves_comes_back(tmp_path):
    road = gs.Profile(line().x, line().z, reliable=6e-4)
    case = gs.Case(road, SHIFTED_RUBBER, **LOAD, chain=QUICK)
    other = moved(case, tmp_path)
    assert other.surface.cutoff_wavelength == case.surface.cutoff_wavelength
    assert other.surface.cutoff_wavelength == pytest.approx(6e-4)


SWEEPS = {
    "strain": [np.geomspace(1e-4, 0.3, 9), [2e-4, 1e-2, 0.11]],
    "storage": [np.geomspace(9.1e6, 2e6, 9), [8.3e6, 5e6, 3.7e6]],
    "loss": [np.geomspace(1.3e6, 4e5, 9), [8e5, 7.7e5, 6.1e5]],
    "temperature": [293.2, 333.15],
}
WARM = Conditions(313.15, KRAUS, heat=THERMAL, shear_stress=ConstantStress(1e6))
MASTER = gs.read_master_curve(MEASURED_DMA, reference_temperature=293.15, modulus="E")
RUBBERS = {
    "master curve": (MASTER, None),
    "shifted": (SHIFTED_RUBBER, Conditions(temperature=313.15)),
    "conditions": (SHIFTED_RUBBER, WARM),
    "sweeps": (
        SHIFTED_RUBBER,
        Conditions(softening=SofteningTable(**SWEEPS, deformation="tension")),
    ),
    "open sweeps": (
        SHIFTED_RUBBER,
        Conditions(softening=SofteningTable(**SWEEPS, amplitude_assumed=True)),
    ),
    "strain energy": (gs.Rubber(1e6, [9e6], [1e-3], strain_energy=Yeoh(0.1, 0.01)), None),
    "shift table": (
        gs.MasterCurve(
            MASTER.frequency,
            MASTER.storage,
            MASTER.loss,
            293.15,
            shift=ShiftTable([280.0, 293.15, 320.0], [1.3, 0.0, -2.1]),
        ),
        Conditions(temperature=301.7),
    ),
}


@pytest.mark.parametrize("name", RUBBERS)
def test_every_rubber_comes_back(name, tmp_path):
    rubber, conditions = RUBBERS[name]
    case = gs.Case(SINES, rubber, **LOAD, conditions=conditions, chain=QUICK)
    other = moved(case, tmp_path)
    before, after = case.rubber_before, other.rubber_before
    omega = np.geomspace(1.0, 1e6, 20)
    np.testing.assert_array_equal(before.complex_modulus(omega), after.complex_modulus(omega))
    assert before.valid_band == after.valid_band
    assert other.conditions == case.conditions
    solved = [each.chain.solve(each.rubber, SINES, each.load) for each in (case, other)]
    assert solved[0].friction == solved[1].friction


def test_everything_else_of_a_case_comes_back(tmp_path):
    measured = MeasuredFriction([0.1, 1.0], [0.5, 0.7], spread=[0.1, np.nan])
    case = gs.Case(
        line(),
        SHIFTED_RUBBER,
        pressure=2.5e5,
        speed=0.3,
        footprint=0.08,
        load_time=float("inf"),
        kind="counterface",
        chain=Chain(FiniteStrainBlock(tolerance=0.03), pressure_classes=2),
        below_measurement=BelowMeasurement(2e-5, HurstExponent(0.7), seed=4),
        klueppel_heinrich=KlueppelHeinrich(1.5, 1e-4),
        friction=measured,
    )
    other = moved(case, tmp_path)
    assert (other.load, other.chain) == (case.load, case.chain)
    assert other.below_measurement == case.below_measurement
    assert other.kind == "counterface"
    assert " on the counterface " in other.title
    assert other.klueppel_heinrich == case.klueppel_heinrich
    for column in ("speed", "friction", "spread", "temperature", "pressure"):
        np.testing.assert_array_equal(getattr(other.friction, column), getattr(measured, column))


def test_a_case_from_a_file_keeps_its_text_and_takes_its_files_along(tmp_path):
    written = gs.Case(line(), SHIFTED_RUBBER, **LOAD, chain=QUICK).save(tmp_path / "case.toml")
    case = gs.read_case(written)
    other = moved(case, tmp_path)
    assert other.origin.text == case.origin.text
    now, before = ([file.sha256 for file in each.origin.files] for each in (other, case))
    assert now == before
    (tmp_path / case.origin.files[0].name).write_text("x [m],z [m]\n")
    with pytest.raises(FileError, match="has changed since the case was read"):
        case.save(tmp_path / "late" / "case.toml")
    assert not (tmp_path / "late").exists()


def test_saving_twice_replaces_its_own_files_and_no_others(tmp_path):
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs" / "profile.csv").write_text("somebody else's")
    for seed in (1, 2):
        road = gs.Profile(line(seed).x, line(seed).z)
        case = gs.Case(road, SHIFTED_RUBBER, **LOAD, chain=QUICK)
        case.save(tmp_path / "case.toml")
    names = sorted(path.name for path in (tmp_path / "inputs").iterdir())
    assert names == ["profile.csv", "profile_2.csv", "rubber.json"]
    assert (tmp_path / "inputs" / "profile.csv").read_text() == "somebody else's"
    other = gs.read_case(tmp_path / "case.toml")
    np.testing.assert_array_equal(other.surface.measured.cleaned[0].z, line(2).z)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"chain": Chain(HalfPlane(most_iterations=50))}, "all options of the solver half_plane"),
        ({"surface": gs.SineStack([1e-2], [1e-4], cut_off=5e-3)}, "waves that end beyond"),
    ],
)
def test_what_no_file_can_state_is_refused(options, words, tmp_path):
    surface = options.pop("surface", SINES)
    case = gs.Case(surface, SHIFTED_RUBBER, **LOAD, **options)
    with pytest.raises(InputError, match=f"a case file cannot state {words}"):
        case.save(tmp_path / "made" / "case.toml")
    assert not (tmp_path / "made").exists()
