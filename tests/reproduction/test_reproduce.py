"""The reproduction, from the inputs to figures, data and judged statements."""

import json
import re
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from gripscale.case_file import write_example
from gripscale.charts.chart import Series
from gripscale.cli import app
from gripscale.core.errors import InputError
from gripscale.io import netcdf
from gripscale.reproduction.figures import TITLES, draw, tasks_of
from gripscale.reproduction.inputs import (
    COARSE,
    DENSE,
    FAST,
    FILLED_TREAD,
    PAPER_FACTORS,
    R60,
    ROAD_FILES,
    RUBBER_DATA,
    SPEED,
    read_inputs,
)
from gripscale.reproduction.judges import Evidence
from gripscale.reproduction.run import judged, reproduce_paper
from studies.paper_page import MADE
from tests.samples import ROOT


def test_inputs_are_the_stated_ones(inputs):
    assert list(inputs.stacks) == [COARSE, DENSE]
    assert list(inputs.stacks[DENSE]) == ["3.5/2.4", "3/2.2", "6/3"]
    assert [inputs.worst_fit(road) for road in (COARSE, DENSE)] == ["6/4.16", "6/3"]
    for stacks in inputs.stacks.values():
        for stack, (s_wavelength, _) in zip(stacks.values(), PAPER_FACTORS, strict=True):
            assert stack.s_wavelength == pytest.approx(s_wavelength)
            assert stack.wavelength[-1] >= 0.1e-3 * (1.0 - 1e-9)
        assert len({float(stack.wavelength[0]) for stack in stacks.values()}) == 1
        assert len({float(stack.amplitude[0]) for stack in stacks.values()}) == 1
    assert "synthetic" in inputs.surfaces[DENSE].source
    assert "not stated" in inputs.compounds[FILLED_TREAD].source
    assert "by this letter only" in inputs.compounds[R60].source


def test_resin_tread_has_its_loss_maximum_among_the_waves(inputs):
    rubber = inputs.compounds[R60].rubber
    assert rubber.reference_temperature == pytest.approx(273.15)
    omega = np.geomspace(1e-2, 1e12, 2000)
    highest = omega[int(rubber.loss_factor(omega).argmax())]
    first, *_, last = inputs.surfaces[COARSE].sines.wavelength
    for speed in (SPEED, FAST):
        assert last < 2.0 * np.pi * speed / highest < first
    # Fig. 2 has the measured rows at 0 C: half are within twice the rms error of the series, not
    # shifted they are off by a factor of two and more
    fit = inputs.compounds[R60].fit
    *_, points = [m for m in draw("fig2", inputs, {}).panels[0].marks if isinstance(m, Series)]
    x, y = (np.asarray(values) for values in (points.x, points.y))
    here = np.isfinite(x)
    off = rubber.complex_modulus(x[here]).real / y[here] / 1e6 - 1.0
    assert np.median(np.abs(off)) < 2.0 * fit.rms_storage


def test_no_chain_is_solved_twice(inputs):
    keys = [
        task.key
        for figure in TITLES
        for lines in tasks_of(figure, inputs).values()
        for task in lines.values()
    ]
    assert len(keys) == 53
    assert len(set(keys)) == 31


def test_docs_have_every_figure_and_statement(inputs):
    """The numbers of the page are those of the machine that made it; the statements are here."""
    page = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
    made = page[page.index(MADE) :]
    assert {f"paper_{figure}" for figure in TITLES} == set(re.findall(r"paper_fig\w+", made))
    statements = [s for name in ("fig3b", "fig4") for s in judged(name, Evidence(inputs, {}, {}))]
    assert len(statements) == 6
    for statement in statements:
        for text in (statement.criterion, statement.where, f"**{statement.verdict}**"):
            assert text in made


@pytest.mark.verification
def test_figure_with_chains_is_made_once_and_read_again(tmp_path, inputs):
    told = []
    statements = reproduce_paper(inputs, tmp_path, ["fig7b", "fig9b"], on_task=told.append)
    assert len(told) == 2
    assert [s.figure for s in statements] == ["fig7b", "fig9b"]
    assert all(s.holds for s in statements)
    for name in ("fig7b", "fig9b"):
        assert all((tmp_path / f"{name}.{kind}").stat().st_size > 5000 for kind in ("png", "pdf"))
        data = netcdf.load_dataset(tmp_path / f"{name}.nc")
        assert [data[f"y_{i}"].attrs["of"] for i in (1, 2)] == [COARSE, DENSE]
        assert (data.sizes["point_1"], data.sizes["point_2"]) == (8, 7)
        assert "synthetic" in data.attrs["surfaces"]
    table = json.loads((tmp_path / "statements.json").read_text())
    assert [row["verdict"] for row in table] == ["holds", "holds"]
    assert "2 of 2 statements hold" in (tmp_path / "statements.md").read_text()
    told.clear()
    reproduce_paper(inputs, tmp_path, ["fig9b"], on_task=told.append)
    assert [t.stored for t in told] == [True, True]


