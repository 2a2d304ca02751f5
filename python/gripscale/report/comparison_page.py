"""The report of a comparison alone: the chapter, the case, how to run it again."""

from __future__ import annotations

import shlex
from pathlib import PurePath

import xarray as xr

from gripscale.figures.rungs import JUDGE
from gripscale.report.comparison_chapter import comparison_elements
from gripscale.report.elements import Card, Notice, Page, Section
from gripscale.report.numbers import number, percent
from gripscale.report.run_page import rerun_elements
from gripscale.report.source import Compared
from gripscale.report.uncertainty_summary import OF_ANOTHER, uncertainty_cards
from gripscale.uncertainty import of_same_inputs


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
        [*([] if compared.ladder is None else _cards(compared.ladder)), *uncertainty_cards(own)],
        [
            Section("comparison", "Models side by side", elements),
            Section("again", "Software, and how to run it again",
                    rerun_elements(first.attrs, case, command)),
        ],
    )  # fmt: skip


def _cards(ladder: xr.Dataset) -> list[Card]:
    """Return what the judging rung says, or the first one there is."""
    names = [str(name) for name in ladder.rung.values]
    one = ladder.isel(rung=names.index(JUDGE) if JUDGE in names else 0)
    bad = int(one.converged_samples) < int(one.samples)
    label = str(one.label.item())
    cards = []
    for name, text in (("contact_fraction", "Real contact area A_r/A_0"),
                       ("friction", "Friction coefficient μ")):  # fmt: skip
        sigma = percent(one[f"{name}_uncertainty"])
        cards.append(Card(text, number(one[f"total_{name}"]), f"{label}; ± {sigma}", bad))
    return cards
