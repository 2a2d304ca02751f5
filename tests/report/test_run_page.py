"""The page of a run, read without a browser."""

from __future__ import annotations

import builtins
import hashlib
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.charts.page_elements import Chart
from gripscale.core.errors import FileError, InputError
from gripscale.core.finding import Finding, Severity, from_json, sentences, to_json
from gripscale.experiment.measured_friction import MeasuredFriction, measured_variables
from gripscale.half_space.location import contact_trace, with_traces
from gripscale.io import netcdf
from gripscale.io.table import significant
from gripscale.model import OUTSIDE_BAND, TOTALS, Load, predicted_answer
from gripscale.questions.chain.charts import contact_charts
from gripscale.questions.chain.run_page import RunSource, notices, run_cards, run_page
from gripscale.questions.inputs.page import rubber_facts
from gripscale.questions.page_of_folder import read_result, write_report
from gripscale.report.elements import Text
from gripscale.surface import self_affine_profile
from tests.samples import ZENER

from .conftest import CASE, WAVES, read
from .reading import Page

NAMES = ("dynamic", "static")
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


def test_the_direct_contact_is_called_as_its_profiles(run_folder: Path) -> None:
    profile = self_affine_profile(0.8, 5e-3, 5e-4, 0.05, 5e-5, seed=1)
    contact = gs.solve_rough_contact(
        ZENER, profile, pressure=3e5, speed=0.3, smallest_wavelength=4e-4, tolerance=None
    )
    run = read_result(run_folder)
    assert isinstance(run, RunSource)
    direct = with_traces(run.predictions[0].data.drop_dims("scale"), [contact_trace(contact)] * 2)
    section = next(s for s in run_page(replace(run, direct=direct)).sections if s.name == "contact")
    captions = [element.caption for element in section.elements if isinstance(element, Chart)]
    assert [caption.split(":")[0].split(",")[0] for caption in captions] == [
        "road", "road", "lane", "lane",
    ]  # fmt: skip


def test_texture_of_each_profile_and_of_all(page: Page) -> None:
    rows = page.body("texture")
    assert [row[0] for row in rows] == ["profile 1", "profile 2", "all profiles"]
    first, second, both = (float(row[1]) for row in rows)
    assert min(first, second) <= both <= max(first, second)


@pytest.mark.parametrize("name", NAMES)
def test_tables_have_every_wave_and_no_empty_cell(page: Page, name: str) -> None:
    rows = page.body(name)
    assert [row[0] for row in rows] == ["1", "2", "3"]
    assert all(cell for row in rows for cell in row)


def test_case_text_is_given_word_for_word(page: Page) -> None:
    assert " ".join(CASE.split()) in page.text


def test_pictures_and_figures_have_texts(page: Page) -> None:
    pictures = [attrs for tag, attrs in page.tags if tag == "img"]
    assert len(pictures) == 9  # equations
    assert all(attrs.get("alt") for attrs in pictures)
    plots = [attrs for _, attrs in page.tags if attrs.get("class") == "plot"]
    assert len(plots) >= 12
    assert all(attrs.get("aria-label") and attrs.get("role") == "img" for attrs in plots)


def test_good_run_raises_no_alarm(page: Page) -> None:
    assert not [a for _, a in page.tags if a.get("role") == "alert"]


def test_failed_wave_is_loud_and_has_no_totals(failed_folder: Path) -> None:
    page = Page(write_report(failed_folder))
    assert [a for _, a in page.tags if a.get("role") == "alert"]
    assert "Dynamic, 0.3 m/s: wave 2 did NOT converge (iteration limit at 40 %" in page.text
    assert "No totals" in page.text
    marked = [tag for tag, a in page.tags if "bad" in (a.get("class") or "").split()]
    assert marked.count("th") == 1  # wave 2
    solved = page.body("dynamic")
    assert len(solved) == 2
    assert solved[1][-1] == "iteration limit at 40 % of the pressure"
    assert all(cell for row in solved for cell in row)


def test_run_that_was_stopped_has_no_totals(changed_run: Callable[..., Path]) -> None:
    folder = changed_run(lambda data: data.isel(scale=slice(0, 2)), "static")
    run = read_result(folder)
    assert isinstance(run, RunSource)
    errors = [notice.sentence for notice in notices(run) if notice.severity == "error"]
    assert len(errors) == 1
    assert errors[0].startswith("Static: the run ended after wave 2 of 3.")
    assert [card.label for card in run_cards(run) if card.bad] == ["No totals"]


