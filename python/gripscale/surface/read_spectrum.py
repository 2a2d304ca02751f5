"""Read the power spectrum of a surface from a file, in the units and the convention it states.

Units are powers of lengths. A density in m^4 is that of a surface; in m^3, of lines, it becomes
that of their isotropic surface. Logarithms are raised. Programs differ in what their density is:

    "q"                     <z^2> = int C_1 dq = 2 pi int q C dq        C, C(q): B. N. J. Persson
    "1/wavelength"          <z^2> = int C_1 df = 2 pi int f C df        f = 1/wavelength: ISO 8608
    "contact.engineering"   <z^2> = int C_1 dq/pi = int q C dq/(2 pi)   C_iso, 1D PSD, q/π × 2D PSD

(T. D. B. Jacobs, T. Junge, L. Pastewka, Surf. Topogr. Metrol. Prop. 5 (2017) 013001,
doi:10.1088/2051-672X/aa51f8). They differ by up to 40; a title "PSD" may be any: it is asked for.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from pathlib import Path

import numpy as np

from gripscale.core import Array, CaseKey, GripscaleError, InputError, Words, checks, unstated
from gripscale.core.errors import about_file
from gripscale.core.units import UNITS, spelled
from gripscale.io.text_table import ColumnTitle, TextTable, file_path, read_table
from gripscale.surface.random_phases import Spectrum
from gripscale.surface.spectrum import ProfileSpectrum, areal_spectrum

# What the densities of lines and of surfaces are divided by.
_CYCLE = 2.0 * math.pi
NORMALIZATIONS = {"q": (1.0, 1.0), "1/wavelength": (_CYCLE, _CYCLE**2)}
NORMALIZATIONS |= {"contact.engineering": (0.5 * _CYCLE, _CYCLE**2)}
_TITLES = {
    "1/wavelength": r"1 ?/ ?(wave ?length|λ|lambda|wellenlänge)|spatial freq|ortsfreq",
    "wavelength": r"wave ?length|wellenlänge|λ|lambda",
    "q": r"q\b(?! ?/ ?π)|k\b|wave ?(number|vector)|wellenzahl",
    "density": r"c\b|c_|c\^|c ?\(|q ?/ ?π|.*(psd|power|spectr|leistungsdichte)",
}
_LOGARITHM = re.compile(r"(log_?10|log|lg|ln)(?![a-z])[\s_]*\(?\s*", re.IGNORECASE)
_RULES = {
    "contact.engineering": re.compile(r"[12]d psd|c[_^]\{?iso|q ?/ ?π", re.IGNORECASE),
    "q": re.compile(r"c\b(?! ?\()|c_?1\b(?! ?\()|.*\bc(_1)?\(q\)", re.IGNORECASE),
}
_FACTOR = re.compile(r"([^\W\d_]+)\^?\{?\(?(-?[1-4])?\)?\}?")
_DIGITS = str.maketrans("⁻⁰¹²³⁴", "-01234")
_UNITS = {
    "wavenumber_unit": "1/m, um^-1, cycles/m or, of wavelengths, mm",
    "density_unit": "m^4, um^4 or nm^2 um^2 of a surface, m^3 or um^3 of lines",
}


def _bare(title: ColumnTitle) -> tuple[ColumnTitle, float | None]:
    """Return a title without its logarithm, and the base of that, if any."""
    name, unit = title.name.strip(), title.unit or ""
    if unit in ("q", "k", "f"):  # C(q) without a unit
        name, unit = f"{name}({unit})", ""
        title = ColumnTitle(name)
    if (logarithm := _LOGARITHM.match(name)) is None:
        return title, None
    name = name[logarithm.end() :]
    if not name:  # log10(C / m^4)
        name, _, unit = unit.partition("/")
    name = name[:-1] if name.count("(") < name.count(")") else name
    base = math.e if logarithm[1].lower() == "ln" else 10.0
    return ColumnTitle(name.strip(), unit.strip("() ") or None), base


def kind_of(title: str) -> str:
    """Return what a column with this title holds: an axis of a spectrum, "density", or nothing."""
    bare = _bare(ColumnTitle(title))[0].name
    hits = (kind for kind, titles in _TITLES.items() if re.match(titles, bare, re.IGNORECASE))
    return next(hits, "")


def is_spectrum(table: TextTable) -> bool:
    """Return whether titles name wavenumbers or wavelengths, and a density."""
    kinds = {kind_of(_bare(title)[0].name) for title in table.columns} - {""}
    return "density" in kinds and len(kinds) > 1


def _table(path: Path) -> TextTable:
    return read_table(path, "a row of a spectrum", kinds=(), named=lambda name: bool(kind_of(name)))


def holds_spectrum(path: Path) -> bool:
    """Return whether a file has the titles of a spectrum."""
    with suppress(GripscaleError):
        return is_spectrum(_table(path))
    return False


def _size(path: Path, title: ColumnTitle, key: str, option: str | None) -> tuple[float, int]:
    """Return size [m^n] and n of a unit of powers of lengths, from an option or by the title."""
    unit, expected = option or title.unit, _UNITS[key]
    if unit is None:
        why = f" must be given ({expected}): nothing states it of {title.name}"
        raise unstated(f"{path}: ", key, why)
    text = re.sub(r"^(rad|cycles?|1) ?/ ?\(?", "/", unit.translate(_DIGITS).replace("**", "^"))
    sign = -1 if text.startswith("/") else 1
    parts = [_FACTOR.fullmatch(part) for part in re.split(r"[\s·*.]+", text.strip("/() "))]
    factors = [(spelled(p[1], "length"), sign * int(p[2] or 1)) for p in parts if p is not None]
    power = sum(exponent for _, exponent in factors)
    powers = {"density": (3, 4), "wavelength": (1,)}.get(kind_of(title.name), (-1,))
    if None in (*parts, *(length for length, _ in factors)) or power not in powers:
        problem = f"{path}: {title.name} is in {checks.short_repr(unit)}, which is no unit of it ("
        raise InputError(Words(f"{problem}{expected}); give ", CaseKey(key)))
    return math.prod(UNITS["length"][str(length)] ** n for length, n in factors), power


def read_spectrum(
    path: str | Path,
    *,
    wavenumber_unit: str | None = None,
    density_unit: str | None = None,
    normalization: str | None = None,
    phases: str = "real",
) -> Spectrum:
    """Read the power spectrum of a surface, or of its lines, from a text or Excel file.

    Raises `FileError` if the file cannot be read, and `InputError` if its titles name no columns of
    a spectrum, or a unit or the normalization is not stated or unknown.

        >>> gs.read_spectrum("psd.csv").wavenumber.size
        3

    Parameters
    ----------
    wavenumber_unit, density_unit : str, optional
        Such as "1/um" and "um^4", in place of those of the titles.
    normalization : str, optional
        What the density is, one of `NORMALIZATIONS`, where its title does not tell.
    phases : str
        As of `gripscale.Spectrum`.
    """
    file = file_path(path)
    table = _table(file)
    if not is_spectrum(table):
        got = table.titles or "no titles"
        raise InputError(f"{file}: expected columns titled q and C(q), or alike; got {got}")
    columns: dict[bool, tuple[ColumnTitle, Array]] = {}
    for at, column in enumerate(table.columns):
        title, base = _bare(column)
        if kind := kind_of(title.name):
            values = table.numbers(at, "a number", missing=True)
            numbers = values if base is None else base ** np.minimum(values, 300.0)
            columns.setdefault(kind == "density", (title, numbers))
    (axis, x), (title, density) = columns[False], columns[True]
    size, power = _size(file, axis, "wavenumber_unit", wavenumber_unit)
    q = size * x if power < 0 else 1.0 / (size * x)
    cycles = "cycle" in (wavenumber_unit or axis.unit or "")
    q = q if kind_of(axis.name) == "q" and not cycles else 2.0 * np.pi * q
    size, power = _size(file, title, "density_unit", density_unit)
    rule = normalization or next((r for r, t in _RULES.items() if t.match(title.name)), None)
    if rule is None:
        why = (
            f"{', '.join(NORMALIZATIONS)}): {title.name} may mean any, and they differ by up to 40"
        )
        raise unstated(f"{file}: ", "normalization", f" must be given ({why}")
    line, areal = NORMALIZATIONS[checks.one_of("normalization", rule, NORMALIZATIONS)]
    if re.match("q ?/ ?π", title.name):
        density, power = np.pi * density / q, 4
    kept = np.flatnonzero(np.isfinite(q) & np.isfinite(density))
    kept = kept[np.argsort(q[kept])]
    q, density = q[kept], size * density[kept]
    with about_file(file):
        if power == 3:
            surface = areal_spectrum(ProfileSpectrum(q, density / line))
            q, density, areal = surface.wavenumber, surface.density, 1.0
        return Spectrum(q, density / areal, name=file.stem, source=str(file), phases=phases)
