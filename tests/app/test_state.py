"""The text of the case is the state of the page: forms and text say the same, both ways."""

import re
import tomllib

import panel as pn
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripscale.app.case import (
    CaseProblem,
    CaseState,
    VisitFolder,
    case_tables,
    field_text,
    field_value,
    value_at,
    with_value,
)
from gripscale.app.case_panel import problem_pane
from gripscale.app.forms import field, table_form
from gripscale.app.input_tabs import load_tab, road_tab, rubber_tab
from gripscale.case_file import EXAMPLES
from gripscale.case_file.keys import sections
from gripscale.core.errors import InputError

from .conftest import CASE, validation_message

TEXTS = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=20)
NUMBERS = st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False)
VALUES = st.recursive(
    st.booleans() | NUMBERS | TEXTS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3),
    max_leaves=6,
)


@pytest.fixture
def state(tmp_path):
    state = CaseState(VisitFolder.new(tmp_path))
    state.set_text(CASE)
    return state


def fields(form):
    """Return the fields of a form by their names."""
    return {one.label.removesuffix(" *"): one for one in form.select(pn.widgets.Widget)}


@given(VALUES.filter(lambda value: not isinstance(value, str) or value.strip() == value != ""))
def test_a_field_shows_every_value_so_that_it_is_read_back(value):
    assert field_value(field_text(value)) == value


@given(VALUES)
def test_a_value_put_into_the_text_is_stated_there_and_nothing_else_changes(value):
    text = with_value(CASE, ("load", "speed"), value)
    assert value_at(text, ("load", "speed")) == value
    assert case_tables(with_value(text, ("load", "speed"), "0.3 m/s")) == case_tables(CASE)


def test_comments_stay_a_key_is_taken_out_and_a_missing_table_is_made():
    assert with_value(CASE, ("load", "speed"), "1 m/s") == CASE.replace('"0.3 m/s"', '"1 m/s"')
    time, density = ("load", "load_time"), ("conditions", "heat", "density")
    assert with_value(with_value(CASE, time, "1 s"), time, None) == CASE
    assert with_value(CASE, density, None) == CASE
    made = tomllib.loads(with_value(CASE, density, "1150 kg/m3"))["conditions"]
    assert made == {"heat": {"density": "1150 kg/m3"}}


def test_every_key_of_a_case_has_a_field_or_a_place_to_drop_its_file(state):
    state.set(("conditions", "heat"), {})
    load = ["load", "solver", "chain", "conditions", "conditions.heat"]
    for tab, names in ((road_tab, ["surface"]), (rubber_tab, ["rubber"]), (load_tab, load)):
        shown = fields(tab(state))
        wanted = {
            key.name.replace("_", " ") for s in sections() if s.name in names for key in s.keys
        }
        dropped = {"files", "map", "sines"} if tab is road_tab else {"file"}
        assert wanted - dropped <= set(shown), names


def test_a_kind_that_is_chosen_brings_its_keys(state):
    form = table_form(state, "conditions", ())
    laws = [section for section in sections() if section.name == "conditions.softening"]
    assert {law.kind for law in laws} == {"kraus", "table", "typical_tread"}
    for law in laws:
        fields(form)["softening"].value = law.kind
        assert state.get(("conditions", "softening")) == {"kind": law.kind}
        keys = {key.name.replace("_", " ") for key in law.keys} - {"kind"}
        assert keys <= set(fields(form)), law.kind
        needed = law.kind != "typical_tread"  # whose keys all have a default
        assert ("[conditions] softening" in validation_message(state)) == needed
    fields(form)["softening"].value = "none"
    assert state.get(("conditions", "softening")) == "none"  # switched off, for a filled rubber too
    fields(form)["softening"].value = "by default"
    assert state.get(("conditions", "softening")) is None
    assert validation_message(state).startswith("surface file")


def test_a_file_in_place_of_a_law_is_shown_and_can_be_taken_out(state):
    choice = fields(table_form(state, "rubber", ()))["shift"]
    state.set(("rubber", "shift"), "inputs/shift.csv")
    assert choice.value == "file inputs/shift.csv"
    choice.value = "none"
    assert state.get(("rubber", "shift")) is None
    assert choice.options[-1] != "file inputs/shift.csv"


def test_what_is_typed_is_in_the_text_and_what_is_in_the_text_is_shown(state):
    shown = fields(table_form(state, "load", ()))
    shown["speed"].value = "2 m/s"
    shown["pressure"].value = "4 MPa"
    typed = {"pressure": "4 MPa", "speed": "2 m/s"}
    assert case_tables(state.text)["load"] == typed | {"footprint": "100 mm"}
    assert shown["pressure"].value == "4 MPa"
    state.set_text(CASE)
    assert state.text == CASE
    assert [shown[name].value for name in ("speed", "pressure")] == ["0.3 m/s", "3 bar"]


