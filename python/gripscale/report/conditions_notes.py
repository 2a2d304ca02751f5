"""What a reader must know of the rubber in its conditions: what is held, what is missed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gripscale.figures.view import PredictionView

LARGE_MISFIT = 0.05
"""Of the softened series: friction errs by about as much."""

FLAGS = {
    "beyond_sweep": "the strain lies beyond what the softening was measured for; the last moduli "
    "are held",
    "beyond_shift": "the temperature lies beyond what the shift rests on",
}
"""What a wave may be flagged for, and in words."""


def conditions_sentences(one: PredictionView) -> Iterator[str]:
    """Yield a sentence for each doubt about the rubber of a prediction's waves."""
    for name, words in FLAGS.items():
        if one.has(name):
            yield from _of_waves(np.nan_to_num(one.usable(name)) > 0.0, words)
    if one.has("series_misfit"):
        misfit = np.nan_to_num(np.abs(one.usable("series_misfit")))
        worst = f"{misfit.max(initial=0.0):.0%}"
        words = f"the series misses the softened moduli by up to {worst}"
        yield from _of_waves(misfit > LARGE_MISFIT, words)


def _of_waves(flagged: np.ndarray, words: str) -> Iterator[str]:
    numbers = [str(at + 1) for at in np.flatnonzero(flagged)]
    if len(numbers) > 1 and len(numbers) == flagged.size:
        yield f"All {len(numbers)} waves: {words}."
    elif numbers:
        many = "s" if len(numbers) > 1 else ""
        yield f"Wave{many} {', '.join(numbers)}: {words}."
