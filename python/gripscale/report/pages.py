"""The report of a run: inputs, surface, rubber, contact, evidence, method, how to run it again."""

from __future__ import annotations

import base64
import io
import math
import shlex
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path, PurePath
from typing import Any

import numpy as np
import xarray as xr
from PIL import Image as Picture

from gripscale.analysis.ladder import DIRECT
from gripscale.analysis.propagation import of_same_inputs
from gripscale.case.run import KEY
from gripscale.charts.blocks import blocks_image, picture
from gripscale.charts.page_elements import (
    NONE,
    Card,
    Code,
    Element,
    Facts,
    Heading,
    Image,
    Notice,
    Page,
    Section,
    Table,
    Text,
    number,
    percent,
    telling,
    words_of,
)
from gripscale.charts.page_elements import Table as PageTable
from gripscale.charts.rubber import rubber_charts
from gripscale.charts.side_by_side import roads_friction_figure, roads_statistics_figure
from gripscale.charts.study import study_charts
from gripscale.charts.surface import correlation_charts, profile_charts
from gripscale.charts.wave_and_chain import contact_charts, verification_charts
from gripscale.core.provenance import versions
from gripscale.experiment.axis import COUNTS, axis_shown, name_of, of_numbers
from gripscale.io.text_table import read_bytes
from gripscale.report import tables_inputs as inputs
from gripscale.report.comparison_chapters import STALE, comparison_elements, effects_elements
from gripscale.report.equations import equations
from gripscale.report.notices import cards, exponent_sentence, notices, pointer, study_sentence
from gripscale.report.source import Compared, Run, Study, TextReport
from gripscale.report.tables_comparison import (
    judgement,
    roads_failures,
    roads_rows,
    roads_sentences,
    status,
    totals_cells,
)
from gripscale.report.tables_inputs import input_sections
from gripscale.report.tables_study import collapse_sentences, shift_sentence
from gripscale.report.tables_uncertainty import OF_ANOTHER, uncertainty_cards
from gripscale.report.wave_tables import wave_tables

METHOD = (
    "The measured surface is approximated by superposed sine waves. On each wave, largest first, "
    "a rubber block at finite strain is pressed and slid; the pressure in its contact is what the "
    "next wave receives."
)
EVIDENCE = (
    "The two friction coefficients of a wave are found independently, from the traction in the "
    "contact and from the energy lost in the rubber; by the balance of energy they are equal. "
    "What they differ by is the error of the discretisation."
)


def run_page(run: Run) -> Page:
    """Return the report of `run`."""
    case = PurePath(str(run.attrs.get("case_file", ""))).name
    command = shlex.join(["gripscale", "run", case or "case.toml"])
    tables = {table.name: table for table in wave_tables(run.by_wave)}
    sections = [
        Section("inputs", "Inputs and their origin", _origin(run)),
        Section("surface", "Surface", _surface(run)),
        Section("rubber", "Rubber", _rubber(run)),
        Section("results", "Contact and friction, wave by wave", _results(run, tables)),
        Section("effects", "What each effect is worth", effects_elements(run.effects)),
        Section("blocks", "Deformed blocks", _blocks(run)),
        Section("comparison", "Models side by side", _comparison(run)),
        Section("verification", "Verification", _verification(run, tables)),
        Section("method", "Method", method_elements()),
        Section(
            "again", "Software, and how to run it again", rerun_elements(run.attrs, case, command)
        ),
    ]
    sampled = own_uncertainty(run)
    stale = run.uncertainty is not None and sampled is None
    return Page(
        f"Contact and friction: {case or 'result'}",
        "; ".join(one.title for one in run.predictions),
        [*notices(run), *([Notice("warning", OF_ANOTHER)] if stale else [])],
        [*cards(run), *uncertainty_cards(sampled)],
        [section for section in sections if section.elements],
    )


def own_uncertainty(run: Run) -> xr.Dataset | None:
    """Return what was sampled of the very inputs of `run`, or None."""
    inputs, data = run.inputs, run.uncertainty
    if data is None:
        return None
    digests = None
    if "file_sha256" in inputs:
        digests = inputs["file_sha256"].values[inputs["file_role"].values != "measured"].tolist()
    return data if of_same_inputs(data, str(run.attrs.get("case", "")), digests) else None


def _origin(run: Run) -> list[Element]:
    elements: list[Element] = [inputs.load_facts(run)]
    if "file_name" in run.inputs:
        elements.append(inputs.files_table(run.inputs))
    return elements