def test_the_answer_stands_before_the_totals(changed_run: Callable[..., Path]) -> None:
    run = read_result(changed_run(lambda data: data))
    assert isinstance(run, RunSource)
    assert "answer" not in [card.detail for card in run_cards(run)]
    numbers = {"answer_friction": 0.25, "answer_contact_fraction": 0.04, "cutoff_wavelength": 1e-3}
    ends = {f"{name}_{end}": numbers[name] for name in list(numbers)[:2] for end in ("low", "high")}
    whole = run.predictions[0].data.drop_dims("scale").assign(numbers | ends)
    whole = whole.assign(answer_friction_high=0.3, factor_label=("factor", ["large strain"]))
    for name in list(numbers)[:2]:
        whole[f"{name}_factor"] = whole[f"{name}_factor_uncertainty"] = ("factor", [1.0])
        whole[f"{name}_sampling_error"] = 0.02
    cards = list(run_cards(replace(run, direct=whole)))
    first, second = cards  # no card of the chain
    assert (first.label, first.value) == ("Friction coefficient μ", "0.250")
    assert (first.interval, first.detail) == (
        "0.250 to 0.300 (90 %)",
        "answer; hysteresis alone",
    )
    assert (second.label, second.value) == ("Real contact area A_r/A_0", "0.0400")
    page = run_page(replace(run, direct=whole))
    (at,) = (at for at, section in enumerate(page.sections) if section.name == "results")
    assert at >= page.open_chapters
    chapter = page.sections[at]
    assert chapter.title == "The paper's chain of waves, for comparison"
    ratio = significant(float(whole.total_friction) / 0.25, 2)
    texts = [element.text for element in chapter.elements if isinstance(element, Text)]
    assert any(f"{ratio} times that of the answer" in text for text in texts)
    assert [chart.name for chart in contact_charts(run.by_wave, whole)][:2] == [
        "contact-area",
        "friction",
    ]


def test_large_mismatch_and_foreign_frequencies_are_warned_of(
    changed_run: Callable[..., Path],
) -> None:
    def edit(data: xr.Dataset) -> xr.Dataset:
        data = data.copy(deep=True)
        data["friction_mismatch"].values[:] = [0.01, 0.2, 0.01]
        data["outside_band"].values[:] = [0, 0, 1]
        for name, value in zip(OUTSIDE_BAND, (0.32, 0.0, 0.8), strict=True):
            data[name].values[...] = value
        return data

    run = read_result(changed_run(edit, "dynamic"))
    assert isinstance(run, RunSource)
    text = " ".join(notice.sentence for notice in notices(run))
    assert "Wave 2: the two frictions are up to 20 % apart; take a finer mesh." in text
    assert (
        "Dynamic, 0.3 m/s: 1 of 3 waves, 32 % of the friction, lie up to 0.8 decades above the "
        "measured band." in text
    )
    assert [card.label for card in run_cards(run) if card.bad] == ["Largest mismatch of μ"]
    friction = run.predictions[0].column("friction")
    (apart,) = (notice for notice in notices(run) if "Wave 2" in notice.sentence)
    assert apart.effect == pytest.approx(0.2 * friction[1] / friction.sum())


def test_doubts_about_the_rubber_are_warned_of(changed_run: Callable[..., Path]) -> None:
    """|E*| = 1 GPa with a bulk modulus of 1 GPa: (3 - 2/3)/(2 (3 + 1/3)) = 0.35; 2 GPa: 0.227."""

    def edit(data: xr.Dataset) -> xr.Dataset:
        data = data.copy(deep=True)
        data["modulus"].values[:] = [1e7, 1e9, 2e9]
        return data

    run = read_result(changed_run(edit, "dynamic"))
    assert isinstance(run, RunSource)
    run.inputs.attrs["bulk_modulus_Pa"] = 1e9
    texts = [notice.sentence for notice in notices(run)]
    text = next(text for text in texts if "Poisson" in text)
    assert "Wave 3: Poisson's ratio is down to 0.227, less than 0.3" in text


@pytest.mark.parametrize("plateau", [0, 1])
def test_a_modulus_is_relaxed_only_where_that_was_measured(
    changed_run: Callable[..., Path], plateau: int
) -> None:
    run = read_result(changed_run(lambda data: data))
    assert isinstance(run, RunSource)
    run.inputs.attrs |= {"slow_end_plateau": plateau, "slow_end_modulus_Pa": 2.5e6}
    pairs = dict(rubber_facts(run.record).pairs)
    assert pairs[("Slow end of the data, E′", "Relaxed modulus")[plateau]] == "2.50 MPa"
    assert (("Relaxed modulus", "Slow end of the data, E′")[plateau]) not in pairs


def test_ends_of_the_band_are_marked_in_both_units(page: Page) -> None:
    band = re.search(r"Measured band (\S+) to (\S+) rad/s \((\S+) to (\S+) Hz\)", page.text)
    assert band is not None
    slow, fast, slow_hertz, fast_hertz = map(float, band.groups())
    assert (slow / slow_hertz, fast / fast_hertz) == pytest.approx((2 * np.pi,) * 2, rel=6e-3)
    assert page.source.count('"ends of the measured band"') == 2  # moduli and loss factor
    assert page.source.count('"name":"Span"') == 4


