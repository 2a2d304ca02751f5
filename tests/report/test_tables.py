"""Tables for people and flat tables of a command: numbers, units, widths, doubts."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from rich.console import Console

from gripscale.chain import ChainResult
from gripscale.core.finding import doubt, to_json
from gripscale.core.status import Status
from gripscale.io.table import Column, Table, as_text, percent, significant
from gripscale.model import TOTALS, Load, predicted_answer
from gripscale.questions.chain.page import prediction_table, totals
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.result_json import summary_table
from gripscale.report.elements import with_code
from gripscale.rubber import Rubber
from gripscale.wave import ScaleResult
from tests.samples import THREE_SINES as SINES


class Spring(Rubber):
    """A rubber with E* = 4 MPa + 3 MPa i at any frequency, so that |E*| is 5 MPa."""

    def complex_modulus(self, omega):
        return np.full(np.shape(omega), 4e6 + 3e6j)


RUBBER = Spring(5e6, [1e6], [1.0], valid_band=(1.0, 2 * np.pi * 100.0))


def wave(i, speed, status="converged"):
    """Return one of three waves with powers of two in contact and friction."""
    friction = 0.125 * 2**i if speed > 0.0 else 0.0
    return ScaleResult(
        wavelength=SINES.wavelength[i],
        amplitude=SINES.amplitude[i],
        pressure_received=[3e5, 6e5, 2.4e6][i],
        speed=speed,
        load_time=1.0,
        contact_fraction=0.5 ** (i + 1),
        friction=friction,
        friction_from_dissipation=0.75 * friction,
        status=Status(status),
        newton_iterations=5 + i,
        residual=1e-10,
        min_stretch=0.5,
        max_stretch=1.5,
        x=np.linspace(-0.5, 0.5, 4) * SINES.wavelength[i],
        pressure=np.full(4, 3e5),
        rubber=RUBBER,
    )


def solved(speed=0.25, statuses=("converged",) * 3):
    waves = [wave(i, speed, status) for i, status in enumerate(statuses)]
    return ChainResult(RUBBER, SINES, Load(3e5, speed, 0.1), waves, 3).to_dataset()


def row(text, wave):
    return next(line.split() for line in text.splitlines() if line.split()[:1] == [str(wave)])


def test_a_wave_fills_its_row():
    text = as_text(prediction_table(solved(), "Dynamic"), width=120)
    assert row(text, 2) == [
        *("2", "4.00", "0.500", "0.785", "0.600", "5.00", "0.750*"),
        *("0.250", "0.125", "0.250", "0.375", "0.188", "0.50-1.50", "6", "converged"),
    ]
    assert "3 waves: real contact area A_r/A_0 = 0.0156, friction mu = 0.875" in text
    assert "(0.656 from dissipation)" in text
    assert "at most 25.00% apart" in text
    # harmonics 2, 4, 8 of 0.25 m/s over 16, 4, 1 mm: 31, 250, 2000 Hz; 6/7 of the friction
    sentence = (
        "2 of 3 waves, 85.7 % of the friction, lie up to 1.3 decades above the measured band."
    )
    assert sentence in " ".join(text.split())
    assert text.count("beyond the measured") == 1


def test_nothing_at_rest_has_friction():
    text = as_text(prediction_table(solved(speed=0.0), "Static"), width=120)
    assert row(text, 1)[6] == "-"
    assert row(text, 1)[9:12] == ["-", "-", "-"]
    assert "no friction at rest" in text


def test_failed_wave_has_no_totals():
    failed = solved(statuses=("converged", "iteration limit"))
    assert totals(failed) == "No totals: wave 2 did not converge (iteration limit)."
    assert "iteration limit" in as_text(prediction_table(failed, "Dynamic"), width=100)
    reached = failed.assign(load_reached=("scale", [1.0, 0.4]))
    assert totals(reached).endswith("(iteration limit at 40 % of the pressure).")


@pytest.mark.parametrize("width", [80, 100])
def test_long_status_is_wrapped_not_cut_off(width):
    status = "active set not settled after 200 iterations, and the load step was cut 14 times"
    failed = solved(statuses=("converged", "iteration limit"))
    failed["status"].values[1] = status
    text = as_text(prediction_table(failed, "Dynamic"), width=width)
    table = text[: text.index("No totals")]
    assert set(status.split()) <= set(table.split())
    assert max(map(len, table.splitlines())) <= width


def test_model_without_waves_shows_its_totals():
    numbers = dict(zip(TOTALS, (0.0123, 0.456, 0.451), strict=True))
    load = Load(3e5, 0.3, 0.1)
    data = predicted_answer(xr.Dataset(), numbers, "converged", "toy", load)
    sentence = "real contact area A_r/A_0 = 0.0123, friction mu = 0.456 (0.451 from dissipation)."
    assert as_text(prediction_table(data, "Toy")) == f"Toy\n{sentence}\n"
    failed = predicted_answer(
        xr.Dataset(), dict.fromkeys(TOTALS, np.nan), "no contact", "toy", load
    )
    assert totals(failed) == "No totals: no contact."


def test_brackets_are_text_not_markup():
    assert as_text("lag [mm], [bold]", "x") == "lag [mm], [bold]\nx\n"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.079281, "0.0793"),
        (26.99, "27.0"),
        (4545.0, "4545"),
        (1.5e-7, "1.50e-07"),
        (2.5e9, "2.50e+09"),
        (float("nan"), "-"),
        (float("inf"), "inf"),
    ],
)
def test_significant_digits(value, text):
    assert significant(value) == text


def test_loads_are_in_the_units_of_the_case():
    """Pressures of 3, 6 and 24 bar at 0.25 m/s, that is 0.9 km/h."""
    data = solved().assign_attrs(display_units='{"pressure": "bar", "speed": "km/h"}')
    table = as_text(prediction_table(data, ""), width=120)
    assert [row(table, wave)[4] for wave in (1, 2, 3)] == ["3.00", "6.00", "24.0"]
    units = next(line.split() for line in table.splitlines() if "2πA/λ" in line)
    assert units[4:6] == ["bar", "MPa"]
    assert PredictionView(data).title == "Dynamic, 0.9 km/h"


PRESSURE = Column("pressure", np.array([3e5, math.nan]), "p", "bar", 1e5, group="load")
RANGE = Column("range", np.array([[-0.1, 0.2], [0.3, math.nan]]), group="result", bad=[True, False])
SHARE = Column("share", [0.25, math.inf], format=percent, marks=["*", ""], group="result")
TABLE = Table(
    "loads",
    [Column("model", ["<b>chain</b>", "direct"]), PRESSURE, RANGE, SHARE],
    "Loads & ranges",
    ["A note."],
    strong=[1],
)


def test_terminal_shows_groups_units_and_marks():
    lines = as_text(TABLE, width=80).splitlines()
    assert lines[0] == "Loads & ranges"
    assert lines[1].split() == ["load", "result"]
    assert lines[2].split() == ["p"]
    assert lines[3].split() == ["model", "bar", "range", "share"]
    assert lines[5].split() == ["<b>chain</b>", "3.00", "-0.100", "to", "0.200", "25", "%*"]
    assert lines[6].split() == ["direct", "-", "-", "∞"]
    assert lines[5].index("%") == lines[6].index("∞"), "digits stand below digits"
    assert lines[-1] == "A note."


def test_a_table_that_is_too_wide_is_divided_between_groups():
    lines = as_text(TABLE, width=38).splitlines()
    heads = [line.split() for line in lines if line.startswith("model")]
    assert heads == [["model", "bar"], ["model", "range", "share"]]
    assert max(map(len, lines)) <= 38


def test_a_table_without_groups_is_divided_between_columns():
    model = Column("model", ["chain", "direct"])
    parts = [Column(f"part {i}", np.array([1.0, 2.0])) for i in range(8)]
    lines = as_text(Table("parts", [model, *parts]), width=30).splitlines()
    heads = [line for line in lines if line.startswith("model")]
    assert len(heads) == 3
    assert " ".join(heads).count("part") == 8
    assert max(map(len, lines)) <= 30


def test_what_must_not_be_trusted_is_red():
    console = Console(width=80, record=True, force_terminal=True, color_system="standard")
    with console.capture() as capture:
        console.print(TABLE)
    red = [line for line in capture.get().splitlines() if "\x1b[1;31m" in line]
    assert len(red) == 1
    assert "-0.100 to 0.200" in red[0]


def test_a_page_escapes_texts_and_sets_minus_signs():
    page = TABLE.__html__()
    assert "&lt;b&gt;chain&lt;/b&gt;" in page
    assert "<b>" not in page
    assert "−0.100 to 0.200" in page
    assert page.count(' bad"') == 1
    assert '<td class="">–</td>' in page
    assert '<th scope="colgroup" colspan="2">result</th>' in page
    assert page.count('<tr class="strong">') == 1


def test_a_long_heading_breaks_into_few_lines_on_a_narrow_page():
    """A heading of many words would be one word a line where a table is wider than the page."""
    long = "low end of the 90 % interval, over that of the first, answer of the friction"
    page = Table("t", [Column("low", np.array([1.0]), long)]).__html__()
    head = re.search(r'<th scope="col" class="">(low[^<]*)</th>', page)
    assert " ".join(head[1].split()) == long
    assert len(head[1].split(" ")) <= 6


def test_commands_of_a_text_are_code_and_markup_is_not():
    text, page = "<b> is; `gripscale run` runs", "&lt;b&gt; is; <code>gripscale run</code> runs"
    assert with_code(text) == page
    assert f'<p class="note">{page}</p>' in replace(TABLE, notes=[text]).__html__()


UNIT = {"units": "1"}


def study(**attributes):
    """A study over two speeds and two rubbers, of which one prediction failed."""
    place = ("speed", "rubber")
    status = np.array([["converged", "wave 2 failed"], ["converged", "converged"]], dtype=object)
    return xr.Dataset(
        {
            "prediction_status": (place, status),
            "prediction_key": (place, np.array([["a", "b"], ["c", "d"]], dtype=object)),
            "answer_friction": (place, [[0.2, math.nan], [0.4, 0.8]], UNIT),
            "answer_friction_low": (place, [[0.1, math.nan], [0.2, 0.3]], UNIT),
            "upper_height": ((), 1.7, UNIT),
            "hardness": ("rubber", [60.0, 70.0], {"units": "Pa"}),
            "friction": ((*place, "scale"), np.zeros((2, 2, 3)), UNIT),
        },
        {"speed": ("speed", [0.1, 1.0], {"units": "m/s"}), "rubber": ["soft", "hard"]},
        {
            "model": "direct",
            "nominal_speed": 0.3,
            "nominal_pressure": np.float64(3e5),
            "case_file": "case.toml",
            **attributes,
        },
    )


def rows(result):
    table = summary_table(result)
    titles = [f"{c.name} [{c.unit.replace('1', '-')}]" if c.unit else c.name for c in table.columns]
    values = [[None if x != x else x for x in column.values] for column in table.columns]
    return [dict(zip(titles, row, strict=True)) for row in zip(*values, strict=True)]


def test_a_row_for_each_point_of_a_study():
    first, failed, _, last = rows(study())
    assert (first["speed [m/s]"], first["rubber"]) == (0.1, "soft")
    assert (failed["speed [m/s]"], failed["rubber"]) == (0.1, "hard")
    assert failed["answer_friction [-]"] is None
    assert failed["prediction_status"] == "wave 2 failed"
    assert last["answer_friction [-]"] == 0.8
    assert last["answer_friction_low [-]"] == 0.3
    assert [row["hardness [Pa]"] for row in (first, failed)] == [60.0, 70.0]
    assert first["upper_height [-]"] == last["upper_height [-]"] == 1.7
    assert first["nominal_pressure [Pa]"] == 3e5
    assert first["case_file"] == "case.toml"
    assert list(first)[:4] == ["speed [m/s]", "rubber", "model", "answer_friction [-]"]
    # what is varied, or of no answer
    assert not {"nominal_speed [m/s]", "prediction_key", "friction [-]"} & set(first)


def test_doubts_stand_in_each_row():
    doubted = rows(study(input_doubts=to_json([doubt("The unit of heights looks wrong.")])))
    assert {row["not_to_rely_on"] for row in doubted} == {"The unit of heights looks wrong."}
    assert "not_to_rely_on" not in rows(study())[0]


def test_models_of_a_comparison_and_points_of_a_design_are_rows():
    words = np.array(["converged", "none"], dtype=object)
    comparison = xr.Dataset({"status": ("model", words)}, {"model": ["chain", "direct"]})
    assert [row["model"] for row in rows(comparison)] == ["chain", "direct"]
    design = xr.Dataset({"gain": ("point", [0.1, 0.2], UNIT), "rolling": ("point", [1.0, 1.1])})
    assert [(row["point"], row["gain [-]"]) for row in rows(design)] == [(0, 0.1), (1, 0.2)]


def test_the_answer_stands_beside_the_direct_contact():
    words = np.array(["converged", "converged"], dtype=object)
    comparison = xr.Dataset(
        {
            "status": ("model", words),
            "answer_friction": ((), 0.2, UNIT),
            "answer_friction_low": ((), 0.1, UNIT),
            "cutoff_wavelength": ((), 1e-4, {"units": "m"}),
        },
        {"model": ["chain", "direct"]},
    )
    chain, direct = rows(comparison)
    assert (chain["answer_friction [-]"], direct["answer_friction [-]"]) == (None, 0.2)
    assert chain["answer_friction_low [-]"] is None
    assert chain["cutoff_wavelength [m]"] == direct["cutoff_wavelength [m]"] == 1e-4


def test_rubber_at_rest_has_no_friction():
    results = (
        xr.Dataset({"prediction_status": "converged", "nominal_speed": v, "total_friction": 0.0})
        for v in (1.0, 0.0)
    )
    assert [row["total_friction"] for result in results for row in rows(result)] == [0.0, None]
