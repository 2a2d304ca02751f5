"""How far a variant is from the direct contact: ln(chain / direct) of area and friction."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from studies.chain_and_direct.table import Key, Numbers

Errors = dict[Key, NDArray[np.float64]]
"""By surface, rubber and speed: ln(chain / direct) of contact fraction and friction."""


def errors(chain: Mapping[Key, Numbers], direct: Mapping[Key, Numbers]) -> Errors:
    """Return the errors of a variant over all cases."""
    return {key: np.log(chain[key]) - np.log(direct[key]) for key in direct}


def rms(found: Errors, keys: Iterable[Key] | None = None) -> NDArray[np.float64]:
    """Return the rms error of area and friction."""
    values = np.array([found[key] for key in (found if keys is None else keys)])
    return np.asarray(np.sqrt(np.mean(values**2, axis=0)))


def mean(found: Errors) -> NDArray[np.float64]:
    """Return the mean error of area and friction."""
    return np.asarray(np.mean(list(found.values()), axis=0))


def worst(found: Errors) -> NDArray[np.float64]:
    """Return the largest error of area and friction."""
    return np.asarray(np.abs(list(found.values())).max(axis=0))


def held_out(
    candidates: Mapping[str, Errors], family: Mapping[str, str]
) -> tuple[Errors, dict[str, str]]:
    """Return errors on surfaces not used to choose, and what was chosen without each family.

    For each family the candidate closest on all others (area and friction alike) is taken.
    """
    out: Errors = {}
    chosen = {}
    keys = list(next(iter(candidates.values())))
    for one in dict.fromkeys(family.values()):
        others = [key for key in keys if family[key[0]] != one]
        best = min(candidates, key=lambda name: float((rms(candidates[name], others) ** 2).sum()))
        chosen[one] = best
        out |= {key: candidates[best][key] for key in keys if family[key[0]] == one}
    return out, chosen
