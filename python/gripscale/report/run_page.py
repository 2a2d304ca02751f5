"""The report of a run: inputs, surface, rubber, contact, evidence, method, how to run it again."""

from __future__ import annotations

import shlex
from pathlib import PurePath

import xarray as xr

from gripscale.case.resume import KEY
from gripscale.report import input_tables as inputs
from gripscale.report.blocks import blocks_image
from gripscale.report.charts.contact import contact_charts
from gripscale.report.charts.rubber import rubber_charts
from gripscale.report.charts.surface import correlation_charts, profile_charts
from gripscale.report.charts.verification import verification_charts
from gripscale.report.comparison_chapter import STALE, comparison_elements
from gripscale.report.comparison_table import judgement
from gripscale.report.cut_off import exponent_sentence
from gripscale.report.effects_chapter import effects_elements
from gripscale.report.elements import Code, Element, Facts, Notice, Page, Section, Table, Text
from gripscale.report.equations import equations
from gripscale.report.notices import cards, notices
from gripscale.report.source import Run
from gripscale.report.uncertainty_summary import OF_ANOTHER, uncertainty_cards
from gripscale.report.wave_tables import wave_tables
from gripscale.uncertainty import of_same_inputs
from gripscale.versions import versions

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
