"""Rungs made by hand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from gripscale.analysis import Rung, Sample, SolvedRung


def sample(area: float, friction: float, of: str = "", **more: Any) -> Sample:
    status = more.pop("status", "converged")
    return Sample(area, friction, 1.02 * friction, status, of, **more)


@pytest.fixture
def solved() -> Callable[..., SolvedRung]:
    """Make a rung of samples (area, friction, of what), or ready ones."""

    def make(name: str, *samples: Any, follows: str = "") -> SolvedRung:
        rung = Rung(name, name, "group", "", follows, lambda _: [])
        made = [one if isinstance(one, Sample) else sample(*one) for one in samples]
        return SolvedRung(rung, made)

    return make
