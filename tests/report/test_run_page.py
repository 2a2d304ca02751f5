"""The page of a run, read without a browser."""

from __future__ import annotations

import builtins
import hashlib
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from gripscale.core.errors import FileError, InputError
from gripscale.io import netcdf
from gripscale.io.table import significant
from gripscale.questions.inputs.page import rubber_facts
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.page_of_folder import write_report

from .conftest import CASE, WAVES, read
from .reading import Page

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&{{ 7 * 7 }}"


@pytest.fixture(scope="module")
def page(run_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Page:
    return Page(write_report(run_folder, tmp_path_factory.mktemp("page") / "report.html"))


def test_page_is_one_file_that_may_ask_for_nothing(page: Page) -> None:
    named = [(tag, attrs.get("src") or attrs.get("href")) for tag, attrs in page.tags]
    asked = [value for _, value in named if value and not value.startswith(("data:", "#"))]
    assert asked == []
    policy = next(a["content"] for _, a in page.tags if "http-equiv" in a)
    assert policy is not None
    assert "default-src 'none'" in policy
    scripts = policy.partition("script-src ")[2].partition(";")[0].split()
    assert len(scripts) == 2
    assert all(source.startswith("'sha256-") for source in scripts)
    assert len(page.source) < 3e6


def test_page_names_no_folder_of_this_machine(page: Page, run_folder: Path) -> None:
    assert "somewhere-private" in str(run_folder)
    assert "somewhere-private" not in page.source


def test_inputs_are_named_with_their_checksums(page: Page, run_folder: Path) -> None:
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


def test_cleaning_is_told_for_each_profile(page: Page) -> None:
    for name in ("cleaning-1", "cleaning-2"):
        rows = page.body(name)
        assert [row[0] for row in rows] == ["crop", "dropouts", "spikes", "trend"]
        assert rows[0][2] != "0"


def test_texture_of_each_profile_and_of_all(page: Page) -> None:
    rows = page.body("texture")
    assert [row[0] for row in rows] == ["profile 1", "profile 2", "all profiles"]
    first, second, both = (float(row[1]) for row in rows)
    assert min(first, second) <= both <= max(first, second)


def test_the_chain_is_a_chapter_beside_the_answer(page: Page, run_folder: Path) -> None:
    rows = page.body("chain")
    assert [row[0] for row in rows] == ["1", "2", "3"]
    assert all(cell for row in rows for cell in row)
    assert "The paper's chain of waves, for comparison" in page.text
    answer, chain = (read(run_folder / f"{name}.nc")[0] for name in ("answer", "chain"))
    ratio = significant(float(chain.total_friction) / float(answer.answer_friction), 2)
    assert f"{ratio} times that of the answer" in page.text
    figures = {attrs.get("id") for _, attrs in page.tags}
    assert {"figure-contact-fraction-by-wave", "figure-friction-by-wave"} <= figures


def test_the_answer_stands_without_the_chain_of_another_case(
    run_folder: Path, tmp_path: Path
) -> None:
    data, _ = read(run_folder / "chain.nc")
    netcdf.save(data.assign_attrs(case="# another"), tmp_path / "chain.nc")
    shutil.copy(run_folder / "answer.nc", tmp_path)
    page = Page(write_report(tmp_path))
    assert "table-chain" not in page.tables
    assert "A_r/A_0" in page.text


def test_failed_wave_is_marked_and_has_no_totals(failed_folder: Path) -> None:
    page = Page(write_report(failed_folder))
    assert "No totals: wave 2 did not converge (iteration limit at 40 %" in page.text
    marked = [tag for tag, a in page.tags if "bad" in (a.get("class") or "").split()]
    assert marked.count("th") == 1  # wave 2
    solved = page.body("chain")
    assert len(solved) == 2
    assert solved[1][-1] == "iteration limit at 40 % of the pressure"
    assert all(cell for row in solved for cell in row)


@pytest.mark.parametrize("plateau", [0, 1])
def test_a_modulus_is_relaxed_only_where_that_was_measured(run_folder: Path, plateau: int) -> None:
    record = InputRecord(read(run_folder / "answer.nc")[1]["inputs"])
    record.data.attrs |= {"slow_end_plateau": plateau, "slow_end_modulus_Pa": 2.5e6}
    pairs = dict(rubber_facts(record).pairs)
    assert pairs[("Slow end of the data, E′", "Relaxed modulus")[plateau]] == "2.50 MPa"
    assert (("Relaxed modulus", "Slow end of the data, E′")[plateau]) not in pairs


def test_hostile_texts_stay_texts(run_folder: Path, tmp_path: Path) -> None:
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


def test_case_text_is_given_word_for_word(page: Page) -> None:
    assert " ".join(CASE.split()) in page.text


def test_pictures_and_figures_have_texts(page: Page) -> None:
    pictures = [attrs for tag, attrs in page.tags if tag == "img"]
    # equations of the direct contact and of the chain
    assert len(pictures) == 13
    assert all(attrs.get("alt") for attrs in pictures)
    plots = [attrs for _, attrs in page.tags if attrs.get("class") == "plot"]
    assert len(plots) >= 13
    assert all(attrs.get("aria-label") and attrs.get("role") == "img" for attrs in plots)


def test_good_run_raises_no_alarm(page: Page) -> None:
    assert not [a for _, a in page.tags if a.get("role") == "alert"]


def test_ends_of_the_band_are_marked_in_both_units(page: Page) -> None:
    band = re.search(r"Measured band (\S+) to (\S+) rad/s \((\S+) to (\S+) Hz\)", page.text)
    assert band is not None
    slow, fast, slow_hertz, fast_hertz = map(float, band.groups())
    assert (slow / slow_hertz, fast / fast_hertz) == pytest.approx((2 * np.pi,) * 2, rel=6e-3)
    assert page.source.count('"ends of the measured band"') == 2  # moduli and loss factor
    assert page.source.count('"name":"Span"') == 4


def test_a_file_without_an_answer_is_refused(run_folder: Path, tmp_path: Path) -> None:
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
def test_what_is_no_result_is_refused(tmp_path: Path, content: Any, words: str) -> None:
    path = tmp_path / "result.nc"
    if content == "empty":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(FileError, match=words):
        write_report(path)


def test_missing_library_is_named(run_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *arguments: Any, **options: Any) -> Any:
        if name == "gripscale.report.build":
            raise ModuleNotFoundError("No module named 'bokeh'", name="bokeh.embed")
        return real(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"pip install 'gripscale\[report\]'"):
        write_report(run_folder)
