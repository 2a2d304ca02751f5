"""The page of limits denies no effect that conditions have."""

from __future__ import annotations

from dataclasses import fields

import pytest

from gripscale.conditions import Conditions
from tests.samples import DOCS

PAGE = " ".join((DOCS / "limits.md").read_text(encoding="utf-8").split())
WORDS = {
    "temperature": "temperature of the rubber",
    "softening": "Payne effect",
    "heat": "flash temperature",
    "shear_stress": "area term",
}
"""What the page calls each effect."""


@pytest.mark.parametrize("effect", sorted(WORDS))
def test_an_effect_is_stated_with_its_page_and_not_denied(effect: str) -> None:
    assert effect in {field.name for field in fields(Conditions)}
    bullets = [text for text in PAGE.split("- **") if WORDS[effect] in text]
    assert bullets
    assert all("](conditions.md" in text for text in bullets)
    sentences = [text for bullet in bullets for text in bullet.split(". ") if WORDS[effect] in text]
    assert not any(text.startswith("No ") or "not in the model" in text for text in sentences)
