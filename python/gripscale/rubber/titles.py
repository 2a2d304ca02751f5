"""What the titles of master curves and sweeps say, in the English and German of instruments.

| quantity | titles |
|---|---|
| temperature | T, Temp., Temperature, Temperatur, Probentemperatur |
| frequency | f, freq, Frequency, Frequenz, Angular frequency, Kreisfrequenz, omega |
| storage | E', G', E_stor, Storage modulus, Speichermodul |
| loss | E'', G'', E", E_loss, Loss modulus, Verlustmodul |
| loss_factor | tan delta, tan(d), Loss factor, Verlustfaktor, Damping factor |
| magnitude | E*, G*, |E*|, Complex modulus, Komplexer Modul |
| strain | Strain, Shear strain, Strain amplitude, Dehnung, Verformung, Deformation, gamma |

Logarithms are none of these.
"""

from __future__ import annotations

import re

_PATTERNS = {
    "loss_factor": r"tan\b|tan[\s_(]*(d|δ)|(loss|damping|dissipation) factor|verlustfaktor",
    "temperature": r"temp|(sample|proben)\s*-?temp",
    "frequency": r"omega|.*freq",
    "magnitude": r"\|?[eg]\*|.*complex .*modulus|.*komplexer .*modul",
    "storage": r"[eg]'(?!')|[eg][_ ]?stor|.*\bstor|.*speichermodul",
    "loss": r"[eg]''|[eg][_ ]?loss|.*\bloss|.*verlustmodul",
    "strain": r".*strain\b|.*dehnung|.*verformung|.*deformation|gamma\b|.*scherung",
}
_KNOWN = {name: re.compile(pattern) for name, pattern in _PATTERNS.items()}
_OTHER = re.compile(
    r"log|ln\b|lg\b|eta\b|η|visco|visko|complian|torque|phase|rate\b|static|statisch"
)
_LETTERS = {
    "T": "temperature",
    "f": "frequency",
    "ω": "frequency",
    "w": "frequency",
    "γ": "strain",
}
"""Letters that are a title by themselves: t is a time and F a force."""
_BARE_PRIMES = re.compile(r'(?<!["\w])[EG]"(?=\s*(?:[\t;,(\[/]|\s|$))')
_NUMBER = r"[-+]?\d+(?:[.,]\d+)?"
_STATED = re.compile(
    rf"(?:^|[\s;,#%!])(?:T|Temp\w*|Sample temp\w*|Probentemp\w*)\.?\s*"
    rf"(?:[\[(]\s*(?P<before>[^\])]+)[\])])?\s*[=:;,\t]\s*\"?(?P<number>{_NUMBER})\"?"
    rf"(?:[\t;,]?[ \t]*[\[(]?(?P<after>°?\s?[A-Za-z]+)[\])]?)?\s*(?:$|[;,\t\"])",
    re.IGNORECASE,
)


def quantity(name: str) -> str | None:
    """Return the quantity a column `name` clearly means, else None."""
    text = plain(name)
    if not text[1:2].isalpha() and text[:1] in _LETTERS:
        return _LETTERS[text[0]]
    if len(text) == 1:
        return None
    low = text.lower()
    if _OTHER.search(low):
        return None
    return next((one for one, pattern in _KNOWN.items() if pattern.match(low)), None)


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
    if re.search(r"shear|schub", text, re.IGNORECASE):
        found.add("G")
    return found.pop() if len(found) == 1 else None


def plain(name: str) -> str:
    """Return the name with one kind of prime, so that E'' can be told from E'."""
    text = name.strip()
    for prime in ("’", "′", "`", "´"):
        text = text.replace(prime, "'")
    return text.replace("″", "''").replace("”", "''").replace('"', "''")


def with_primes(line: str) -> str:
    """Return a line of titles with E'' and G'' where it has E" and G" outside quotation marks."""
    start = 0
    while found := _BARE_PRIMES.search(line, start):
        start = found.end()
        if line.count('"', 0, start) % 2:
            line = f"{line[: start - 1]}''{line[start:]}"
    return line


def stated_temperature(line: str) -> tuple[str, str | None] | None:
    """Return number and unit of the temperature a line above the rows states, such as T = 20 °C.

    The unit is None where the line has none. None if the line states no temperature.
    """
    found = _STATED.search(line.strip())
    if found is None:
        return None
    return found["number"], found["before"] or found["after"]