def test_notes_on_the_surface_are_warnings(run_folder: Path, tmp_path: Path) -> None:
    data, groups = read(run_folder / "dynamic.nc")
    findings = from_json(groups["inputs"].attrs["findings"])
    assert "no smallest wavelength is stated" in sentences(findings)
    texts = ("Surface: road: heights jump.", "Rubber: no plateau at the fast end.")
    jumps = [Finding(Severity.WARNING, text) for text in texts]
    groups["inputs"].attrs["findings"] = to_json([*findings, *jumps])
    netcdf.save(data, tmp_path / "dynamic.nc", groups)
    run = read_result(tmp_path)
    assert isinstance(run, RunSource)
    warned = [notice.sentence for notice in notices(run) if notice.severity == "warning"]
    assert set(texts) <= set(warned)


def test_hostile_texts_stay_texts(run_folder: Path, tmp_path: Path) -> None:
    data, groups = read(run_folder / "dynamic.nc")
    for name in ("case", "case_file", "rubber_source", "model", "version_gripscale"):
        data.attrs[name] = HOSTILE
    groups["inputs"].attrs["rubber_name"] = HOSTILE
    for name in ("profile_name", "file_name", "cleaning_note"):
        texts = np.full(groups["inputs"][name].shape, HOSTILE, dtype=object)
        groups["inputs"][name] = (groups["inputs"][name].dims, texts)
    for name in ("status", "wave_solver"):
        data[name] = ("scale", np.array([HOSTILE] * WAVES, dtype=object))
    data = data.drop_vars(["mesh_x", "mesh_z"])
    page = Page(write_report(netcdf.save(data, tmp_path / "dynamic.nc", groups)))
    assert [tag for tag, _ in page.tags].count("script") == 3
    assert not [a for _, a in page.tags if "onerror" in a]
    assert page.text.count("alert(1)") > 10
    assert "{{ 7 * 7 }}" in page.text
    assert "<script>alert" not in page.source


def test_single_file_without_record_and_meshes(run_folder: Path, tmp_path: Path) -> None:
    data = netcdf.load_dataset(run_folder / "static.nc").drop_vars(["mesh_x", "mesh_z"])
    alone = netcdf.save(data, tmp_path / "alone.nc")
    page = Page(write_report(alone))
    assert "holds no record of its inputs" in page.text
    assert [row[0] for row in page.body("alone")] == ["1", "2", "3"]
    assert "table-files" not in page.tables


def test_measured_friction_is_that_of_the_record(
    changed_run: Callable[..., Path],
) -> None:
    """A page reads results only: a case file that was changed since changes nothing."""
    folder = changed_run(lambda data: data)
    (folder / "case.toml").write_text("[measured\n", encoding="utf-8")
    assert '<details id="measured"' not in write_report(folder).read_text(encoding="utf-8")
    measured = MeasuredFriction([0.1, 1.0], [0.3, 0.4], source="mu.csv")
    tree = netcdf.load_tree(folder / "dynamic.nc")
    record = (
        tree["inputs"]
        .to_dataset(inherit=False)
        .assign(measured_variables(measured, "measurement_of_case"))
    )
    netcdf.save(tree.to_dataset(), folder / "dynamic.nc", {"inputs": record})
    page = write_report(folder).read_text(encoding="utf-8")
    assert '<details id="measured"' in page


def test_model_without_waves_has_its_totals(tmp_path: Path) -> None:
    totals = dict(zip(TOTALS, (0.0123, 0.456, 0.451), strict=True))
    load = Load(3e5, 0.3, 0.1)
    data = predicted_answer(xr.Dataset(), totals, "converged", "toy", load)
    page = Page(write_report(netcdf.save(data, tmp_path / "toy.nc")))
    for text in ("0.0123", "0.456", "0.451 from energy lost", "(0.451 from dissipation)"):
        assert text in page.text
    assert not [a for _, a in page.tags if a.get("role") == "alert"]
    nowhere = dict.fromkeys(TOTALS, np.nan)
    data = predicted_answer(xr.Dataset(), nowhere, "no contact found", "toy", load)
    page = Page(write_report(netcdf.save(data, tmp_path / "toy.nc")))
    assert "Dynamic, 0.3 m/s: no contact found. There are no totals." in page.text
    assert [a for _, a in page.tags if a.get("role") == "alert"]


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


def test_foreign_netcdf_is_refused(tmp_path: Path) -> None:
    path = netcdf.save(xr.Dataset({"a": ("scale", [1.0])}), tmp_path / "other.nc")
    with pytest.raises(FileError, match="has no report: it holds no totals"):
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
