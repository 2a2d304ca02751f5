"""Errors of a rule by family, its scatter, and the share of cases that the scatter holds."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from gripscale.core import Array

Row = Mapping[str, str]
AREA_RANGE = 0.02, 0.6  # contact fractions of cases that count
NINETY = 1.645  # standard deviations on each side of a 90 % interval


def rows_of(path: Path) -> list[Row]:
    """Return the rows of a table that converged."""
    with path.open() as file:
        rows = [row for row in csv.DictReader(file) if row["status"] == "converged"]
    area = "block" if "block" in rows[0] else "layers area"
    return [row for row in rows if AREA_RANGE[0] < float(row[area]) < AREA_RANGE[1]]


def static_error(row: Row, rule: str = "rule") -> float:
    """Return ln of the rise of the area by the rule over that of the block [-]."""
    return float(np.log(_ratio(row, rule, "hard")) - np.log(_ratio(row, "block", "block_hard")))


def unsoftened(row: Row) -> float:
    """Return ln of the area without softening over that of the block [-]."""
    return -float(np.log(_ratio(row, "block", "block_hard")))


def sliding_error(row: Row, what: str, rule: str = "rule", judge: str = "layers") -> float:
    """Return ln of area or friction by the rule over those of the layers [-]."""
    return float(np.log(_ratio(row, f"{rule} {what}", f"{judge} {what}")))


def _ratio(row: Row, above: str, below: str) -> float:
    return float(row[above]) / float(row[below])


def by_family(rows: Sequence[Row], error: Callable[[Row], float]) -> dict[str, Array]:
    """Return the errors of each family."""
    families = dict.fromkeys(row["family"] for row in rows)
    return {
        family: np.array([error(row) for row in rows if row["family"] == family])
        for family in families
    }


def rms(errors: Array) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(errors**2)))


def covered(families: Mapping[str, Array]) -> Array:
    """Return the share of each family within 90 % by the scatter of the others, no offset."""
    out = []
    for family, errors in families.items():
        others = np.concatenate([e for name, e in families.items() if name != family])
        out.append(np.mean(np.abs(errors) < NINETY * rms(others)))
    return np.array(out)


def table(families: Mapping[str, Array]) -> Iterator[str]:
    """Yield a line for each family: cases, mean and scatter; then all, and the coverage."""
    shares = covered(families)
    for (family, errors), share in zip(families.items(), shares, strict=True):
        yield _line(family, errors, share)
    whole = np.concatenate(list(families.values()))
    sizes = np.array([errors.size for errors in families.values()])
    share = float(shares @ sizes / sizes.sum())
    yield _line("all", whole, share)


def _line(name: str, errors: Array, share: float) -> str:
    return f"| {name} | {errors.size} | {errors.mean():+.3f} | {rms(errors):.3f} | {share:.0%} |"
