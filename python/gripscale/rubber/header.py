"""What the titles of a master curve say: which column is what, and which modulus it is."""

from __future__ import annotations

import re


def quantity(name: str) -> str | None:
    """Return `frequency`, `storage` or `loss` if the column `name` clearly says so, else None."""
    text = plain(name)
    low = text.lower()
    if "factor" in low or "tan" in low or "log" in low:
        return None
    if "freq" in low or low in {"f", "omega", "ω"}:
        return "frequency"
    if "loss" in low or re.match(r"^[eg]''", low):
        return "loss"
    if "stor" in low or re.match(r"^[eg]'", low):
        return "storage"
    return None


def is_temperature(name: str) -> bool:
    """Return whether the column `name` clearly says that it holds temperatures."""
    return bool(re.match(r"(t|temp|temperature)\b", name.strip().lower()))


def modulus_kind(name: str) -> str | None:
    """Return `E` or `G` if the column `name` says which modulus it is, else None."""
    text = plain(name)
    found = set()
    if re.search(r"(?<![A-Za-z])E(?![A-Za-z])", text.replace("_", " ")):
        found.add("E")
    if re.search(r"(?<![A-Za-z])G(?![A-Za-z])", text.replace("_", " ")):
        found.add("G")
    if re.search(r"young|tensile", text, re.IGNORECASE):
        found.add("E")
    if re.search(r"shear", text, re.IGNORECASE):
        found.add("G")
    return found.pop() if len(found) == 1 else None


def plain(name: str) -> str:
    """Return the name with one kind of prime, so that E'' can be told from E'."""
    text = name.strip()
    for prime in ("’", "′", "`", "´"):
        text = text.replace(prime, "'")
    return text.replace("″", "''").replace("”", "''").replace('"', "''")