def test_a_list_of_any_length_is_one_field(state):
    """A table of stresses has two speeds at least, not two at most."""
    found = {(each.name, each.kind): each for each in sections()}
    section = found["conditions.shear_stress", "table"]
    speed = next(key for key in section.keys if key.name == "speed")
    path = ("conditions", "shear_stress", "speed")
    state.set(path[:2], {"kind": "table", "speed": [0.01, 0.1, 1.0], "stress_at": [1e6, 2e6, 1e6]})
    widget = field(state, section, speed)
    assert field_value(widget.value) == [0.01, 0.1, 1.0]
    widget.value = "[0.01, 0.1, 2.0]"
    assert state.get(path) == [0.01, 0.1, 2.0]


def test_a_refusal_is_the_one_problem_of_the_case_until_it_is_cured(state):
    shown = [problem_pane(state), problem_pane(state, "surface"), problem_pane(state, "rubber")]

    def levels():
        return [re.findall(r'notice (\w+)"', "".join(e.object for e in pane)) for pane in shown]

    state.set_text(CASE.replace("../elsewhere/", ""))
    assert levels() == [["good"], [], []]
    with state.refusals("surface"):
        state.visit.store("road.png", b"\x89PNG\r\n")
    assert state.problem == CaseProblem(
        "surface", "road.png: expected a file with measured values; got a picture (PNG)"
    )
    assert levels() == [["error"], ["error"], []]
    with state.refusals("rubber"):
        pass
    assert levels() == [["error"], ["error"], []]
    with state.refusals("surface"):
        pass
    assert levels() == [["good"], [], []]
    state.set(("load", "speed"), "3 furlongs")
    assert levels() == [["error"], [], []]
    assert state.problem.table == "load"


def test_a_value_that_cannot_be_shown_stays_in_the_text(state):
    shown = fields(table_form(state, "surface", ()))
    text = CASE.replace("scales = 3", 'scales = 3\ndirection = "z"')
    state.set_text(text)
    assert state.text == text
    assert shown["direction"].value == 'by default: "x"'
    assert "direction = 'z'" in validation_message(state)


def test_each_example_fills_every_form_and_no_form_changes_it(state):
    """One after the other in the same forms: to build them takes most of the time."""
    tabs = [tab(state) for tab in (road_tab, rubber_tab, load_tab)]
    for name in EXAMPLES:
        state.set_text(state.example(name))
        assert validation_message(state) == "", name
        assert state.visit.case.read_text(encoding="utf-8") == state.text, name
        number = fields(tabs[2])["pressure"].value
        assert state.get(("load", "pressure")) == number, name


def test_a_case_is_opened_with_the_files_it_names(state, dropped):
    state.set_text(state.open(dropped))
    assert validation_message(state) == ""
    assert state.get(("surface", "files")) == ["inputs/road.txt"]
    assert state.text == CASE.replace("../elsewhere/road", "inputs/road").replace(
        '"dma', '"inputs/dma'
    )
    assert state.file().resolve("inputs/dma.txt").read_bytes() == dropped["dma.txt"]


def test_a_surface_and_a_rubber_dropped_together_make_a_case(state, dropped):
    state.set_text(state.open({name: dropped[name] for name in ("dma.txt", "road.txt")}))
    assert validation_message(state) == ""
    assert state.get(("surface", "files")) == ["inputs/road.txt"]
    assert state.get(("surface", "cut_off")) == "instrument"
    assert state.get(("rubber", "file")) == "inputs/dma.txt"
    assert "# Doubts, the most important first:" in state.text
    with pytest.raises(InputError, match="expected a file with a surface, too"):
        state.open({"dma.txt": dropped["dma.txt"]})


def test_two_cases_dropped_at_once_are_refused(state):
    with pytest.raises(InputError, match=r"2 of the dropped files end in \.toml"):
        state.open({"a.toml": b"", "b.TOML": b""})
    with pytest.raises(InputError, match=r"a\.toml cannot be read: it is not UTF-8 text"):
        state.open({"a.toml": b"\xff"})
    assert state.text == CASE


def test_a_text_that_is_no_toml_is_kept_and_said(state):
    state.set_text("[load\n")
    assert validation_message(state).startswith("case file case.toml is not valid TOML")
    state.set(("load", "speed"), 1.0)
    assert state.text == "[load\n"
    assert "not valid TOML" in validation_message(state)
