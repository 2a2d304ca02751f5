"""The list of keys is the whole of what a case file may say, each with words and a chapter."""

from dataclasses import fields
from typing import get_args

from pydantic import BaseModel
from typer.testing import CliRunner

from gripscale.case_file import CaseTables
from gripscale.case_file.keys import sections
from gripscale.case_file.schema import Reading, table_of
from gripscale.cli import app
from gripscale.rubber.strain_energy import STRAIN_ENERGIES
from tests.samples import DOCS


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
        assert (DOCS / section.chapter).is_file(), section.title
        for key in section.keys:
            place = f"{section.title} {key.name}"
            assert key.meaning.endswith("."), place
            assert key.takes != "a value", place


def test_the_command_prints_one_table_with_what_belongs_to_it():
    environment = {"COLUMNS": "120", "NO_COLOR": "1", "TERM": "dumb"}
    some = CliRunner().invoke(app, ["keys", "conditions"], env=environment)
    assert "[conditions.heat]" in some.output
    assert "[rubber]" not in some.output
    wrong = CliRunner().invoke(app, ["keys", "tyre"], env=environment)
    assert wrong.exit_code == 2
    assert "section must be one of surface, surface.sines, rubber" in wrong.stderr
