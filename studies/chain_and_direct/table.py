"""Numbers kept line by line in a file, so that an interrupted study goes on where it stopped."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

Key = tuple[str, ...]


class Numbers(NamedTuple):
    """Contact fraction and friction coefficient."""

    contact_fraction: float
    friction: float


def numbers(path: Path, keys: Iterable[Key], solve: Callable[[Key], Numbers]) -> dict[Key, Numbers]:
    """Return what `solve` says for each key, read from the file where it is already there."""
    known: dict[Key, Numbers] = {}
    if path.exists():
        with path.open(newline="", encoding="utf-8") as file:
            known = {tuple(r[:-2]): Numbers(float(r[-2]), float(r[-1])) for r in csv.reader(file)}
    wanted = list(keys)
    with path.open("a", newline="", encoding="utf-8") as file:
        for key in wanted:
            if key not in known:
                known[key] = solve(key)
                csv.writer(file).writerow([*key, *(f"{value:.6g}" for value in known[key])])
                file.flush()
    return {key: known[key] for key in wanted}
