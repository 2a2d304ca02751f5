"""What a case file may say, and the one sentence for each way of getting it wrong."""

import datetime
import math
import re
import tomllib
from pathlib import Path

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
from gripscale.case_file.keys import sections
from gripscale.core.errors import FileError, InputError
from gripscale.rubber import NeoHookean, Yeoh
from gripscale.surface import fit_sines, height_difference, self_affine_profile
from tests.case_file.cases import refusal, written
from tests.samples import DOCS

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


def test_quantities_become_si_and_defaults_are_filled_in(tmp_path):
    file = read_case_file(written(tmp_path, GOOD))
    load = file.case.load
    assert (load.pressure, load.speed, load.footprint) == (3e5, 0.3, 0.1)
    assert load.load_time == "passage"
    assert file.case.solver.options() == {}
    assert file.text == GOOD


def test_the_closer_chain_of_the_documentation_is_a_case(tmp_path):
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


def test_prepared_with_what_the_case_says(tmp_path):
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


def test_paths_start_at_the_case_file(tmp_path):
    file = read_case_file(written(tmp_path, GOOD))
    assert file.resolve("../road.dat") == tmp_path.parent / "road.dat"
    assert file.resolve("/elsewhere/road.dat") == Path("/elsewhere/road.dat")


def test_only_stated_solver_options_are_passed_on(tmp_path):
    file = read_case_file(written(tmp_path, GOOD + "[solver]\ncolumns = 64\ndepth = 2\n"))
    assert file.case.solver.options() == {"columns": 64, "depth": 2.0}


@pytest.mark.parametrize(
    ("stated", "seconds"), [('"infinite"', math.inf), ('"5 ms"', 5e-3), ("2.5", 2.5)]
)
def test_load_time(tmp_path, stated, seconds):
    file = read_case_file(written(tmp_path, GOOD + f"load_time = {stated}\n"))
    assert file.case.load.load_time == seconds


WRONG = [
    ("[load]", "[lod]", "unknown key [lod]; did you mean load?"),
    ("[load]", "[load]\nstatic = true", "unknown key [load] static; it is gone: speed = 0 solves"),
    ("scales = 8", "xyzzy = 8", "unknown key [surface] xyzzy; expected one of files,"),
    ('"3 bar"', '"3 mm"', "unknown unit 'mm'; expected one of Pa, kPa, psi, bar"),
    ('"3 bar"', '"3"', "[load] pressure = '3': the unit is missing"),
    ('"3 bar"', '"bar"', "[load] pressure = 'bar': expected a pressure such as \"3 bar\""),
    ('"3 bar"', '"inf bar"', "expected a finite pressure"),
    ('"300 mm/s"', '"-1 m/s"', "[load] speed = '-1 m/s': expected zero or a positive value"),
    ("footprint = 0.1", "", '[load] footprint is missing; expected a length such as "1'),
    ('speed = "300 mm/s"', 'speed = 1\nload_time = "soon"',
     'load_time must be "passage", "infinite" or a time such as "1 s"; got'),
    ("scales = 8", "", "[surface]: expected scales (number of waves), smallest_wavelength"),
    ("scales = 8", 'smallest_wavelength = "1 mm"\ncut_off = "1 mm"',
     "[surface]: expected either smallest_wavelength (the last wave) or cut_off"),
    ("scales = 8", 'scales = 8\ncrop = ["1 mm"]',
     "[surface] crop = ['1 mm']: expected a list of 2, each"),
    ("scales = 8", "scales = 8\ncrop = [2, 1]",
     "crop runs from 2000 mm to 1000 mm; expected its start"),
    ("scales = 8", 'scales = 8\ncrop = [0, "1 ell"]', "[surface] crop[1] = '1 ell': unknown unit"),
    ("scales = 8", "scales = 8\nspike_slope = inf", "spike_slope = inf: expected a finite number"),
    ("scales = 8", 'scales = 8\nphases = "random"',
     "phases belongs to a surface from spectrum"),
    ('["road.dat"]', "[]", "[surface] files = []: expected a list of at least 1, each a text"),
    ('["road.dat"]', '"road.dat"',
     "[surface] files = 'road.dat': expected a list of at least 1, each a text"),
    ('files = ["road.dat"]', "",
     "[surface]: expected either files (measured profiles), map (a measured map), spectrum"),
    ('["road.dat"]', '["road.dat"]\nspectrum = "psd.csv"', "[surface]: expected either files"),
    ('files = ["road.dat"]', 'map = "a.npy"\ndetrend = "mean"',
     "detrend belongs to a surface from files"),
    ('files = ["road.dat"]', 'map = "a.npy"\ncrop_across = ["2 mm", "1 mm"]',
     "crop_across runs from 2 mm to 1 mm"),
    *(('files = ["road.dat"]', f'spectrum = "psd.csv"\n{key} = {value}',
       f"{key} belongs to a surface from")
      for key, value in (("crop", '[0, "1 m"]'), ("z_unit", '"mm"'), ("max_lag", '"1 mm"'))),
    ('files = ["road.dat"]\nscales = 8', "[[surface.sines]]\nwavelength = 1e-3\namplitud = 1e-4",
     "unknown key [surface] sines[0].amplitud; did you mean amplitude?"),
    ('files = ["road.dat"]\nscales = 8', "[[surface.sines]]\nwavelength = 1e-3\namplitude = 0",
     "[surface] sines[0].amplitude = 0: expected a value greater than zero"),
    ('files = ["road.dat"]\nscales = 8',
     "[[surface.sines]]\nwavelength = 1e-3\namplitude = 1e-4\n" * 2,
     "expected sines in order of falling wavelength"),
    ('files = ["road.dat"]\nscales = 8',
     'cut_off = "instrument"\n[[surface.sines]]\nwavelength = 1e-3\namplitude = 1e-4',
     "cut_off belongs to a measured surface"),
    ('file = "dma.txt"', "", "[rubber]: expected either file (a master curve) or name"),
    ('file = "dma.txt"', 'name = "styrene_butadiene"\nterms = 3',
     "terms belongs to a measured file, not to a named rubber"),
    ("[load]", '[solver]\nmodel = "half_plane"\ncolumns = 64\n[load]',
     '[solver]: columns is not an option of model = "half_plane"'),
    ("[load]", "[[load]]", "expected a table"),
    (GOOD, "", "an empty case; expected at least [surface], [rubber] and [load], as"),
    (GOOD, "[output]", "[surface] is missing; expected a table with files,"),
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
    ('"dma.txt"', '"dma.txt"\ncolumns = { loss = 0 }', "columns, channels and sheets are counted"),
    ('"dma.txt"', '"dma.txt"\ncolumns = { los = 3 }', "in columns los; did you mean loss?"),
    ('"dma.txt"', '"dma.txt"\ncolumns = 3', "columns = 3: expected three names or numbers from 1"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), WRONG)
