"""What a case file may say, and the one sentence for each way of getting it wrong."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripscale.case_file import (
    CaseTables,
    LoadTable,
    RubberSource,
    SolverTable,
    SurfaceTable,
    case_chain,
    prepare_rubber,
    prepare_surface,
    read_case_file,
    validate,
)
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import parse_quantity
from gripscale.rubber import NeoHookean, Yeoh
from gripscale.surface import fit_sines, height_difference, self_affine_profile
from tests.case_file.cases import refusal, written
from tests.samples import DOCS, EXAMPLES

GOOD = """
[surface]
files = ["road.dat"]
scales = 8
[rubber]
file = "dma.txt"
[load]
pressure = "3 bar"
speed = "300 mm/s"
footprint = 0.1
"""


def test_quantities_become_si_and_defaults_are_filled_in(tmp_path: Path) -> None:
    file = read_case_file(written(tmp_path, GOOD))
    load = file.case.load
    assert (load.pressure, load.speed, load.footprint) == (3e5, 0.3, 0.1)
    assert load.load_time == "passage"
    assert file.case.solver.options() == {}
    assert file.text == GOOD


def test_the_closer_chain_of_the_documentation_is_a_case(tmp_path: Path) -> None:
    page = DOCS / "chain-and-direct-contact.md"
    [stated] = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    file = read_case_file(written(tmp_path, stated + GOOD[GOOD.index("[rubber]") :]))
    case = file.case
    assert (case.surface.top_height_fraction, case.surface.scales) == (0.5, 4)
    assert (case.surface.cut_off, case.surface.smallest_wavelength) == (pytest.approx(1e-4), None)
    assert case_chain(file).pressure_classes == 8
    plain = read_case_file(written(tmp_path, GOOD))
    assert (plain.case.surface.top_height_fraction, plain.case.surface.cut_off) == (1.0, None)
    assert case_chain(plain).pressure_classes == 1


def test_prepared_with_what_the_case_says(tmp_path: Path) -> None:
    line = self_affine_profile(0.8, 5e-3, 1e-3, 0.2, 1e-4, seed=4)
    np.savetxt(tmp_path / "road.dat", np.column_stack([line.x, line.z]))
    stated = '["road.dat"]\nx_unit = "m"\nz_unit = "m"\ndetrend = "none"\nspikes = "none"'
    keys = 'scales = 4\ntop_height_fraction = 0.3\ncut_off = "1 mm"\nmax_lag = "30 mm"'
    text = GOOD.replace('["road.dat"]', stated).replace("scales = 8", keys)
    file = read_case_file(written(tmp_path, text))
    found = prepare_surface(file.case.surface, file.resolve)
    curve = height_difference(found.measured.cleaned, top_height_fraction=0.3, max_lag=30e-3)
    alone = fit_sines(curve, scales=4, cut_off=1e-3)
    assert found.sines.amplitude.tolist() == alone.amplitude.tolist()
    assert found.sines.cutoff_wavelength == pytest.approx(1e-3)
    assert found.counted == {"top_height_fraction": 0.3, "max_lag": pytest.approx(30e-3)}


def test_paths_start_at_the_case_file(tmp_path: Path) -> None:
    file = read_case_file(written(tmp_path, GOOD))
    assert file.resolve("../road.dat") == tmp_path.parent / "road.dat"
    assert file.resolve("/elsewhere/road.dat") == Path("/elsewhere/road.dat")


def test_only_stated_solver_options_are_passed_on(tmp_path: Path) -> None:
    file = read_case_file(written(tmp_path, GOOD + "[solver]\ncolumns = 64\ndepth = 2\n"))
    assert file.case.solver.options() == {"columns": 64, "depth": 2.0}


@pytest.mark.parametrize(
    ("stated", "seconds"), [('"infinite"', math.inf), ('"5 ms"', 5e-3), ("2.5", 2.5)]
)
def test_load_time(tmp_path: Path, stated: str, seconds: float) -> None:
    file = read_case_file(written(tmp_path, GOOD + f"load_time = {stated}\n"))
    assert file.case.load.load_time == seconds


@pytest.mark.parametrize(
    ("text", "kind", "si"),
    [
        ("3 bar", "pressure", 3e5),
        ("0.3MPa", "pressure", 3e5),
        ("2 GPa", "pressure", 2e9),
        (3e5, "pressure", 3e5),
        ("100 mm", "length", 0.1),
        ("1e2 um", "length", 1e-4),
        ("36 km/h", "speed", 10.0),
        ("-5 mm", "length", -5e-3),
        ("20 C", "temperature", 293.15),
    ],
)
def test_quantity(text: str | float, kind: str, si: float) -> None:
    assert parse_quantity(text, kind) == pytest.approx(si, rel=1e-14)


WRONG = [
    ("pressure =", "presure =", "unknown key [load] presure; did you mean pressure?"),
    ("[load]", "[lod]", "unknown key [lod]; did you mean load?"),
    ("[load]", "[load]\nstatic = true", "unknown key [load] static; it is gone: speed = 0 solves"),
    ("scales = 8", "xyzzy = 8", "unknown key [surface] xyzzy; expected one of files,"),
    ('"3 bar"', '"3 furlong"', "[load] pressure = '3 furlong': unknown unit 'furlong'; expected"),
    ('"3 bar"', '"3 mm"', "unknown unit 'mm'; expected one of Pa, kPa, psi, bar"),
    ('"3 bar"', '"3"', "[load] pressure = '3': the unit is missing"),
    ('"3 bar"', '"bar"', "[load] pressure = 'bar': expected a pressure such as \"3 bar\""),
    ('"3 bar"', "true", "[load] pressure = True: expected a pressure"),
    ('"3 bar"', "[3]", "[load] pressure = [3]: expected a pressure"),
    ('"3 bar"', "-3", "[load] pressure = -3: expected a value greater than zero"),
    ('"3 bar"', "0", "[load] pressure = 0: expected a value greater than zero"),
    ('"3 bar"', "nan", "[load] pressure = nan: expected a finite pressure"),
    ('"3 bar"', '"inf bar"', "expected a finite pressure"),
    ('"300 mm/s"', '"-1 m/s"', "[load] speed = '-1 m/s': expected zero or a positive value"),
    ("0.1", "-0.1", "[load] footprint = -0.1: expected a value greater than zero"),
    ("footprint = 0.1", "", '[load] footprint is missing; expected a length such as "1'),
    ('pressure = "3 bar"', "", '[load] pressure is missing; expected a pressure such as "3 bar"'),
    ('speed = "300 mm/s"', 'speed = 1\nload_time = "soon"',
     'load_time must be "passage", "infinite" or a time such as "1 s"; got'),
    ("scales = 8", "scales = 8.5", "[surface] scales = 8.5: expected a whole number"),
    ("scales = 8", "scales = 0",
     "[surface] scales = 0: expected a whole number, at least 1, at most 24"),
    ("scales = 8", "scales = 25", "scales = 25: expected a whole number, at least 1, at most 24"),
    ("scales = 8", 'scales = "8"', "[surface] scales = '8': expected a whole number"),
    ("scales = 8", "", "[surface]: expected scales (number of waves), smallest_wavelength"),
    ("scales = 8", 'smallest_wavelength = "1 mm"\ncut_off = "1 mm"',
     "[surface]: expected either smallest_wavelength (the last wave) or cut_off"),
    ("scales = 8", "scales = 8\ntop_height_fraction = 1.5",
     "top_height_fraction = 1.5: expected a number, above 0, at most 1"),
    ("[load]", "[chain]\npressure_classes = 65\n[load]", "pressure_classes = 65: expected a whole"),
    ("scales = 8", "scales = 8\ns_wavelength = 1", "s_wavelength = 1: expected a number, above 1"),
    ("scales = 8", 'scales = 8\ncrop = ["1 mm"]',
     "[surface] crop = ['1 mm']: expected a list of 2, each"),
    ("scales = 8", "scales = 8\ncrop = [2, 1]",
     "crop runs from 2000 mm to 1000 mm; expected its start"),
    ("scales = 8", 'scales = 8\ncrop = [0, "1 ell"]', "[surface] crop[1] = '1 ell': unknown unit"),
    ("scales = 8", 'scales = 8\ndetrend = "cubic"',
     'detrend = \'cubic\': expected "linear" or "mean"'),
    ("scales = 8", 'scales = 8\nz_unit = "furlong"', "z_unit = 'furlong': expected one of m, cm,"),
    ("scales = 8", 'scales = 8\nspikes = "no"',
     'spikes = \'no\': expected "isolated" or "iso13473"'),
    ('["road.dat"]', "[]", "[surface] files = []: expected a list of at least 1, each a text"),
    ('["road.dat"]', '"road.dat"',
     "[surface] files = 'road.dat': expected a list of at least 1, each a text"),
    ('files = ["road.dat"]', "",
     "[surface]: expected either files (measured profiles), map (a measured map), spectrum"),
    ('files = ["road.dat"]\nscales = 8', "[[surface.sines]]\nwavelength = 1e-3\namplitud = 1e-4",
     "unknown key [surface] sines[0].amplitud; did you mean amplitude?"),
    ('files = ["road.dat"]\nscales = 8', "[[surface.sines]]\nwavelength = 1e-3\namplitude = 0",
     "[surface] sines[0].amplitude = 0: expected a value greater than zero"),
    ('files = ["road.dat"]\nscales = 8',
     "[[surface.sines]]\nwavelength = 1e-3\namplitude = 1e-4\n" * 2,
     "expected sines in order of falling wavelength"),
    ('file = "dma.txt"', "", "[rubber]: expected either file (a master curve) or name"),
    ('file = "dma.txt"', 'name = "butyl"',
     "[rubber] name = 'butyl': expected \"styrene_butadiene\""),
    ('file = "dma.txt"', 'name = "styrene_butadiene"\nterms = 3',
     "terms belongs to a measured file, not to a named rubber"),
    ('"dma.txt"', '"dma.txt"\nmodulus_unit = "ell"', "modulus_unit = 'ell': expected one of Pa"),
    ('"dma.txt"', '"dma.txt"\nbulk_modulus = 0', "bulk_modulus = 0: expected a value greater than"),
    ('"dma.txt"', '"dma.txt"\nterms = -1',
     "[rubber] terms = -1: expected a whole number, at least 1"),
    ("[load]", "[solver]\ncolumns = 2\n[load]",
     "[solver] columns = 2: expected a whole number, at least 4"),
    ("[load]", "[solver]\ncolumns = 9\n[load]",
     "columns = 9: expected a whole number, at least 4, at most 4096, a multiple of"),
    ("[load]", "[solver]\nelement_order = 3\n[load]", "element_order = 3: expected 1 or 2"),
    ("[load]", "[solver]\ntolerance = 0\n[load]", "tolerance = 0: expected a number, above 0"),
    ("[load]", '[solver]\nmodel = "half_plane"\ncolumns = 64\n[load]',
     '[solver]: columns is not an option of model = "half_plane"'),
    ("[load]", "[[load]]", "expected a table"),
    (GOOD, "", "an empty case; expected at least [surface], [rubber] and [load], as"),
    (GOOD, "[output]", "[surface] is missing; expected a table with files,"),
    ("scales = 8", "scales = 8\ncrop = [1, 2, 3]", "crop = [1, 2, 3]: expected a list of 2"),
    ("scales = 8", "scales = 8\nspike_slope = inf", "spike_slope = inf: expected a finite number"),
    ("scales = 8", 'scales = 8\nspike_slope = "2"', "spike_slope = '2': expected a number"),
    ("scales = 8", "scales = 8\nx_unit = 3", "[surface] x_unit = 3: expected one of m, cm"),
    ("[load]", "[solver]\ntolerance = 1\n[load]",
     "tolerance = 1: expected a number, above 0, below 1"),
    ("[load]", "[solver]\ntime_limit = 0\n[load]", "time_limit = 0: expected a value greater than"),
    ("[load]", '[solver]\nmodel = "half_plane"\ntime_limit = "1 s"\n[load]',
     '[solver]: time_limit is not an option of model = "half_plane"'),
    ('"dma.txt"', '"dma.txt"\nextrapolate = "no"', 'extrapolate = \'no\': expected "warn" or "ref'),
    ('"dma.txt"', '"dma.txt"\nstrain_energy = "yeoh"',
     "[rubber] strain_energy = 'yeoh': expected a table with kind (one of neo_hookean, "),
    ('"dma.txt"', '"dma.txt"\nstrain_energy = { kind = "ogden" }',
     "[rubber] strain_energy: kind = 'ogden': expected one of neo_hookean, mooney_rivlin, yeoh, "
     "isihara"),
    ('"dma.txt"', '"dma.txt"\nstrain_energy = { kind = "yeoh", second = 1, fourth = 2 }',
     "[rubber] strain_energy: unknown key fourth; expected one of kind, second, third"),
    ('"dma.txt"', '"dma.txt"\nstrain_energy = { kind = "mooney_rivlin", share = "half" }',
     "[rubber] strain_energy: share = 'half': expected a number"),
    ('"dma.txt"', '"dma.txt"\nstrain_energy = { kind = "yeoh", second = 1, third = 1 }\n'
     '[solver]\nmodel = "half_plane"',
     ": strain_energy of [rubber] has no effect at small strain; expected model ="),
    ('"dma.txt"', '"dma.txt"\ncolumns = [1, 1.5, 2]', "columns must be three different names or"),
    ('"dma.txt"', '"dma.txt"\ncolumns = [0, 1, 2]', "columns, channels and sheets are counted"),
    ('"dma.txt"', '"dma.txt"\ncolumns = { loss = 0 }', "columns, channels and sheets are counted"),
    ('"dma.txt"', '"dma.txt"\ncolumns = { los = 3 }', "in columns los; did you mean loss?"),
    ('"dma.txt"', '"dma.txt"\ncolumns = 3', "columns = 3: expected three names or numbers from 1"),
    ('"dma.txt"', '"dma.txt"\nheader = -1', "header = -1: expected a whole number, at least 0"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), WRONG)
def test_wrong_case_is_one_sentence(tmp_path: Path, old: str, new: str, words: str) -> None:
    message = refusal(read_case_file, tmp_path, GOOD, old, new)
    assert words in message
    assert message.startswith(f"{tmp_path / 'case.toml'}: ")


ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4) | st.dates(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner),
    max_leaves=4,
)
KEYS = [
    (table, key)
    for table, model in (("surface", SurfaceTable), ("rubber", RubberSource), ("load", LoadTable))
    for key in model.model_fields
] + [("solver", key) for key in SolverTable.model_fields]


def complaint(tables: dict[str, Any]) -> str:
    try:
        validate(CaseTables, tables, "here")
    except InputError as error:
        return str(error)
    return ""


@given(st.sampled_from(KEYS), ANYTHING)
@settings(max_examples=150, deadline=None, derandomize=True)
def test_no_value_gets_anything_but_a_sentence_of_ours(place: tuple[str, str], value: Any) -> None:
    tables = {"solver": {}, **tomllib.loads(GOOD)}
    tables[place[0]][place[1]] = value
    said = complaint(tables)
    assert said == "" or (said.startswith("here: ") and "Input should" not in said)
    assert "\n" not in said


@pytest.mark.parametrize("source", ['file = "dma.txt"', 'name = "styrene_butadiene"'])
def test_a_case_names_a_strain_energy(tmp_path: Path, source: str) -> None:
    text = GOOD.replace('file = "dma.txt"', source)
    assert read_case_file(written(tmp_path, text)).case.rubber.strain_energy == NeoHookean()
    stated = source + '\nstrain_energy = { kind = "yeoh", second = -0.1, third = 0.02 }'
    case = read_case_file(written(tmp_path, text.replace(source, stated))).case
    assert case.rubber.strain_energy == Yeoh(-0.1, 0.02)


def test_the_rubber_of_a_case_has_its_strain_energy(tmp_path: Path) -> None:
    rows = [f"{10.0**i} {2 + i} {1 + 0.1 * i}" for i in range(6)]
    (tmp_path / "dma.txt").write_text("\n".join(["f (Hz)  E' (MPa)  E'' (MPa)", *rows]))
    for source in ({"file": "dma.txt"}, {"name": "styrene_butadiene"}):
        made = {
            law: prepare_rubber(RubberSource(**source, strain_energy=law), tmp_path.joinpath).rubber
            for law in (NeoHookean(), Yeoh(-0.1, 0.02))
        }
        assert all(rubber.strain_energy == law for law, rubber in made.items())
        plain, other = (rubber.to_dict() | {"strain_energy": 0} for rubber in made.values())
        assert plain == other


NO_TOML = [
    ("[load]", "[load", r"is not valid TOML: .*line 7"),
    ('"dma.txt"', r'"C:\users\dma.txt"', "a path is written with / or in 'single"),
    ('"dma.txt"', r'"data\dma.txt"', "a path is written with / or in 'single"),
    ('"300 mm/s"', "0.3 m/s", 'a number with its unit stands in "quotation marks'),
    ('"300 mm/s"', "0,3", "the decimal sign is the point"),
    (GOOD, "# Straße\n", "it is not UTF-8 text"),
]


@pytest.mark.parametrize(("old", "new", "words"), NO_TOML)
def test_text_that_is_no_toml_is_named(tmp_path: Path, old: str, new: str, words: str) -> None:
    path = tmp_path / "case.toml"
    path.write_bytes(GOOD.replace(old, new).encode("latin-1"))
    with pytest.raises(FileError, match=rf"case\.toml .*{words}"):
        read_case_file(path)


def test_a_case_that_is_not_there_or_a_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"case file .*nowhere\.toml does not exist"):
        read_case_file(tmp_path / "nowhere.toml")
    with pytest.raises(FileError, match=r"case file .* cannot be read: Is a directory"):
        read_case_file(tmp_path)


def test_shipped_case_is_valid_and_its_files_are_there() -> None:
    shipped = EXAMPLES / "road_and_tread" / "case.toml"
    file = read_case_file(shipped)
    surface, rubber = file.case.surface, file.case.rubber
    assert len(surface.files or []) == 2
    assert rubber.filled
    roles = [role for role, _ in file.case.named_files()]
    assert roles == ["surface", "surface", "rubber", "rubber", "conditions"]
    assert all(file.resolve(name).is_file() for _, name in file.case.named_files())
    assert file.case.load.pressure == 3e5
    assert file.case.load.speed == 0.3
    assert (surface.scales or 0) >= 8
