"""The commands that the page runs on a case: what each answers, and its options as fields."""

from __future__ import annotations

from gripscale.questions.registry import Form, forms

RUN_COMMAND = "run"

COMMANDS = (Form(RUN_COMMAND, "Contact and friction", "The case as it is stated."), *forms())
"""In the order of the page."""
