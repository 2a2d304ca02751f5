"""`gripscale reproduce` from the inputs to figures, data and judged statements."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from gripscale import dataset
from gripscale.cli import app
from gripscale.errors import FileError, InputError
from gripscale.reproduce import FIGURES, reproduce
from gripscale.reproduce.bench import DENSE, PAPER_FACTORS, ROAD, TREAD, Bench
from gripscale.reproduce.bench import bench as read_bench
from gripscale.reproduce.chains import panels_of
from gripscale.study import Progress


def test_inputs_are_the_stated_ones(bench: Bench) -> None:
    dense = bench.magnified(DENSE)
    assert list(dense) == ["3.5/2.4", "3/2.2", "6/3"]
    coarse = bench.magnified(ROAD)
    for stacks in (dense, coarse):
        for stack, (s_wavelength, _) in zip(stacks.values(), PAPER_FACTORS, strict=True):
            assert stack.s_wavelength == pytest.approx(s_wavelength)
            assert stack.wavelength[-1] >= 0.1e-3 * (1.0 - 1e-9)
        assert len({float(stack.wavelength[0]) for stack in stacks.values()}) == 1
        assert len({float(stack.amplitude[0]) for stack in stacks.values()}) == 1
    assert "synthetic" in bench.roads[DENSE].source
    assert "not stated" in bench.rubbers[TREAD].source


def test_no_chain_is_solved_twice(bench: Bench) -> None:
    keys = [
        task.key
        for figure in FIGURES
        for lines in panels_of(figure, bench).values()
        for task in lines.values()
    ]
    assert len(keys) == 48
    assert len(set(keys)) == 25


def test_figure_with_chains_is_made_once_and_read_again(tmp_path: Path) -> None:
    told: list[Progress] = []
    statements = reproduce(["fig7a", "fig9b"], tmp_path, on_case=told.append)
    assert len(told) == 2
    assert [s.figure for s in statements] == ["fig7a", "fig9b"]
    assert all(s.holds for s in statements)
    for name in ("fig7a", "fig9b"):
        assert all((tmp_path / f"{name}.{kind}").stat().st_size > 5000 for kind in ("png", "pdf"))
        data = dataset.load(tmp_path / f"{name}.nc")
        assert data.line.values.tolist() == [ROAD, DENSE]
        assert data.case_status.values.tolist() == ["converged"] * 2
        assert data.sizes["scale"] == 8
        assert np.isnan(data.friction[1, 7])
        assert data.friction.attrs["units"] == "1"
        assert "synthetic" in data.attrs["surfaces"]
    table = json.loads((tmp_path / "statements.json").read_text())
    assert [row["verdict"] for row in table] == ["holds", "holds"]
    assert "2 of 2 statements hold" in (tmp_path / "statements.md").read_text()
    told.clear()
    reproduce(["fig9b"], tmp_path, on_case=told.append)
    assert [t.stored for t in told] == [True, True]


def test_inputs_from_the_command_line(tmp_path: Path) -> None:
    asked = ["reproduce", "fig4", "fig2", "fig3b", "--output", str(tmp_path)]
    result = CliRunner().invoke(app, asked, env={"COLUMNS": "100"})
    assert result.exit_code == 0, result.output
    assert "Reproducing fig2, fig3b, fig4" in result.stdout
    assert "6 of 7 statements hold" in result.stdout
    assert "fig4: DOES NOT HOLD: two magnification factors" in result.stdout
    assert "why: different inputs: amplitudes fall as wavelength^0.9" in result.stdout
    data = dataset.load(tmp_path / "fig3b.nc")
    assert data.C_z_1.attrs == {
        "units": "m^2",
        "long_name": "height difference correlation",
        "of": ROAD,
    }
    assert {p.suffix for p in tmp_path.glob("fig4.*")} == {".nc", ".pdf", ".png"}


def test_unknown_figure_and_missing_data_are_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"figure must be one of all, fig2, .*; got 'fig1'"):
        reproduce(["fig1"], tmp_path)
    with pytest.raises(FileError, match=r"does not exist; give the folder examples/data .* --data"):
        read_bench(tmp_path)
    for wrong in (["fig1"], ["fig2", "--data", str(tmp_path)]):
        result = CliRunner().invoke(app, ["reproduce", *wrong, "--output", str(tmp_path / "out")])
        assert result.exit_code == 2
        assert len(result.stderr.splitlines()) == 1