def _surface(run: Run) -> list[Element]:
    record = run.inputs
    if "sines_wavelength" not in run.data or not record.data_vars:
        return []
    elements: list[Element] = []
    if "profile_name" in record:
        elements += [*inputs.cleaning_tables(record), *profile_charts(record)]
    if "lag" in record:
        count = run.data.sizes["wave"]
        elements += [*inputs.surface_facts(record, count), *correlation_charts(record)]
    else:
        elements.append(Text("The sine waves are stated in the case; no surface was measured."))
    return [*elements, inputs.waves_table(run.data)]


def _rubber(run: Run) -> list[Element]:
    record = run.inputs
    if "equilibrium_modulus_Pa" not in record.attrs:
        return []
    moving = [one for one in run.by_wave if one.moving]
    charts = rubber_charts(record, moving[0] if moving else None)
    elements: list[Element] = [inputs.rubber_facts(record), *charts]
    if "term_modulus" in record:
        elements.append(inputs.prony_table(record))
    return elements


def _results(run: Run, tables: dict[str, Table]) -> list[Element]:
    sentences = [(one.title, exponent_sentence(one.data)) for one in run.predictions]
    by_cut_off: list[Element] = [Text(f"{title}. {text}") for title, text in sentences if text]
    by_cut_off += judgement_elements(run)
    if not run.by_wave:
        whole = Text("The model does not go wave by wave; its totals stand above.")
        return [whole, *by_cut_off]
    names = [name for name in ("load", "contact", "conditions", "further") if name in tables]
    shown: list[Element] = [tables[name] for name in names]
    if any(not one.moving for one in run.by_wave):
        shown.insert(0, Text("Nothing slides at rest: the columns of friction are left out there."))
    return [*shown, *by_cut_off, *contact_charts(run.by_wave, run.direct)]


def judgement_elements(run: Run) -> list[Element]:
    """Return what the direct contact says, with the first prediction beside it."""
    if run.direct is None:
        return []
    return [Text(" ".join(judgement(run.predictions[0], run.direct)))]


def _blocks(run: Run) -> list[Element]:
    needed = ("surface_x", "surface_pressure", "mesh_x")
    drawn = [one for one in run.predictions if all(one.has(name) for name in needed)]
    if not drawn:
        return [Text("The result holds no deformed meshes.")]
    return [blocks_image(one) for one in drawn]


def _comparison(run: Run) -> list[Element]:
    """Return the comparison of just this case; another's is named and left out."""
    own = run.compared.of(run.attrs.get("case"))
    stale = [Notice("warning", STALE)] if len(own.parts) < len(run.compared.parts) else []
    return [*stale, *comparison_elements(own)]


def _verification(run: Run, tables: dict[str, Table]) -> list[Element]:
    if not run.by_wave:
        return []
    bad: list[Element] = [notice for notice in notices(run) if notice.level == "error"]
    if not bad:
        bad = [Notice("good", "Every wave converged.")]
    shown = [tables[name] for name in ("errors", "solution", "mesh") if name in tables]
    return [*bad, Text(EVIDENCE), *shown, *verification_charts(run.by_wave)]


def method_elements() -> list[Element]:
    """Return the equations with their sources."""
    return [Text(METHOD), *equations()]


def rerun_elements(attrs: dict[object, object], case: str, command: str) -> list[Element]:
    """Return versions, and the case file with the command that runs it."""
    names = [str(name) for name in attrs if str(name).startswith("version_")]
    solved = [(name.removeprefix("version_"), str(attrs[name])) for name in sorted(names)]
    solved += [("Key of the result", str(attrs[KEY]))] if KEY in attrs else []
    here = ", ".join(f"{name} {version}" for name, version in versions().items())
    elements: list[Element] = [Facts("Solved with", [*solved, ("This page written by", here)])]
    if "case" in attrs:
        name = case or "case.toml"
        elements.append(
            Text(
                f"Save the text below as {name}; the files it names are sought from its own "
                "folder, and their checksums are among the inputs."
            )
        )
        elements.append(Code("command", "Command", command))
        elements.append(Code("case", f"Case file {name}", str(attrs["case"])))
    return elements


# The report of a study: what was varied, totals of every prediction, curves over the axes.

NAMED_FAILURES = 12
"""Failed predictions named one by one at the head of the page."""