def test_wrong_case_is_one_sentence(tmp_path, old, new, words):
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


def complaint(tables):
    try:
        validate(CaseTables, tables, "here")
    except InputError as error:
        return str(error)
    return ""


@given(st.sampled_from(KEYS), ANYTHING)
@settings(max_examples=150, deadline=None, derandomize=True)
def test_no_value_gets_anything_but_a_sentence_of_ours(place, value):
    tables = {"solver": {}, **tomllib.loads(GOOD)}
    tables[place[0]][place[1]] = value
    said = complaint(tables)
    assert said == "" or (said.startswith("here: ") and "Input should" not in said)
    assert "\n" not in said


PLAIN = [
    (section.name, key)
    for section in sections()
    if section.name in {*CaseTables.model_fields} - {"compare"}  # a law of its own
    for key in section.keys
]


def beyond(key):
    """Return values just outside of what the schema of a key allows."""
    schema = key.schema
    step = 1 if schema.get("type") == "integer" else 1e-9
    yield datetime.date(2020, 1, 1)
    if "enum" in schema or "const" in schema:
        yield "xyzzy"
    if step == 1:
        yield 8.5
    if "multipleOf" in schema:
        yield schema["minimum"] + 1
    for limit, outside in (
        ("minimum", -step), ("maximum", step), ("exclusiveMinimum", 0), ("exclusiveMaximum", 0)
    ):  # fmt: skip
        if limit in schema:
            yield schema[limit] + outside


@pytest.mark.parametrize(("table", "key"), PLAIN, ids=[f"{at}.{key.name}" for at, key in PLAIN])
def test_each_key_refuses_what_its_schema_does_and_its_neighbour(table, key):
    tables = {"solver": {}, **tomllib.loads(GOOD)}
    for value in beyond(key):
        said = complaint({**tables, table: tables.get(table, {}) | {key.name: value}})
        assert said.startswith(f"here: [{table}] {key.name} = {value!r}: ")
        assert said.endswith(f"expected {key.takes}") or isinstance(value, datetime.date)
    said = complaint({**tables, table: tables.get(table, {}) | {f"{key.name}x": 1}})
    assert f"unknown key [{table}] {key.name}x; did you mean {key.name}?" in said


@pytest.mark.parametrize("source", ['file = "dma.txt"', 'name = "styrene_butadiene"'])
def test_the_rubber_of_a_case_has_its_strain_energy(tmp_path, source):
    rows = [f"{10.0**i} {2 + i} {1 + 0.1 * i}" for i in range(6)]
    (tmp_path / "dma.txt").write_text("\n".join(["f (Hz)  E' (MPa)  E'' (MPa)", *rows]))
    made = {}
    for law, stated in (
        (NeoHookean(), ""),
        (Yeoh(-0.1, 0.02), '\nstrain_energy = { kind = "yeoh", second = -0.1, third = 0.02 }'),
    ):
        text = GOOD.replace('file = "dma.txt"', source + stated)
        file = read_case_file(written(tmp_path, text))
        made[law] = prepare_rubber(file.case.rubber, file.resolve).rubber
        assert made[law].strain_energy == law
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
def test_text_that_is_no_toml_is_named(tmp_path, old, new, words):
    path = tmp_path / "case.toml"
    path.write_bytes(GOOD.replace(old, new).encode("latin-1"))
    with pytest.raises(FileError, match=rf"case\.toml .*{words}"):
        read_case_file(path)


def test_a_case_that_is_not_there_or_a_folder_is_named(tmp_path):
    with pytest.raises(FileError, match=r"case file .*nowhere\.toml does not exist"):
        read_case_file(tmp_path / "nowhere.toml")
    with pytest.raises(FileError, match=r"case file .* cannot be read: Is a directory"):
        read_case_file(tmp_path)
