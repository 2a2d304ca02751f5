"""The report of a run: inputs, surface, rubber, contact, evidence, method, how to run it again."""

from __future__ import annotations

import shlex
from pathlib import PurePath

import numpy as np

from gripscale import dataset
from gripscale.html_report import input_tables as inputs
from gripscale.html_report.blocks import blocks_image
from gripscale.html_report.charts.contact import contact_charts
from gripscale.html_report.charts.rubber import rubber_charts
from gripscale.html_report.charts.surface import correlation_charts, profile_charts
from gripscale.html_report.charts.verification import verification_charts
from gripscale.html_report.elements import Code, Element, Facts, Notice, Page, Section, Table, Text
from gripscale.html_report.equations import equations
from gripscale.html_report.notices import cards, notices
from gripscale.html_report.source import Run
from gripscale.html_report.wave_tables import wave_tables

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
    tables = {table.name: table for table in wave_tables(run.chains)}
    sections = [
        Section("inputs", "Inputs and their origin", _origin(run)),
        Section("surface", "Surface", _surface(run)),
        Section("rubber", "Rubber", _rubber(run)),
        Section("results", "Contact and friction, wave by wave", _results(run, tables)),
        Section("blocks", "Deformed blocks", _blocks(run)),
        Section("verification", "Verification", _verification(run, tables)),
        Section("method", "Method", method_elements()),
        Section(
            "again", "Software, and how to run it again", rerun_elements(run.attrs, case, command)
        ),
    ]
    return Page(
        f"Contact and friction: {case or 'result'}",
        "; ".join(chain.title for chain in run.chains),
        notices(run),
        cards(run),
        [section for section in sections if section.elements],
    )


def _origin(run: Run) -> list[Element]:
    elements: list[Element] = [inputs.load_facts(run)]
    if "file_name" in run.inputs:
        elements.append(inputs.files_table(run.inputs))
    return elements


def _surface(run: Run) -> list[Element]:
    record = run.inputs
    if "wave_wavelength" not in record:
        return []
    elements: list[Element] = []
    if "profile_name" in record:
        elements += [*inputs.cleaning_tables(record), *profile_charts(record)]
    if "lag" in record:
        elements += [*inputs.surface_facts(record), *correlation_charts(record)]
    else:
        elements.append(Text("The sine waves are stated in the case; no surface was measured."))
    return [*elements, inputs.waves_table(record)]


def _rubber(run: Run) -> list[Element]:
    record = run.inputs
    if "equilibrium_modulus_Pa" not in record.attrs:
        return []
    moving = [chain.column("angular_frequency") for chain in run.chains if chain.moving]
    excitation = moving[0] if moving else np.zeros(0)
    elements: list[Element] = [inputs.rubber_facts(record), *rubber_charts(record, excitation)]
    if "term_modulus" in record:
        elements.append(inputs.prony_table(record))
    return elements


def _results(run: Run, tables: dict[str, Table]) -> list[Element]:
    names = [name for name in ("load", "contact", "further") if name in tables]
    shown: list[Element] = [tables[name] for name in names]
    if any(not chain.moving for chain in run.chains):
        shown.insert(0, Text("Nothing slides at rest: the columns of friction are left out there."))
    return [*shown, *contact_charts(run.chains)]


def _blocks(run: Run) -> list[Element]:
    needed = ("surface_x", "surface_pressure", "mesh_x")
    drawn = [chain for chain in run.chains if all(chain.has(name) for name in needed)]
    if not drawn:
        return [Text("The result holds no deformed meshes.")]
    return [blocks_image(chain) for chain in drawn]


def _verification(run: Run, tables: dict[str, Table]) -> list[Element]:
    bad: list[Element] = [notice for notice in notices(run) if notice.level == "error"]
    if not bad:
        bad = [Notice("good", "Every wave converged.")]
    shown = [tables[name] for name in ("errors", "solution", "mesh") if name in tables]
    return [*bad, Text(EVIDENCE), *shown, *verification_charts(run.chains)]


def method_elements() -> list[Element]:
    """Return the equations with their sources."""
    return [Text(METHOD), *equations()]


def rerun_elements(attrs: dict[object, object], case: str, command: str) -> list[Element]:
    """Return versions, and the case file with the command that runs it."""
    names = [str(name) for name in attrs if str(name).startswith("version_")]
    solved = [(name.removeprefix("version_"), str(attrs[name])) for name in sorted(names)]
    here = ", ".join(f"{name} {version}" for name, version in dataset.versions().items())
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