def study_page(study: Study) -> Page:
    """Return the report of `study`."""
    data = study.data
    failed = list(_failures(study))
    sections = [
        Section("axes", "What was varied", [_axes(study), *_over_reduced_speed(data)]),
        *input_sections(study),
        Section("totals", "Totals of every prediction", _study_totals(study)),
        Section("curves", "Curves", study_charts(study.data)),
        Section("method", "Method", method_elements()),
        Section(
            "again",
            "Software, and how to run it again",
            rerun_elements(data.attrs, "", _command(study)),
        ),
    ]
    return Page(
        str(data.attrs.get("title", f"Study {study.name}")),
        f"varied: {', '.join(words_of(data, axis) for axis in study.axes)}",
        [*_notices(failed), *_beyond(data)],
        _study_cards(study, len(failed)),
        [section for section in sections if section.elements],
    )


def _command(study: Study) -> str:
    """Return the command that makes a study of these axes."""
    varied = " ".join(
        shlex.join(["--vary", f"{name}={_spacing(study, name) or ','.join(_given(study, name))}"])
        for name in study.axes
    )
    chosen = " --model direct" if study.data.attrs.get("model") == "direct" else ""
    return f"gripscale study case.toml {varied}{chosen}"


def _spacing(study: Study, name: str) -> str:
    """Return evenly spaced values as `--vary` takes them, such as 0.01:10:log9; else nothing."""
    values = _values(study, name)
    if len(values) < 3 or not of_numbers(study.data, name) or name in COUNTS:
        return ""
    first, last = float(values[0]), float(values[-1])
    unit = " K" if name == "temperature" else ""
    for word, spaced in (("log", np.geomspace), ("lin", np.linspace)):
        if word == "log" and not first > 0.0:
            continue
        if np.allclose(values, spaced(first, last, len(values)), rtol=1e-11, atol=0.0):
            return f"{_plain(first)}{unit}:{_plain(last)}{unit}:{word}{len(values)}"
    return ""


def _given(study: Study, name: str) -> Iterator[str]:
    """Yield the values of an axis as `--vary` takes them."""
    unit = " K" if name == "temperature" else ""
    for value in _values(study, name):
        yield f"{_plain(value)}{unit}"


def _plain(value: Any) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value) or NONE


def totals_of(study: Study) -> list[str]:
    """Return the names of what there is one number or text of per prediction."""
    axes = set(study.axes)
    return [
        str(name)
        for name, variable in study.data.data_vars.items()
        if variable.dims and set(variable.dims) <= axes and not str(name).endswith("_key")
    ]


def _axes(study: Study) -> PageTable:
    rows = []
    for name in study.axes:
        values = [_place(study, name, i) for i in range(len(_values(study, name)))]
        variable = study.data.get(name, xr.DataArray())
        meaning = str(variable.attrs.get("long_name", name))
        unit = axis_shown(study.data, name).unit if of_numbers(study.data, name) else NONE
        rows.append([name.replace("_", " "), meaning, unit, str(len(values)), ", ".join(values)])
    headings = [
        Heading(text, words=True) for text in ("axis", "meaning", "unit", "values", "which")
    ]
    return PageTable("axes", "The axes of the study", headings, rows)


def _place(study: Study, name: str, i: int) -> str:
    """Return a value of an axis as tables show it, without its unit."""
    if name not in study.data.coords:
        return str(i + 1)
    if not of_numbers(study.data, name):
        return name_of(study.data, name, i)
    shown = number(axis_shown(study.data, name).of(study.data[name].values[i]), digits=4)
    return shown.rstrip("0").rstrip(".") if "." in shown else shown


def _over_reduced_speed(data: xr.Dataset) -> list[Element]:
    """Return how far temperatures lie apart over the reduced speed, where there are several."""
    over = [(f"{words} over a_T v", text) for words, text in collapse_sentences(data)]
    return [Facts("Speed and temperature", over)] if over else []


def _study_totals(study: Study) -> list[Element]:
    names = [name for name in totals_of(study) if telling(study.data[name])]
    if not names:
        return []
    headings = [
        Heading(words_of(study.data, name), _unit(study, name), words=_words(study, name))
        for name in [*study.axes, *names]
    ]
    rows: list[list[str]] = []
    bad: set[tuple[int, int]] = set()
    for i, (place, one) in enumerate(_predictions(study)):
        values = [one[name].values[()] for name in names]
        rows.append([*place, *(cell(value) for value in values)])
        if any(name.endswith("status") and not _good(one, name) for name in names):
            bad |= {(i, j) for j in range(len(headings))}
    caption = f"Totals of all {len(rows)} predictions"
    return [PageTable("totals", caption, headings, rows, bad=frozenset(bad))]


