"""The page of a run, read without a browser, and what the run records for it."""

import builtins
import hashlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from gripscale.core.errors import FileError, InputError
from gripscale.io import netcdf
from gripscale.questions.inputs.page import rubber_facts
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.page_of_folder import write_report

from .conftest import WAVES, read
from .reading import Page

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&{{ 7 * 7 }}"


@pytest.fixture(scope="module")
def page(run_folder, tmp_path_factory):
    return Page(write_report(run_folder, tmp_path_factory.mktemp("page") / "report.html"))


def test_a_good_run_raises_no_alarm_and_marks_the_ends_of_the_band(page):
    assert not [a for _, a in page.tags if a.get("role") == "alert"]
    assert sum(attrs.get("class") == "plot" for _, attrs in page.tags) >= 13
    assert page.source.count('"ends of the measured band"') == 2  # moduli and loss factor


def test_inputs_are_named_with_their_checksums(page, run_folder):
    rows = page.body("files")
    assert [row[:2] for row in rows] == [
        ["road.txt", "surface"],
        ["lane.txt", "surface"],
        ["dma.txt", "rubber"],
    ]
    for row in rows:
        content = (run_folder.parent / row[0]).read_bytes()
        assert row[3] == hashlib.sha256(content).hexdigest()
        assert int(re.sub(r"\D", "", row[2])) == len(content)


def test_the_answer_stands_without_the_chain_of_another_case(run_folder, tmp_path):
    data, _ = read(run_folder / "chain.nc")
    netcdf.save(data.assign_attrs(case="# another"), tmp_path / "chain.nc")
    shutil.copy(run_folder / "answer.nc", tmp_path)
    page = Page(write_report(tmp_path))
    assert "table-chain" not in page.tables
    assert "A_r/A_0" in page.text


def test_failed_wave_is_marked_and_has_no_totals(failed_folder):
    page = Page(write_report(failed_folder))
    assert "No totals: wave 2 did not converge (iteration limit at 40 %" in page.text
    marked = [tag for tag, a in page.tags if "bad" in (a.get("class") or "").split()]
    assert marked.count("th") == 1  # wave 2
    solved = page.body("chain")
    assert len(solved) == 2
    assert solved[1][-1] == "iteration limit at 40 % of the pressure"
    assert all(cell for row in solved for cell in row)


@pytest.mark.parametrize("plateau", [0, 1])
def test_a_modulus_is_relaxed_only_where_that_was_measured(run_folder, plateau):
    record = InputRecord(read(run_folder / "answer.nc")[1]["inputs"])
    record.data.attrs |= {"slow_end_plateau": plateau, "slow_end_modulus_Pa": 2.5e6}
    pairs = dict(rubber_facts(record).pairs)
    assert pairs[("Slow end of the data, E′", "Relaxed modulus")[plateau]] == "2.50 MPa"
    assert (("Relaxed modulus", "Slow end of the data, E′")[plateau]) not in pairs


def test_hostile_texts_stay_texts(run_folder, tmp_path):
    data, groups = read(run_folder / "answer.nc")
    chain, _ = read(run_folder / "chain.nc")
    for part in (data, chain):
        for name in ("case", "case_file", "rubber_source", "model", "version_gripscale"):
            part.attrs[name] = HOSTILE
    groups["inputs"].attrs["rubber_name"] = HOSTILE
    for name in ("profile_name", "file_name", "cleaning_note"):
        texts = np.full(groups["inputs"][name].shape, HOSTILE, dtype=object)
        groups["inputs"][name] = (groups["inputs"][name].dims, texts)
    chain["status"] = ("scale", np.array([HOSTILE] * WAVES, dtype=object))
    netcdf.save(data, tmp_path / "answer.nc", groups)
    netcdf.save(chain, tmp_path / "chain.nc")
    page = Page(write_report(tmp_path))
    assert [tag for tag, _ in page.tags].count("script") == 3
    assert not [a for _, a in page.tags if "onerror" in a]
    assert page.text.count("alert(1)") > 10
    assert "{{ 7 * 7 }}" in page.text
    assert "<script>alert" not in page.source


def test_a_file_without_an_answer_is_refused(run_folder, tmp_path):
    with pytest.raises(FileError, match="holds no result of a question"):
        write_report(run_folder / "chain.nc")
    netcdf.save(xr.Dataset({"a": ("scale", [1.0])}), tmp_path / "chain.nc")
    shutil.copy(run_folder / "answer.nc", tmp_path)
    with pytest.raises(FileError, match="has no report: it holds no totals"):
        write_report(tmp_path)


@pytest.mark.parametrize(
    ("content", "words"),
    [(None, "does not exist"), (b"text", "cannot be read"), ("empty", "holds no result")],
)
def test_what_is_no_result_is_refused(tmp_path, content, words):
    path = tmp_path / "result.nc"
    if content == "empty":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(FileError, match=words):
        write_report(path)


def test_missing_library_is_named(run_folder, monkeypatch):
    real = builtins.__import__

    def without(name, *arguments, **options):
        if name == "gripscale.report.build":
            raise ModuleNotFoundError("No module named 'bokeh'", name="bokeh.embed")
        return real(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"pip install 'gripscale\[report\]'"):
        write_report(run_folder)


def test_run_records_its_inputs_beside_the_prediction(run_folder):
    data, _ = read(run_folder / "chain.nc")
    inputs = read(run_folder / "answer.nc")[1]["inputs"]
    assert data.sizes["wave"] == 3
    assert inputs.sizes["profile"] == 2
    np.testing.assert_allclose(inputs.attrs["sines_s_wavelength"], 3.0, rtol=1e-12)
    assert inputs.sizes["row"] == 60
    lowest, highest = inputs["read_lowest"].values, inputs["read_highest"].values
    known = np.isfinite(lowest)
    assert (lowest[known] <= highest[known]).all()
    heights = np.loadtxt(run_folder.parent / "road.txt", skiprows=1)[:, 1] * 1e-3
    np.testing.assert_allclose(np.nanmax(highest[0]), heights.max(), rtol=1e-12)
    np.testing.assert_allclose(np.nanmin(lowest[0]), heights.min(), rtol=1e-12)
    assert data["mesh_x"].shape == (3, 9, 33)
    assert (data["columns"] == 32).all()


def test_command_writes_the_page_and_says_where(study_file, tmp_path, shell):
    done = shell("report", study_file, "--output", tmp_path / "page.html")
    assert "page.html" in done.stdout
    assert (tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    done = shell("report", study_file, "--output", tmp_path / "nowhere" / "page.html", code=2)
    assert done.stderr.count("\n") == 1
    assert "cannot be written" in done.stderr


def test_page_imports_only_what_it_is_made_with(run_folder, tmp_path):
    code = (
        "import sys, gc, gripscale\n"
        "gripscale.questions.write_report(sys.argv[1], sys.argv[2])\n"
        "assert gc.isenabled()\n"
        "print(*sys.modules)"
    )
    command = [sys.executable, "-c", code, str(run_folder), str(tmp_path / "page.html")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    unneeded = {"bokeh.models", "fontTools.subset", "scipy.optimize", "rich", "typer"}
    assert unneeded & set(done.stdout.split()) == set()
