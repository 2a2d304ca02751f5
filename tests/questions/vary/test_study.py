"""A study holds exactly the chains of `predict` over its axes."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.chain import Chain
from gripscale.core.errors import InputError
from gripscale.core.provenance import SHOWING, fingerprint
from gripscale.core.status import Status
from gripscale.core.units import display_unit_of
from gripscale.experiment import Task, task
from gripscale.io import netcdf
from gripscale.model import Load
from gripscale.questions import Study
from gripscale.questions.terminal import PROGRESS_LINES
from gripscale.surface import Surface
from gripscale.theory import HalfPlane
from gripscale.wave import FiniteStrainBlock, Mesh
from tests.samples import fail_waves

SPEEDS = [0.01, 1.0]


@dataclass(frozen=True)
class Warmer:
    """A condition that does nothing, with a number that counts."""

    temperature: float

    def __call__(self, wave, so_far):
        return so_far.rubber


WAVES = gs.SineStack(wavelength=[10e-3, 3e-3, 1e-3], amplitude=[0.8e-3, 0.25e-3, 0.08e-3])


def test_crossed_study_is_predict_at_every_point(case, tmp_path):
    told = []
    study = Study(read_case(case), {"speed": SPEEDS, "pressure": "1 bar, 3 bar"})
    result = study.run(tmp_path / "out", on_task=told.append)
    alone = gs.solve_chain(
        gs.rubber.styrene_butadiene(),
        WAVES,
        pressure=3e5,
        speed=1.0,
        footprint=0.1,
        columns=32,
        rows=8,
    )
    there = result.sel(speed=1.0, pressure=3e5)
    assert there.total_friction == alone.friction
    assert there.total_contact_fraction == alone.contact_fraction
    np.testing.assert_array_equal(there.running_friction, alone.running_friction)
    assert result.total_friction.dims == ("speed", "pressure")
    assert (result.prediction_status == "converged").all()
    assert [t.done for t in told] == [1, 2, 3, 4]
    assert {t.label for t in told} >= {"speed 0.01 m/s, pressure 1 bar"}


def test_result_file_is_labelled_with_units_and_provenance(case, tmp_path):
    result = Study(read_case(case), {"speed": SPEEDS}).run(tmp_path)
    kept = netcdf.load_dataset(tmp_path / "study.nc")
    assert kept.identical(result)
    assert all({"units", "long_name"} <= set(kept[name].attrs) for name in kept.variables)
    assert kept.speed.attrs["units"] == "m/s"
    assert kept.attrs["case"] == case.read_text()
    assert kept.attrs["display_units"] == json.dumps(read_case_file(case).units)
    assert display_unit_of(kept.attrs, "pressure").unit == "bar"
    assert kept.attrs["software"].startswith("gripscale ")


def test_speed_zero_is_static_contact(case, tmp_path):
    read = read_case(case)
    result = Study(read, {"speed": [0.0, 0.3]}).run(tmp_path)
    rest = replace(read.load, speed=0.0, load_time="passage")
    alone = read.chain.predict(read.rubber, read.surface, rest)
    assert result.total_contact_fraction[0] == alone.total_contact_fraction
    assert result.total_contact_fraction[0] > result.total_contact_fraction[1]
    assert len(list((tmp_path / "predictions").iterdir())) == 2


def test_failed_chain_is_a_status(case, tmp_path, monkeypatch):
    fail_waves(
        monkeypatch,
        Status.ITERATION_LIMIT,
        lambda problem: problem.load.speed >= 1.0 and problem.profile.wavelength <= 5e-3,
    )
    result = Study(read_case(case), {"speed": SPEEDS}).run(tmp_path)
    assert result.prediction_status[0] == "converged"
    assert "wave 2 of 3" in str(result.prediction_status[1].item())
    assert "iteration limit" in str(result.prediction_status[1].item())
    assert result.prediction_status_word.values.tolist() == ["converged", "iteration limit"]
    assert np.isnan(result.total_friction).values.tolist() == [False, True]
    assert np.isnan(result.running_friction[1]).values.tolist() == [False, True, True]
    assert np.isnan(result.wavelength[1]).values.tolist() == [False, False, True]
    told = []
    Study(read_case(case), {"speed": SPEEDS}).run(tmp_path, on_task=told.append)
    assert [progress.stored for progress in told] == [True, True]


def test_key_changes_with_every_input_and_the_software(monkeypatch):
    surface = Surface(WAVES, "by hand")
    inputs = {
        "rubber": gs.Rubber(5e6, [1e6], [1e-3]),
        "surface": surface,
        "load": Load(3e5, 0.3, 0.1),
    }
    changes = [
        {"rubber": gs.Rubber(5e6, [1e6], [math.nextafter(1e-3, 1)])},
        {"rubber": gs.Rubber(5e6, [1e6], [1e-3], valid_band=(1.0, 2.0))},
        {"rubber": gs.Rubber(5e6, [1e6], [1e-3], bulk_modulus=1e9)},
        {"rubber": gs.Rubber(5e6, [1e6], [1e-3], strain_energy=gs.rubber.Yeoh(-0.1, 0.02))},
        {"surface": Surface(gs.SineStack(WAVES.wavelength[:2], WAVES.amplitude[:2]), "")},
        {"load": Load(math.nextafter(3e5, 1e6), 0.3, 0.1)},
        {"load": Load(3e5, 0.31, 0.1)},
        {"load": Load(3e5, 0.3, 0.11)},
        {"load": Load(3e5, 0.3, 0.1, math.inf)},
        {"model": Chain(HalfPlane())},
        {"model": Chain(FiniteStrainBlock(Mesh(columns=64)))},
        {"model": Chain(FiniteStrainBlock(tolerance=0.01))},
        {"model": Chain(rubber_at=Warmer(300.0))},
        {"model": Chain(rubber_at=Warmer(301.0))},
    ]
    keys = [Task(**{**inputs, **change}).key for change in [{}, *changes]]
    assert len(set(keys)) == len(keys)
    assert Task(**inputs).key == keys[0]
    elsewhere = {**inputs, "surface": Surface(WAVES, "the same waves from elsewhere")}
    assert Task(**elsewhere).key == keys[0]
    monkeypatch.setattr(task, "software", lambda: "gripscale 99")
    assert Task(**inputs).key != keys[0]


def test_model_that_cannot_be_written_down_is_refused():
    odd = Chain(rubber_at=lambda wave, so_far: so_far.rubber)
    made = Task(gs.Rubber(5e6), Surface(WAVES, ""), Load(3e5, 0.3, 0.1), odd)
    with pytest.raises(InputError, match="models and conditions must be dataclasses"):
        _ = made.key


@pytest.mark.parametrize(
    ("module", "counts"),
    [
        ("rubber/material.py", True),
        ("rubber/strain_energy.py", True),
        ("theory/half_plane.py", True),
        ("wave/result.py", True),
        ("chain/chain.py", True),
        ("core/checks.py", True),
        ("a_room_of_tomorrow/new.py", True),
        ("charts/blocks.py", False),
        ("app/forms.py", False),
        ("report/tables.py", False),
        ("cli/run.py", False),
    ],
)
def test_changed_module_changes_the_fingerprint(module, counts, tmp_path):
    home, kernel = tmp_path / "gripscale", tmp_path / "_kernel.so"
    (home / module).parent.mkdir(parents=True)
    (home / module).write_text("number = 1\n")
    kernel.write_bytes(b"compiled")
    before, whole = fingerprint(home, kernel, SHOWING), fingerprint(home, kernel)
    (home / module).write_text("number = 2\n")
    assert (fingerprint(home, kernel, SHOWING) != before) == counts
    assert fingerprint(home, kernel) != whole
    kernel.write_bytes(b"compiled anew")
    assert fingerprint(home, kernel, SHOWING) != before


def test_decades_of_relaxation_share_out_the_friction(case, tmp_path):
    one = gs.Rubber(5e6, [5e6], [2e-3])
    two = gs.Rubber(5e6, [2.5e6, 2.5e6], [2e-3, 2e-3])
    far = gs.Rubber(5e6, [5e6, 1.0], [2e-3, 2e-1])
    study = Study(
        read_case(case), {"rubber": {"one": one, "two": two, "far": far}, "speed": [0.01, 0.3]}
    )
    result = study.run(tmp_path)
    by_decade = result.friction_by_decade
    np.testing.assert_allclose(by_decade.decade, [1e-3, 1e-2, 1e-1])
    np.testing.assert_allclose(by_decade.sum("decade"), result.total_friction, rtol=1e-12)
    np.testing.assert_allclose(by_decade.isel(decade=1), 0.0, atol=1e-15)
    shares = (by_decade.isel(decade=2) / result.total_friction).sel(rubber="far")
    # E'' of both elements at the fundamental of the largest wave, where the slow one leads most.
    phase = 2 * np.pi * result.speed.values / 10e-3
    slow, fast = (g * phase * t / (1 + (phase * t) ** 2) for g, t in ((1.0, 0.2), (5e6, 2e-3)))
    assert (shares.values > 0.0).all()
    assert (shares.values < slow / (slow + fast)).all()


def test_a_refused_point_says_why_and_the_others_stand(case, shell):
    """The named rubber is known from 0.01 rad/s; 10 mm at 1e-6 m/s is 6e-4 rad/s."""
    case.write_text(case.read_text().replace("[rubber]", '[rubber]\nextrapolate = "refuse"'))
    done = shell(
        "study", case, "--vary", "speed=0.000001,0.3", "--output", case.parent / "study", code=3
    )
    assert "1 of 2 predictions failed" in done.stderr
    result = netcdf.load_dataset(case.parent / "study" / "study.nc")
    assert np.isfinite(result.total_friction.values).tolist() == [False, True]
    assert "below the measured band" in str(result.prediction_status.values[0])
    assert result.prediction_status.values[1] == "converged"


def test_a_study_says_what_lies_beyond_the_band(case, shell):
    done = shell("study", case, "--vary", "speed=0.000001,0.3", "--output", case.parent / "study")
    sentence = "1 of 2 predictions, up to 100 % of their friction, lie up to 1.2 decades below the"
    assert sentence in " ".join(done.stdout.split())
    result = netcdf.load_dataset(case.parent / "study" / "study.nc")
    assert result.total_friction_outside_band.values.tolist() == [1.0, 0.0]
    assert result.total_decades_below_band.values[0] == pytest.approx(
        np.log10(0.01 / (2e-4 * np.pi))
    )


def test_command_solves_prints_draws_and_resumes(shell, case, monkeypatch):
    monkeypatch.setenv(PROGRESS_LINES, "1")
    asked = ("study", case, "--vary", "speed=0.01:1:log3", "--vary", "pressure=1 bar,3 bar")
    result = shell(*asked)
    target = case.parent / "results" / "study"
    written = {
        str(p.relative_to(target)) for p in target.rglob("*.*") if "predictions" not in p.parts
    }
    files = {"case.toml", "study.nc"}
    assert written == files | {".case", "report.html", "figures/totals.png"}
    assert "[6/6] speed" in result.stdout
    data = netcdf.load_dataset(target / "study.nc")
    assert f"{float(data.total_friction[2, 1]):.3f}" in result.stdout
    assert result.stdout.count("converged") == 6
    assert max(len(line) for line in result.stdout.splitlines() if "in /" not in line) <= 100
    again = shell(*asked)
    assert again.stdout.partition("Answer")[2] == result.stdout.partition("Answer")[2]


def test_names_are_drawn_as_points(shell, case, tmp_path):
    vary = ("--vary", "rubber=case", "--vary", "surface=case,synthetic_dense_asphalt")
    shell("study", case, *vary, "--output", tmp_path)
    names = {path.stem for path in (tmp_path / "figures").glob("*.png")}
    assert names == {"totals", "wavelength"}
