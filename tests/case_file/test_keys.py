"""The list of keys and the JSON Schema are the whole of what a case file may say."""

import json
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import get_args

import pytest
from pydantic import BaseModel

import gripscale as gs
from gripscale.case_file import CaseTables
from gripscale.case_file.examples import EXAMPLES, write_example
from gripscale.case_file.keys import SCHEMA_FILE, SCHEMA_LINE, case_schema, sections
from gripscale.case_file.schema import Reading, table_of
from gripscale.rubber.strain_energy import STRAIN_ENERGIES
from tests.samples import DOCS
from tests.samples import EXAMPLES as EXAMPLE_FILES


def nested(annotation, metadata=()):
    """Yield the tables inside an annotation; where a kind chooses, all it chooses from."""
    for one in metadata:
        if isinstance(one, Reading):
            yield from map(table_of, one.laws.values())
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield from () if annotation.__subclasses__() else (annotation,)
    metadata = getattr(annotation, "__metadata__", ())
    for part in get_args(annotation):
        yield from nested(part, metadata)


def read_by(table, name):
    """Yield name, kind and keys of every table that a case file may hold."""
    yield name, "", set(table.model_fields)
    for key, field in table.model_fields.items():
        for inner in nested(field.annotation, field.metadata):
            yield from read_by(inner, f"{name}.{key}".removeprefix("."))


def test_every_key_the_reader_knows_is_listed():
    listed = {(one.name, frozenset(key.name for key in one.keys)) for one in sections()}
    known = {(name, frozenset(keys)) for name, _, keys in read_by(CaseTables, "") if name}
    assert len(known) >= 14
    assert known <= listed
    for kind, law in STRAIN_ENERGIES.items():
        names = frozenset(["kind", *(field.name for field in fields(law))])
        assert ("rubber.strain_energy", names) in listed, kind


def test_every_key_says_what_it_takes_and_means_and_where_to_read_on():
    for section in sections():
        assert section.about, section.title
        for key in section.keys:
            place = f"{section.title} {key.name}"
            assert key.meaning.endswith("."), place
            assert key.takes != "a value", place
            assert (DOCS / key.chapter).is_file(), place


def test_the_command_prints_one_table_with_what_belongs_to_it(shell):
    some = shell("keys", "conditions", columns=120)
    assert "[conditions.heat]" in some.output
    assert "[rubber]" not in some.output
    wrong = shell("keys", "tyre", columns=120, code=2)
    assert "section must be one of surface, surface.sines, rubber" in wrong.stderr


SCHEMA = json.loads(case_schema())
KINDS = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
}


def is_of(kind, value):
    """Return whether a value is of a type of JSON Schema: true is no number there."""
    return isinstance(value, KINDS[kind]) and (kind == "boolean") == isinstance(value, bool)


def complaints(value, schema, at=""):
    """Yield where a value is not as a schema with the keywords used here wants it."""
    if "anyOf" in schema and all(list(complaints(value, part)) for part in schema["anyOf"]):
        yield at
    if value not in schema.get("enum", [schema.get("const", value)]):
        yield at
    kinds = schema.get("type", [*KINDS])
    allowed = [kinds] if isinstance(kinds, str) else kinds
    if not any(is_of(kind, value) for kind in allowed):
        yield at
    elif isinstance(value, dict):
        properties = schema.get("properties", {})
        yield from (f"{at}.{key}" for key in schema.get("required", ()) if key not in value)
        for key, item in value.items():
            if key in properties:
                yield from complaints(item, properties[key], f"{at}.{key}")
            elif not schema.get("additionalProperties", True):
                yield f"{at}.{key}"
    elif isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", 1e9):
            yield at
        for item in value:
            yield from complaints(item, schema.get("items", {}), f"{at}[]")
    elif isinstance(value, float | int) and not isinstance(value, bool):
        least, above = schema.get("minimum", -1e99), schema.get("exclusiveMinimum", -1e99)
        most, below = schema.get("maximum", 1e99), schema.get("exclusiveMaximum", 1e99)
        if not (least <= value <= most and above < value < below):
            yield at