def test_inputs_from_the_command_line(tmp_path):
    done = shell("fig4", "fig2", "fig3b", "--output", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert "7 of 10 statements hold." in done.output
    assert re.search("4 +two magnification factors fit C_z, one for both lengths", done.output)
    page = (tmp_path / "statements.md").read_text(encoding="utf-8")
    assert "**does not hold**: amplitudes fall as wavelength^0.9" in page
    lines = [line for line in done.output.splitlines() if str(tmp_path) not in line]
    assert max(map(len, lines)) <= 100
    data = netcdf.load_dataset(tmp_path / "fig3b.nc")
    assert data.y_1.attrs["axis"] == "height difference correlation $C_z$ [mm$^2$]"
    assert (data.y_1.attrs["panel"], data.y_1.attrs["of"]) == (COARSE, "surface")
    assert {p.suffix for p in tmp_path.glob("fig4.*")} == {".nc", ".pdf", ".png"}


def test_own_surfaces_rubbers_and_factors(tmp_path):
    case, *_ = write_example(tmp_path / "own", "road")
    keys = {"crop": ["120 mm", "1780 mm"], "smallest_wavelength": "0.2 mm"}
    inputs = read_inputs(
        (str(case), ROAD_FILES[1]),
        (str(RUBBER_DATA / "friction" / "R60_master_curve.csv"), "styrene_butadiene"),
        ((4.0, 3.0), (3.0, 2.5), (7.0, 5.0)),
        surface_keys=keys,
    )
    road, station = inputs.surfaces
    assert (road, station) == ("own", "20211011_aylesbury_dec_station_1")
    assert inputs.surfaces[station].sines.wavelength[-1] == pytest.approx(2e-4)
    assert inputs.pairs == (("R60_master_curve", "styrene_butadiene"),)
    assert list(inputs.stacks[road]) == ["4/3", "3/2.5", "7/5"]
    panels = tasks_of("fig9a", inputs)
    assert list(panels) == [
        f"styrene_butadiene and R60_master_curve, {speed} mm/s" for speed in (300, 3000)
    ]
    # only the surfaces are put in the place of the default ones
    assert read_inputs((str(case), ROAD_FILES[1]), surface_keys=keys).rubber == FILLED_TREAD


def test_a_case_states_rubber_and_temperature(tmp_path):
    case, *_ = write_example(tmp_path / "own", "sweeps")
    text = case.read_text(encoding="utf-8")
    assert "[conditions]" not in text
    case.write_text(f'{text}\n[conditions]\ntemperature = "5 C"\n', encoding="utf-8")
    kelvin = [
        read_inputs(rubbers=(str(case), "styrene_butadiene"), temperature=warmth)
        .compounds["own"]
        .rubber.reference_temperature
        for warmth in (None, 263.15)
    ]
    assert kelvin == pytest.approx([278.15, 263.15])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--factors", "3.5/2.4"], "--factors must be 3 pairs or more"),
        (["--factors", "3.5,3,6"], 'factors must be pairs such as "3.5/2.4"'),
        (["--surface", "none.txt", "none.txt"], "--surface none.txt is neither a file nor one of"),
        (["--rubber", "none.csv", "none.csv"], "--rubber none.csv is neither a file nor one of"),
        (["--temperature", "20"], "temperature"),
    ],
)
def test_wrong_own_inputs_are_one_sentence(arguments, message, tmp_path):
    done = shell("fig2", *arguments, "--output", str(tmp_path))
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert message in line


def test_unknown_figure_is_one_sentence(tmp_path, inputs):
    with pytest.raises(InputError, match=r"figure must be one of fig2, .*; got 'fig1'"):
        reproduce_paper(inputs, tmp_path, ["fig1"])


def test_the_package_has_the_data_with_their_origin():
    """A wheel holds what is a file of the package; all of it with SOURCE and licence."""
    roads, rubbers = files("gripscale.case_file") / "data" / "road", files("gripscale.reproduction")
    for folder in (rubbers / "data" / "rubber", rubbers / "data" / "friction"):
        assert "Licence: " in (folder / "SOURCE.txt").read_text(encoding="utf-8")
    assert (roads / "LICENSE").is_file()
    assert (rubbers / "statements.csv").is_file()
    for path in (*ROAD_FILES, RUBBER_DATA / "rubber" / "measured_dma.txt"):
        assert Path(path).is_relative_to(Path(str(files("gripscale"))))
        assert Path(path).stat().st_size > 2000


def shell(*arguments):
    """Run the command in a terminal of 100 columns, whatever the tests run in."""
    return CliRunner().invoke(app, ["reproduce", *arguments], env={"COLUMNS": "100"})