def _predictions(study: Study) -> Iterator[tuple[list[str], xr.Dataset]]:
    """Yield every point of the study: its place on the axes in words, and its Dataset."""
    sizes = [study.data.sizes[name] for name in study.axes]
    for index in product(*(range(size) for size in sizes)):
        at = dict(zip(study.axes, index, strict=True))
        yield [_place(study, name, i) for name, i in at.items()], study.data.isel(at)


def _values(study: Study, name: str) -> Sequence[Any]:
    """Return the coordinate of an axis, or its numbers where it has none."""
    if name in study.data.coords:
        return list(study.data[name].values)
    return list(range(1, study.data.sizes[name] + 1))


def cell(value: Any) -> str:
    """Return a number or a text as a table shows it; never empty."""
    if isinstance(value, int | float | np.number | np.bool_):
        return number(value, digits=4)
    return str(value) or NONE


def _unit(study: Study, name: str) -> str:
    if of_numbers(study.data, name):
        return axis_shown(study.data, name).unit
    unit = str(study.data[name].attrs.get("units", "")) if name in study.data.variables else ""
    return "" if unit == "1" else unit


def _words(study: Study, name: str) -> bool:
    return name in study.data.variables and study.data[name].dtype.kind not in "fiub"


def _good(one: xr.Dataset, name: str) -> bool:
    return str(one[name].values[()]) == "converged"


def _failures(study: Study) -> Iterator[str]:
    """Yield a sentence for each prediction that is not `converged`, or has a NaN total."""
    names = totals_of(study)
    states = [name for name in names if name.endswith("status")]
    totals = [n for n in names if n == "total_contact_fraction" or n == "contact_fraction"]
    for place, one in _predictions(study):
        where = ", ".join(_where(study, n, v) for n, v in zip(study.axes, place, strict=True))
        for name in states:
            if not _good(one, name):
                why = cell(one[name].values[()])
                yield f"{where}: NOT converged: {why}{pointer(why)}"
        if not states and any(math.isnan(float(one[name])) for name in totals):
            yield f"{where}: no total"


def _where(study: Study, axis: str, value: str) -> str:
    unit = _unit(study, axis)
    return f"{words_of(study.data, axis)} {value}{f' {unit}' if unit else ''}"


def _notices(failed: Sequence[str]) -> list[Notice]:
    shown = [Notice("error", text) for text in failed[:NAMED_FAILURES]]
    if len(failed) > NAMED_FAILURES:
        rest = len(failed) - NAMED_FAILURES
        shown.append(Notice("error", f"{rest} more did not converge; see the table of totals."))
    return shown


def _beyond(data: xr.Dataset) -> Iterator[Notice]:
    """Yield a warning if some of the friction rests on extrapolation."""
    text = study_sentence(data)
    if text:
        yield Notice("warning", f"{text} There the Prony series is an extrapolation.")
    shifted = shift_sentence(data)
    if shifted:
        yield Notice("warning", shifted)
    yield from (Notice("warning", text) for text in str(data.attrs.get("notes", "")).splitlines())


def _study_cards(study: Study, failed: int) -> list[Card]:
    count = math.prod(study.data.sizes[name] for name in study.axes)
    return [
        Card(
            "Predictions", str(count), " × ".join(words_of(study.data, axis) for axis in study.axes)
        ),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]


# The report of a comparison alone: the chapter, the case, how to run it again.


def comparison_page(compared: Compared) -> Page:
    """Return the report of `compared`."""
    first = compared.parts[0]
    case = PurePath(str(first.attrs.get("case_file", ""))).name or "case.toml"
    elements = comparison_elements(compared)
    command = shlex.join(["gripscale", "compare", case])
    data = compared.uncertainty
    own = data if data is not None and of_same_inputs(data, compared.case) else None
    stale = [Notice("warning", OF_ANOTHER)] if data is not own else []
    return Page(
        f"Models side by side: {case}",
        str(first.attrs.get("title", "")),
        [*(one for one in elements if isinstance(one, Notice)), *stale],
        [
            *([] if compared.ladder is None else _comparison_cards(compared.ladder)),
            *uncertainty_cards(own),
        ],
        [
            Section("comparison", "Models side by side", elements),
            Section("again", "Software, and how to run it again",
                    rerun_elements(first.attrs, case, command)),
        ],
    )  # fmt: skip


def _comparison_cards(ladder: xr.Dataset) -> list[Card]:
    """Return what the judging rung says, or the first one there is."""
    names = [str(name) for name in ladder.rung.values]
    one = ladder.isel(rung=names.index(DIRECT) if DIRECT in names else 0)
    bad = int(one.converged_samples) < int(one.samples)
    label = str(one.label.item())
    cards = []
    for name, text in (("contact_fraction", "Real contact area A_r/A_0"),
                       ("friction", "Friction coefficient μ")):  # fmt: skip
        sigma = percent(one[f"{name}_uncertainty"])
        cards.append(Card(text, number(one[f"total_{name}"]), f"{label}; ± {sigma}", bad))
    return cards


