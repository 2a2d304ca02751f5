"""The reproduction, from the inputs to figures, data and judged statements."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from gripscale.case_file import write_example
from gripscale.cli import app
from gripscale.core.errors import FileError, InputError
from gripscale.experiment import Progress
from gripscale.io import netcdf
from reproduction import judge_inputs
from reproduction.__main__ import main
from reproduction.inputs import (
    DATA,
    DENSE,
    FAST,
    PAPER_FACTORS,
    R60,
    ROAD,
    ROAD_FILES,
    SPEED,
    TREAD,
    Inputs,
    OwnInputs,
    read_inputs,
)
from reproduction.panels import panels_of
from reproduction.run import FIGURES, reproduce
from reproduction.statement import Statement
from studies.paper_page import MADE, write_page
from tests.samples import ROOT


def test_inputs_are_the_stated_ones(inputs: Inputs) -> None:
    assert list(inputs.stacks) == [ROAD, DENSE]
    assert list(inputs.stacks[DENSE]) == ["3.5/2.4", "3/2.2", "6/3"]
    assert [inputs.worst_fit(road) for road in (ROAD, DENSE)] == ["6/4.16", "6/3"]
    for stacks in inputs.stacks.values():
        for stack, (s_wavelength, _) in zip(stacks.values(), PAPER_FACTORS, strict=True):
            assert stack.s_wavelength == pytest.approx(s_wavelength)
            assert stack.wavelength[-1] >= 0.1e-3 * (1.0 - 1e-9)
        assert len({float(stack.wavelength[0]) for stack in stacks.values()}) == 1
        assert len({float(stack.amplitude[0]) for stack in stacks.values()}) == 1
    assert "synthetic" in inputs.surfaces[DENSE].source
    assert "not stated" in inputs.rubbers[TREAD].source
    assert "by this letter only" in inputs.rubbers[R60].source


def test_resin_tread_has_its_loss_maximum_among_the_waves(inputs: Inputs) -> None:
    rubber, master = inputs.compounds[R60].rubber, inputs.compounds[R60].master
    assert rubber.reference_temperature == pytest.approx(273.15)
    assert master is not None
    omega = np.geomspace(1e-2, 1e12, 2000)
    highest = omega[int(rubber.loss_factor(omega).argmax())]
    first, *_, last = inputs.surfaces[ROAD].sines.wavelength
    for speed in (SPEED, FAST):
        assert last < 2.0 * np.pi * speed / highest < first
    # the measured rows are shifted with the series: half of them are within its rms error
    fit = inputs.compounds[R60].fit
    assert fit is not None
    off = rubber.complex_modulus(master.angular_frequency).real / master.storage - 1.0
    assert np.median(np.abs(off)) < fit.rms_storage


def test_no_chain_is_solved_twice(inputs: Inputs) -> None:
    keys = [
        task.key
        for figure in FIGURES
        for lines in panels_of(figure, inputs).values()
        for task in lines.values()
    ]
    assert len(keys) == 53
    assert len(set(keys)) == 31


def test_page_keeps_what_is_written_by_hand(tmp_path: Path) -> None:
    page = tmp_path / "paper.md"
    page.write_text(f"# By hand\n\n{MADE}\n\nold numbers\n", encoding="utf-8")
    said = "the area falls"
    write_page(
        page,
        [
            Statement("fig5a", said, "here", "less than 1", "0.5", True),
            Statement("fig5a", said, "there", "less than 1", "1.5", False, "steeper"),
        ],
    )
    text = page.read_text(encoding="utf-8")
    assert text.startswith(f"# By hand\n\n{MADE}\n\n1 of 2 statements hold:\n\n")
    assert "old numbers" not in text
    assert f"| Figure 5a | {said} | 1 | 1 |  |" in text
    for figure in FIGURES:
        assert f"](figures/paper_{figure}.png)" in text
    page.write_text("# By hand\n", encoding="utf-8")
    with pytest.raises(FileError, match="below which it is written"):
        write_page(page, [])


def test_docs_have_every_figure_and_statement() -> None:
    """The numbers of the page are those of the machine that made it; the statements are here."""
    page = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
    made = page[page.index(MADE) :]
    assert {f"paper_{figure}" for figure in FIGURES} == set(re.findall(r"paper_fig\w+", made))
    inputs = read_inputs()
    for statement in (*judge_inputs.judge_factors(inputs), *judge_inputs.judge_correlation(inputs)):
        for text in (statement.criterion, statement.where, f"**{statement.verdict}**"):
            assert text in made


@pytest.mark.verification
def test_figure_with_chains_is_made_once_and_read_again(tmp_path: Path) -> None:
    told: list[Progress] = []
    statements = reproduce(["fig7b", "fig9b"], tmp_path, on_task=told.append)
    assert len(told) == 2
    assert [s.figure for s in statements] == ["fig7b", "fig9b"]
    assert all(s.holds for s in statements)
    for name in ("fig7b", "fig9b"):
        assert all((tmp_path / f"{name}.{kind}").stat().st_size > 5000 for kind in ("png", "pdf"))
        data = netcdf.load_dataset(tmp_path / f"{name}.nc")
        assert data.line.values.tolist() == [ROAD, DENSE]
        assert data.prediction_status.values.tolist() == ["converged"] * 2
        assert data.sizes["scale"] == 8
        assert np.isnan(data.friction[1, 7])
        assert data.friction.attrs["units"] == "1"
        assert "synthetic" in data.attrs["surfaces"]
    table = json.loads((tmp_path / "statements.json").read_text())
    assert [row["verdict"] for row in table] == ["holds", "holds"]
    assert "2 of 2 statements hold" in (tmp_path / "statements.md").read_text()
    told.clear()
    reproduce(["fig9b"], tmp_path, on_task=told.append)
    assert [t.stored for t in told] == [True, True]


def test_inputs_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fig4", "fig2", "fig3b", "--output", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "Reproducing fig2, fig3b, fig4" in printed
    assert "7 of 10 statements hold" in printed
    assert "fig4: DOES NOT HOLD: two magnification factors" in printed
    assert "why: amplitudes fall as wavelength^0.9" in printed
    lines = [line for line in printed.splitlines() if str(tmp_path) not in line]
    assert max(map(len, lines)) <= 100
    data = netcdf.load_dataset(tmp_path / "fig3b.nc")
    assert data.C_z_1.attrs == {
        "units": "m^2",
        "long_name": "height difference correlation",
        "of": ROAD,
    }
    assert {p.suffix for p in tmp_path.glob("fig4.*")} == {".nc", ".pdf", ".png"}


def test_own_surfaces_rubbers_and_factors(tmp_path: Path) -> None:
    case, *_ = write_example(tmp_path / "own", "road")
    own = OwnInputs(
        surfaces=(str(case), str(DATA / ROAD_FILES[1])),
        rubbers=(str(DATA / "friction" / "R60_master_curve.csv"), "styrene_butadiene"),
        factors=((4.0, 3.0), (3.0, 2.5), (7.0, 5.0)),
        surface_keys={"crop": ["120 mm", "1780 mm"], "smallest_wavelength": "0.2 mm"},
    )
    inputs = read_inputs(own=own)
    road, station = inputs.surfaces
    assert (road, station) == ("own", "20211011_aylesbury_dec_station_1")
    assert inputs.surfaces[station].sines.wavelength[-1] == pytest.approx(2e-4)
    assert inputs.pairs == (("R60_master_curve", "styrene_butadiene"),)
    assert list(inputs.stacks[road]) == ["4/3", "3/2.5", "7/5"]
    panels = panels_of("fig9a", inputs)
    assert list(panels) == [
        f"styrene_butadiene and R60_master_curve, {speed} mm/s" for speed in (300, 3000)
    ]
    # only the surfaces are put in the place of the default ones
    assert read_inputs(own=replace(own, rubbers=())).rubber == TREAD


def test_a_case_states_rubber_and_temperature(tmp_path: Path) -> None:
    case, *_ = write_example(tmp_path / "own", "sweeps")
    text = case.read_text(encoding="utf-8")
    assert "[conditions]" not in text
    case.write_text(f'{text}\n[conditions]\ntemperature = "5 C"\n', encoding="utf-8")
    own = OwnInputs(rubbers=(str(case), "styrene_butadiene"))
    kelvin = [
        read_inputs(own=each).compounds["own"].rubber.reference_temperature
        for each in (own, replace(own, temperature=263.15))
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
def test_wrong_own_inputs_are_one_sentence(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["fig2", *arguments, "--output", str(tmp_path)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line


def test_unknown_figure_and_missing_data_are_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(InputError, match=r"figure must be one of all, fig2, .*; got 'fig1'"):
        reproduce(["fig1"], tmp_path)
    with pytest.raises(FileError, match=r"does not exist; give the folder examples/data .* --data"):
        read_inputs(tmp_path)
    for wrong in (["fig1"], ["fig2", "--data", str(tmp_path)]):
        assert main([*wrong, "--output", str(tmp_path / "out")]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1


def test_nothing_hidden_and_nothing_of_the_command_line_is_used() -> None:
    hidden = re.compile(r"^(?:from|import) gripscale(?:\.cli|\S*\._)|import .*\b_\w", re.MULTILINE)
    for path in Path(sys.modules["reproduction"].__path__[0]).glob("*.py"):
        assert not hidden.search(path.read_text(encoding="utf-8")), path.name


def shell(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["reproduce", *arguments])


def test_gripscale_reproduce_hands_over_in_a_clone(tmp_path: Path) -> None:
    done = shell("fig2", "--output", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert "2 of 4 statements hold" in done.output
    assert shell("fig1").exit_code == 2
    assert "figures of Lind & Wangenheim 2014" in " ".join(shell("--help").output.split())


def test_the_wheel_alone_says_where_the_reproduction_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    module = tmp_path / "lib" / "gripscale" / "cli" / "run.py"
    monkeypatch.setattr(import_module("gripscale.cli.run"), "__file__", str(module))
    done = shell("fig2")
    assert done.exit_code == 2
    assert re.fullmatch(r"error: .* in the source of gripscale, .*\n", done.stderr)
    assert shell("--help").exit_code == 0