CASES = sorted(EXAMPLE_FILES.rglob("*.toml"))


@pytest.mark.parametrize("path", CASES, ids=lambda path: str(path.relative_to(EXAMPLE_FILES)))
def test_shipped_cases_are_as_the_schema_wants_them(path):
    assert list(complaints(tomllib.loads(path.read_text()), SCHEMA)) == []


GOOD = """
[surface]
map = "a.al3d"
step = ["10 um", "10 um"]
cut_off = { rms_slope = 1.3 }
[rubber]
file = ["a.txt", "b.txt"]
columns = [1, 3, 4]
shift = { kind = "wlf", c1 = 8.86, c2 = "101.6 K" }
[load]
pressure = "3 bar"
speed = 1
footprint = 0.1
load_time = "infinite"
[conditions]
temperature = "60 C"
[conditions.softening]
kind = "kraus"
storage_ratio = 0.3
loss_ratio = 0.15
critical_strain = "2 %"
measured_at = 1e-3
deformation = "shear"
[uncertainty.ranges]
pressure = "3 %"
bulk_modulus = ["1 GPa", "3 GPa"]
"""


def test_keys_of_several_kinds_of_values_are_allowed():
    assert list(complaints(tomllib.loads(GOOD), SCHEMA)) == []


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ('map = "a.al3d"', 'maps = "a.al3d"', ".surface.maps"),
        ('pressure = "3 bar"', "", ".load.pressure"),
        ("speed = 1", "speed = true", ".load.speed"),
        ('temperature = "60 C"', "temperature = 60", ".conditions.temperature"),
        ('kind = "wlf"', 'kind = "wlg"', ".rubber.shift"),
        ("c1 = 8.86", "c1 = -1", ".rubber.shift"),
        ("[load]", '[solver]\nmodel = "whole"\n[load]', ".solver.model"),
        ("[load]", "[solver]\ncolumns = 2\n[load]", ".solver.columns"),
    ],
)
def test_what_is_wrong_is_marked(old, new, place):
    assert old in GOOD
    assert place in list(complaints(tomllib.loads(GOOD.replace(old, new, 1)), SCHEMA))


def tables(schema, path=""):
    """Yield all tables of the schema by their names, of kinds of a law each one."""
    for part in (schema, *schema.get("anyOf", ()), schema.get("items", {})):
        if "properties" in part:
            yield path, part["properties"]
            for key, inner in part["properties"].items():
                yield from tables(inner, f"{path}.{key}".strip("."))


def test_every_key_has_its_meaning():
    of_schema = {
        (name, frozenset(properties)): properties for name, properties in tables(SCHEMA) if name
    }
    for section in sections():
        properties = of_schema[section.name, frozenset(key.name for key in section.keys)]
        for key in section.keys:
            assert properties[key.name]["description"].startswith(key.meaning), section.title


def test_the_command_prints_it(shell):
    assert json.loads(shell("keys", "--schema").stdout) == SCHEMA


def test_written_cases_refer_to_the_schema_beside_them(shell, tmp_path):
    assert "synthetic" in EXAMPLES
    case = write_example(tmp_path / "example", "synthetic")[0]
    made = tmp_path / "new" / "case.toml"
    shell("new", case.with_name("road.txt"), "styrene_butadiene", "-o", made)
    saved = gs.read_case(made).save(tmp_path / "copy" / "case.toml")
    rubber = gs.Rubber(6e6, [2e6], [1e-2])
    in_python = gs.Case(gs.SineStack([1e-3], [1e-4]), rubber, pressure=3e5, speed=1, footprint=0.1)
    by_hand = in_python.save(tmp_path / "python" / "case.toml")
    for path in (case, made, saved, by_hand):
        text = Path(path).read_text()
        assert text.startswith(SCHEMA_LINE), path
        assert json.loads(Path(path).with_name(SCHEMA_FILE).read_text()) == SCHEMA
        assert list(complaints(tomllib.loads(text), SCHEMA)) == []
