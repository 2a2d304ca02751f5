"""The commands that the page runs on a case: what each answers, and its options as fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

RUN = "run"


@dataclass(frozen=True)
class Option:
    """An option of a command: what the page calls it and what is in its field at first."""

    flag: str
    label: str
    value: str
    prefix: str = ""
    """Before the value on the command line, as in `--vary speed=...`."""
    choices: Sequence[tuple[str, str]] = ()
    """What the page calls the values it may have, and these; any text where there are none."""


@dataclass(frozen=True)
class Command:
    """A command of gripscale on a case, and what it answers."""

    name: str
    title: str
    about: str
    options: Sequence[Option] = ()
    others: str = ""
    """What files it needs beside the case, if any."""

    def arguments(self, values: Mapping[str, str], others: Sequence[str] = ()) -> list[str]:
        """Return what follows the case on the command line; an empty value leaves its option out.

        `values` are those of the fields by label, `others` the files beside the case.
        """
        words = list(others)
        for option in self.options:
            value = values.get(option.label, option.value).strip()
            if value:
                words += [option.flag, f"{option.prefix}{value}"]
        return words


MODELS = (("best for the surface", ""), ("direct contact", "direct"), ("chain", "chain"))
SHEAR_STRESSES = (
    ("gaussian in log speed", "gaussian"),
    ("constant", "constant"),
    ("Le Gal and Klüppel", "le_gal_klueppel"),
)
HELD_OUT = (("none", ""), ("each temperature", "temperature"), ("each decade of speed", "speed"))
SPEEDS = Option("--vary", "speeds", "0.003:30:log9", "speed=")
COMMANDS = (
    Command(RUN, "Contact and friction", "The case as it is stated."),
    Command("study", "Speed sweep", "Friction and contact area by speed.", (SPEEDS,)),
    Command(
        "study",
        "Map of speed and temperature",
        "Friction and contact area over both; the rubber needs a shift.",
        (
            Option("--vary", "speeds", "0.003:30:log5", "speed="),
            Option("--vary", "temperatures", "0 C:60 C:lin4", "temperature="),
        ),
    ),
    Command(
        "compare-rubbers",
        "Compounds on this road",
        "The rubber of the case beside others, on its road and under its load.",
        others="compounds",
    ),
    Command(
        "compare-surfaces",
        "Roads under this rubber",
        "The road of the case beside others, under its rubber and its load.",
        (Option("--samples", "samples", "20"),),
        others="roads",
    ),
    Command(
        "compare",
        "Comparison of models",
        "What each assumption of the chain costs, against the direct contact.",
        (Option("--rungs", "models", "waves,measured,theory"),),
    ),
    Command(
        "uncertainty",
        "Uncertainty",
        "The answer with the errors of its inputs, and the most important of them.",
        (Option("--samples", "samples", "200"),),
    ),
    Command("sensitivity", "What decides the grip", "Which inputs and frequencies, and how much."),
    Command("cut-off", "Cut-off", "Friction by the shortest wavelength that counts.",
            (Option("--down-to", "down to", "20 um"),)),
    Command("design", "Design of a compound", "Most friction for each rolling resistance."),
    Command("calibrate", "Area term",
            "Fitted to the measured friction of the case; drop it in the tab of the load.",
            (Option("--model", "model", "", choices=MODELS),
             Option("--law", "shear stress", "gaussian", choices=SHEAR_STRESSES),
             Option("--hold-out", "held out in turn", "", choices=HELD_OUT))),
)  # fmt: skip
"""In the order of the page."""
