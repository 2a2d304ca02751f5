"""`gripscale compare` and what a run says of its chain: models side by side over one case."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from gripscale.case.compare import Rung, Sample, compare_case, judged
from typer.testing import Result

import gripscale as gs
from gripscale import netcdf
from gripscale.case import prepare_case
from gripscale.figures.comparison import comparison_figure
from gripscale.report.comparison_table import judgement

Shell = Callable[..., Result]
RUNGS = ["chain_half_plane", "sines", "random_phases", "direct", "persson"]


def test_command_puts_the_models_side_by_side(shell: Shell, inputs: Path, tmp_path: Path) -> None:
    result = shell("compare", inputs / "case.toml", "--seeds", 2, "--output", tmp_path / "out")
    assert result.exit_code == 0, result.output
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {
        "comparison.nc",
        "comparison.txt",
        "comparison.png",
        "comparison.pdf",
    }
    data = netcdf.load(tmp_path / "out" / "comparison.nc")
    assert data.rung.values.tolist() == RUNGS
    assert data.samples.values.tolist() == [1, 2, 2, 1, 1]
    assert (data.status == "converged").all()
    # A spread belongs to what was drawn more than once, and only to that.
    assert np.isfinite(data.friction_spread).values.tolist() == [False, True, True, False, False]
    for label in data.label.values:
        assert str(label) in result.stdout


def test_rungs_are_the_models_themselves(inputs: Path) -> None:
    results = prepare_case(inputs / "case.toml")
    rungs = {rung.name: rung for rung in compare_case(results, seeds=1, tolerance=0.02).rungs}
    measured = results.surface.measured
    assert measured is not None
    load = {"pressure": 3e5, "speed": 0.3}
    smallest = float(results.surface.sines.wavelength[-1])
    alone = gs.solve_rough_contact(
        results.rubber.rubber, measured.profiles[0][1], smallest_wavelength=smallest, **load
    )
    assert rungs["direct"].mean("contact_fraction") == alone.contact_fraction
    assert rungs["direct"].mean("friction") == alone.friction_from_dissipation
    chain = gs.predict(
        results.rubber.rubber, results.surface.sines, footprint=0.1, solver="half_plane", **load
    )
    assert rungs["chain_half_plane"].mean("friction") == chain.friction_from_dissipation
    quick = judged(results)
    assert quick is not None
    # Estimated errors of 10 % and 2 %.
    assert quick.mean("friction") == pytest.approx(rungs["direct"].mean("friction"), rel=0.12)


def test_waves_by_hand_have_no_profile_to_judge_by(tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text(
        '[[surface.sines]]\nwavelength = "10 mm"\namplitude = "0.4 mm"\n'
        '[[surface.sines]]\nwavelength = "2 mm"\namplitude = "0.05 mm"\n'
        '[rubber]\nname = "styrene_butadiene"\n'
        '[load]\npressure = "3 bar"\nspeed = 0.3\nfootprint = "100 mm"\n'
        '[solver]\nmodel = "half_plane"\npoints = 64\n'
    )
    results = prepare_case(case)
    assert judged(results) is None
    assert [rung.name for rung in compare_case(results, seeds=1).rungs] == RUNGS[:2]


def test_rung_that_failed_is_empty_and_says_why(inputs: Path) -> None:
    made = compare_case(prepare_case(inputs / "case.toml"), seeds=1)
    failed = Rung("direct", "direct", [Sample(np.nan, np.nan, "tolerance not met")], 0.0)
    data = replace(made, rungs=[made.rungs[0], failed]).to_dataset()
    assert np.isnan(data.total_friction.values[1])
    assert data.status.values.tolist() == ["converged", "tolerance not met"]
    assert len(comparison_figure(data).axes) == 2


def test_a_run_says_what_its_chain_is_worth(shell: Shell, inputs: Path, tmp_path: Path) -> None:
    result = shell("run", inputs / "case.toml", "--output", tmp_path)
    assert result.exit_code == 0, result.output
    results = prepare_case(inputs / "case.toml")
    direct = judged(results)
    assert direct is not None
    chain = gs.predict(
        results.rubber.rubber,
        results.surface.sines,
        pressure=3e5,
        speed=0.3,
        footprint=0.1,
        solver="half_plane",
        points=128,
    )
    first, second = judgement(chain, direct)
    words = " ".join(result.stdout.split())
    assert first in words
    assert second in words
    assert f"{chain.friction / direct.mean('friction'):.2g} times its friction" in second
    assert second in " ".join((tmp_path / "report.txt").read_text().split())