# The report of roads side by side.

WHAT = (
    "The same rubber under the same load on each road: in the chain of its sine waves, and in the "
    "direct contact of its whole profile. A range is 90 % of what other stretches of the same road "
    "might give; a difference lies beyond it where its own range does not hold zero."
)


def roads_page(data: xr.Dataset) -> Page:
    """Return the report of roads side by side."""
    case = PurePath(str(data.attrs.get("case_file", ""))).name or "case.toml"
    names = data.surface.values.tolist()
    totals = [_road_totals(data, model) for model in data.model.values.tolist()]
    notes = str(data.attrs.get("notes", "")).splitlines()
    again = f"gripscale compare-surfaces {data.attrs['surfaces']} --case {case}"
    statistics = picture(
        roads_statistics_figure(data),
        "roads-statistics",
        "Height difference correlation and spectrum of each road.",
        "Two panels of curves, one for each road.",
    )
    friction = picture(
        roads_friction_figure(data),
        "roads-friction",
        "Friction of all waves down to each wavelength, of the direct contact by the energy lost; "
        "bars are the ranges of the totals.",
        "A panel for each model with a curve for each road, rising towards short waves.",
    )
    return Page(
        f"Roads side by side: {', '.join(names)}",
        str(data.attrs.get("title", "")),
        [Notice("error", text) for text in roads_failures(data)],
        [],
        [
            Section("roads", "Contact and friction",
                    [Text(WHAT), *totals, *map(Text, [*roads_sentences(data), *notes]), friction]),
            Section("statistics", "The roads", [statistics]),
            Section("again", "Software, and how to run it again",
                    rerun_elements(data.attrs, case, again)),
        ],
    )  # fmt: skip


def _road_totals(data: xr.Dataset, model: str) -> Table:
    """Return the totals of one model on each road."""
    rows = roads_rows(data, model)
    return Table(
        f"roads-{model}",
        f"Totals, {model}",
        [
            Heading("road", words=True),
            *map(Heading, ("A_r/A_0", "range", "μ", "range", "μ less that of the first", "range")),
        ],
        [[row.name, *totals_cells(row)] for row in rows],
        bad=frozenset((i, 0) for i, row in enumerate(rows) if status(row.one) != "converged"),
    )


# The report of a calibration or of an uncertainty: what its command said, and its figures.

COMMANDS = {"calibration": "calibrate", "uncertainty": "uncertainty"}
"""What makes each of these results."""

CAPTIONS = {
    "measured_and_fitted": "Measured friction with its spread, the hysteresis alone, and the fit "
    "with its band, at each temperature.",
    "residuals": "Fitted less measured friction over the speed.",
    "profiles": "By how much the sum of squares rises where a parameter is held elsewhere.",
    "distributions": "How friction and contact area are distributed: quantiles, and the case.",
    "tornado_chain": "What each source does to the friction of the chain alone.",
    "tornado_direct": "What each source does to the friction of the direct contact alone.",
    "over_speed": "Medians over the speed, with bands of 50 and 90 % of the samples.",
    "over_pressure": "Medians over the pressure, with bands of 50 and 90 % of the samples.",
}
"""Captions of figures by their file."""


def told_page(told: TextReport) -> Page:
    """Return the report of `told`."""
    attrs = told.data.attrs
    case = PurePath(str(attrs.get("case_file", ""))).name
    command = shlex.join(["gripscale", COMMANDS[told.name], case or "case.toml"])
    text = [Code("said", "Tables and sentences", told.text)] if told.text else []
    sections = [
        Section("result", "Result", [*text]),
        Section("figures", "Figures", list(_figures(told.pictures))),
        Section("again", "Software, and how to run it again", rerun_elements(attrs, case, command)),
    ]
    title = str(attrs.get("title", told.name))
    named = [section for section in sections if section.elements]
    return Page(f"{title}: {case}" if case else title, "", [], [], named)


def _figures(pictures: list[Path]) -> Iterator[Image]:
    for path in pictures:
        content = read_bytes(path)
        caption = CAPTIONS.get(path.stem, path.stem.replace("_", " "))
        yield Image(
            path.stem,
            caption,
            caption,
            base64.b64encode(content).decode("ascii"),
            "image/png",
            *Picture.open(io.BytesIO(content)).size,
        )
