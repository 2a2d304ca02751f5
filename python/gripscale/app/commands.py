"""The commands that the page runs on a case: what each answers, and its options as fields."""

from __future__ import annotations

from gripscale.questions.registry import Form, FormField, forms

RUN_COMMAND = "run"


SPEEDS = FormField("--vary", "speeds", "0.003:30:log9", "speed=")
COMMANDS = (
    Form(RUN_COMMAND, "Contact and friction", "The case as it is stated."),
    Form("study", "Speed sweep", "Friction and contact area by speed.", (SPEEDS,)),
    Form(
        "study",
        "Map of speed and temperature",
        "Friction and contact area over both; the rubber needs a shift.",
        (
            FormField("--vary", "speeds", "0.003:30:log5", "speed="),
            FormField("--vary", "temperatures", "0 C:60 C:lin4", "temperature="),
        ),
    ),
    Form(
        "compare-rubbers",
        "Compounds on this road",
        "The rubber of the case beside others, on its road and under its load.",
        others="compounds",
    ),
    Form(
        "compare-surfaces",
        "Roads under this rubber",
        "The road of the case beside others, under its rubber and its load.",
        (FormField("--samples", "samples", "20"),),
        others="roads",
    ),
    Form(
        "compare",
        "Comparison of models",
        "What each assumption of the chain costs, against the direct contact.",
        (FormField("--rungs", "models", "waves,measured,theory"),),
    ),
    *forms(),
)  # fmt: skip
"""In the order of the page."""
