"""The report of a calibration or of an uncertainty: what its command said, and its figures."""

from __future__ import annotations

import base64
import io
import shlex
from collections.abc import Iterator
from pathlib import Path, PurePath

from PIL import Image as Picture

from gripscale.report.elements import Code, Image, Page, Section
from gripscale.report.run_page import rerun_elements
from gripscale.report.source import Told
from gripscale.textfile import read_bytes

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


def told_page(told: Told) -> Page:
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
