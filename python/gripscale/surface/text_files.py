"""Profiles and maps from text files, with stated units and codes for missing heights.

A profile stands in two columns with units, in rows of either direction, in one column of heights
whose step is stated, or in CAPTIF's layout, whose point numbers jump where scans are joined: the
step is that of the distance column. A map stands in a table of heights, an image whose rows run
along y, or in points (x, y, z) in any order. Units are stated by the file or by the caller, never
guessed. Missing heights are rows left out, empty cells, or codes such as -9999: numbers in use as
one that lie ten times farther from all other heights than they lie from each other.
"""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from gripscale.core import Array, CaseKey, Finding, Topic, Words, checks, doubt
from gripscale.core.errors import FileError, InputError, about_file, unstated
from gripscale.core.units import UNITS, in_mm, listed, quantity_in_si, size_of_count, spelled
from gripscale.io.cells import Line
from gripscale.io.text_table import ColumnTitle, TextTable, column_in, read_lines, table_in
from gripscale.surface.header import Header, read_header, titled_lines
from gripscale.surface.profile import (
    FEWEST_POINTS,
    TURNED_ROUND,
    EvenGrid,
    HeightMap,
    Profile,
    even_grid,
)
from gripscale.surface.read_spectrum import is_spectrum, kind_of
from gripscale.surface.resampling import printed_grid, resample

_NINES = [float(f"{'9' * n}.{'9' * d}") for n in range(2, 10) for d in range(5) if n + d > 2]
_WORDS = [2.0**bits - less for bits in (15, 16, 31, 32) for less in (0.0, 1.0)]
# Codes in use, without sign: nines, and the limits of the whole numbers instruments store.
_CODES = np.array([*_NINES, *_WORDS])
_BEYOND = 1e30  # height, in any unit of length, beyond which every number is a code
_ALONE = 10.0  # least distance of a code from all heights, in the largest difference of two of them


def without_codes(heights: Array) -> tuple[Array, float | None]:
    """Return heights as printed, NaN where one is a code, and the code if there is one."""
    in_use = np.isin(np.abs(heights), _CODES) | (np.abs(heights) >= _BEYOND)
    for suspect in (in_use, heights == 0.0):  # laser profilers write zero far from the road
        codes = np.unique(heights[suspect])
        rest = heights[np.isfinite(heights) & ~suspect]
        if codes.size != 1 or rest.size == 0 or (codes[0] == 0.0 and np.ptp(rest) == 0.0):
            continue
        if np.abs(rest - codes[0]).min() > _ALONE * np.ptp(rest):
            return np.where(suspect, np.nan, heights), float(codes[0])
    return heights, None


def length_unit(
    path: Path, part: str, named: object, name: str, argument: str | None, *, remedy: str = "give"
) -> str:
    """Return the unit of a `part` ("column 1") of a file, which names `named` as its unit.

    `name` and `argument` are the caller's argument and the unit stated with it; `remedy` says what
    to do about a missing unit. Raises `FileError` if neither names a unit of length, `InputError`
    if the caller's unit is unknown or contradicts the file.
    """
    unit = str(named) if size_of_count(named, "length") else spelled(named, "length")
    if argument is not None:
        if unit is not None and quantity_in_si(1.0, unit, "length") != quantity_in_si(
            1.0, argument, "length", name
        ):
            raise InputError(f"{name} is {argument!r}, but {path} says {unit!r}; give one of them")
        return argument
    if unit is not None:
        return unit
    if not named:
        raise unstated(f"{path}: {part} names no unit of length; {remedy} ", name, kind=FileError)
    # not `missing`: what the file states is never proposed over
    problem = f"{path}: {part} is in {checks.short_repr(named)}, which is no known unit of length ("
    cure = ', a unit or the size of a count, such as "0.5 um"'
    raise FileError(Words(problem, f"{listed('length')}); give ", CaseKey(name), cure))


def _column_unit(
    table: TextTable, column: int, name: str, unit: str | None, header: str | None
) -> str:
    """Return the unit of a column: of its title, of the header, or stated as argument `name`."""
    part, titled = f"column {column + 1}", table.columns[column].unit
    # a factor of the header is that of counts, radians or volts in the title
    counted = bool(titled) and not spelled(titled, "length") and size_of_count(header, "length")
    named = header if counted else titled or header
    remedy = f"write it in the title, such as '{name[0]} [mm]', or give"
    return length_unit(table.path, part, named, name, unit, remedy=remedy)


_DISTANCE_TITLE = re.compile(
    r"^\W*(x\d*\b|x_|dist|pos|length|lateral|weg\b|abstand|l(ä|ae)nge|strecke|station|chainage|travel"
    r"|longueur|abscisse|distan[cz]|afstand|str(ä|ae)cka|avst(å|aa)nd|odległo|расст|距[离離]|位置)",
    re.IGNORECASE,
)
_ACROSS_TITLE = re.compile(r"^\W*(y\b|y_)", re.IGNORECASE)
_HEIGHT_TITLE = re.compile(
    r"^\W*(z\d*\b|z_|height|depth|h(ö|oe)he|tiefe|profondeur|elev|relative.height|profile"
    r"|(raw|total|primary|waviness|roughness) profile|hauteur|altitude|altezza|altura|hoogte"
    r"|h(ö|oe)jd|wysoko|выс|高[度さ])",
    re.IGNORECASE,
)
_TIME_TITLE = re.compile(r"^\W*(time|zeit|temps|tiempo|tempo|t|时间)(\b|_)", re.IGNORECASE)
_INDEX_TITLE = re.compile(
    r"^\W*((index|idx|no|nr|n°|id|points?|pts?|punkt|count|row|sample)[ _.]*(no|nr|number)?)?\W*$",
    re.IGNORECASE,
)
_UNIT_OF_INDEX = re.compile(r"px|pix(el)?s?|pts?|points?|samples?|#", re.IGNORECASE)
# Of columns and channels with a length these are no heights of a surface, or a part of them.
NO_HEIGHT = re.compile(
    r"deflection|error|amplitude|phase|intensit|quality|friction|lateral force|speed|filter"
    r"|waviness|^\W*roughness (profile|component)|welligkeit|rauheitsprofil|ondulation|iri\b|mpd\b",
    re.IGNORECASE,
)
# Most points of a grid, in points of the file: with fewer on it, the file is not on a grid.
_MOST_TIMES = 100


def _read_table(path: Path, lines: list[Line], expected: str) -> TextTable:
    titles = [_DISTANCE_TITLE, _ACROSS_TITLE, _HEIGHT_TITLE]

    def named(name: str) -> bool:
        return bool(kind_of(name)) or any(title.match(name) for title in titles)

    table = table_in(path, lines, expected, kinds=("length",), named=named)
    if not table.names:  # times alone: beside other titles they may be words, such as 12:03
        titles.append(_TIME_TITLE)
        table = table_in(path, lines, expected, kinds=("length",), named=named)
    if is_spectrum(table):
        raise FileError(
            f"{path}: expected heights; got the power spectrum of a surface, titled "
            f"{table.titles}: gripscale.read_spectrum, or spectrum in [surface], reads it"
        )
    return table


def _titled(table: TextTable, title: re.Pattern[str]) -> list[int]:
    return [at for at, column in enumerate(table.columns) if title.match(column.name)]


def _profile_columns(
    table: TextTable, channel: str | int | None, step: float | None, *, by_header: bool = False
) -> tuple[int | None, int]:
    """Return the columns of distances and heights; None for distances that the `step` states."""
    count = len(table.columns)
    x, z = _titled(table, _DISTANCE_TITLE), _titled(table, _HEIGHT_TITLE)
    times = [
        at
        for at, column in enumerate(table.columns)
        if at not in x and (_TIME_TITLE.match(column.name) or spelled(column.unit, "time"))
    ]
    few = count == 2 and not by_header
    numbered = [
        at for at in range(count) if _is_index(table.columns[at], few) and _counts(table, at)
    ]
    x = [at for at in x if at not in numbered]
    rest = [at for at in range(count) if at not in (*x, *times, *numbered)]
    # with a step, columns without titles are a table of heights
    if not x and not times and len(rest) > 1 and (step is None or not table.names):
        if len(rest) == 2 and (step is None or by_header):
            x, rest = rest[:1], rest[1:]
        elif channel is None:
            raise FileError(
                f"{table.path}, line {table.line_numbers[0]}: expected two columns, distance and "
                f"height, or titles that name them; got {count} columns "
                f"{f'titled {table.titles}' if table.titles else 'without such titles'}"
            )
    z = [at for at in z if at in rest] or rest
    z = [at for at in z if not _is_no_height(table.columns[at])] or z
    if channel is not None:
        numbers = {name: at for at, name in enumerate(table.names) if name}
        z = [numbers[channel] if channel in numbers else _column_number(table, channel)]
        x = [at for at in x if at not in z] or [at for at in rest if at not in z and not times][:1]
        x = [at for at in x if at < z[0]][-1:] or x[:1]  # of pairs its own
    if len(z) != 1 or len(x) > 1:
        listed_columns = ", ".join(f"{at + 1} {table.columns[at].name!r}" for at in z)
        words = f"{table.path}: expected one column of heights; got {listed_columns}; give "
        refusal = unstated(words, "channel", ", its title or number", kind=FileError)
        once = len(x) < 2 and all(table.names.count(table.columns[at].name) == 1 for at in z)
        refusal.choices = tuple(table.columns[at].name if once else at + 1 for at in z)
        raise refusal
    if not x and step is None:
        at, after = (*times, *numbered)[0], ", the distance between points"
        if times:
            seconds = float(np.median(np.diff(table.numbers(at, "a time")[:100])))
            after += f": the speed times {seconds:.4g} {table.columns[at].unit or ''}".rstrip()
        holds = f"column {at + 1}, {table.label(at)}, {'holds times' if times else 'counts points'}"
        words = f"{table.path}: {holds}, no distances: give "
        raise unstated(words, "step", after, kind=FileError)
    return (x[0] if x else None), z[0]


def _is_no_height(title: ColumnTitle) -> bool:
    """Return whether a column has the unit of something else than a length, or a name of one."""
    other = any(spelled(title.unit, kind) for kind in UNITS if kind != "length")
    return other or bool(NO_HEIGHT.search(title.name))


def _is_index(title: ColumnTitle, few: bool) -> bool:
    """Return whether a title is one of numbers of points; of `few` columns it must be there."""
    if title.unit is not None:
        return bool(_UNIT_OF_INDEX.fullmatch(title.unit.strip()))
    return bool(_INDEX_TITLE.match(title.name)) and (bool(title.name) or not few)


def _counts(table: TextTable, column: int) -> bool:
    if column + 1 == len(table.columns):
        return False
    with suppress(FileError):
        return bool((np.diff(table.numbers(column, "a number")) == 1.0).all())
    return False


def _column_number(table: TextTable, channel: str | int) -> int:
    if isinstance(channel, str):
        words = f" must be a title of a column ({table.titles or 'there are none'}); got "
        raise InputError(
            Words(f"{table.path}: ", CaseKey("channel"), words, checks.short_repr(channel))
        )
    return checks.counted(f"{table.path}: channel", channel, table.empty + len(table.columns)) - (
        table.empty
    )


def read_text_profile(
    path: Path,
    *,
    x_unit: str | None,
    z_unit: str | None,
    sheet: str | int | None = None,
    step: float | None = None,
    channel: str | int | None = None,
) -> Profile:
    """Read a profile from a text or Excel file with a distance and a height column.

    A `step` [m] stands for the distances of a file with one column, or with times; `channel` is the
    column of heights where there are several. Units are needed where the column titles do not name
    them. `notes` of the profile tell of rows that were reversed or left out, and of uneven
    distances put on equal ones. Raises `FileError`, which names the line, if the file cannot be
    read or understood, `InputError` if a unit is unknown or contradicts the file.
    """
    lines = titled_lines(read_lines(path, sheet=sheet))
    column, header = column_in(path, lines, kinds=("length",)), read_header(lines)
    table = column or _read_table(path, lines, "rows with two columns of numbers")
    pair = None if step is None else (step, step)
    steps = _stated_steps(path, pair, header.steps(max(2, len(table.rows))))
    spacing, by_header = (None, False) if steps is None else (steps[0], step is None)
    if column is None:
        x_column, z_column = _profile_columns(table, channel, spacing, by_header=by_header)
    elif steps is None:
        before = "expected two columns, distance and height; got one column of numbers: give "
        after = ', the distance between its points, such as "0.1 mm"'
        raise unstated(f"{path}: {before}", "step", after, kind=FileError)
    else:
        x_column, z_column = None, 0
    if x_column is not None:
        x_unit = _column_unit(table, x_column, "x_unit", x_unit, header.x_unit)
    z_unit = _column_unit(table, z_column, "z_unit", z_unit, header.z_unit)
    z, notes = _heights(table, z_column, z_unit)
    # the "Depth" of CAPTIF counts upwards: the steel plates on which its profilometer stands are
    # above the road in its files (https://github.com/captif-nz/captif-slp)
    captif = any("*****DATA*****" in text for _, text in lines[:20])
    doubts = () if captif else depth_doubts(table, z_column)
    if x_column is None and steps is not None:
        x, z = steps[0] * np.arange(z.size), quantity_in_si(z, z_unit, "length")
        return _profile(path, np.asarray(x, float), z, notes, doubts)
    if x_column is None or x_unit is None or step is not None:
        raise InputError(f"step must be left out; {path} states where its points are")
    x = table.numbers(x_column, f"a distance in column {x_column + 1}")
    numbers = table.line_numbers
    if x[0] > x[-1]:
        x, z, numbers = x[::-1], z[::-1], numbers[::-1]
        notes.append(TURNED_ROUND)
    grid = _even_grid(table, x_column, z_column, x, numbers)
    if grid is None:
        metres = quantity_in_si(x, x_unit, "length")
        return _resampled(path, metres, quantity_in_si(z, z_unit, "length"), notes, doubts)
    if grid.left_out:
        rows = "1 row" if grid.left_out == 1 else f"{grid.left_out} rows"
        notes.append(
            f"{rows} of the even grid not in the file, of {grid.size}: taken as missing heights"
        )
    x = quantity_in_si(grid.points(x), x_unit, "length")
    z = quantity_in_si(grid.spread(z), z_unit, "length")
    return _profile(path, x, z, notes, doubts)


# Of uneven steps the mean over the median: 1.4 of points at random, more of a scan with a long gap
# and of frequencies.
_MOST_UNEVEN = 2.0
_BRIDGE = 4.0  # mean steps over which a straight line is drawn: of points at random nearly all


def _even_grid(
    table: TextTable, x_column: int, z_column: int, x: Array, numbers: list[int]
) -> EvenGrid | None:
    """Return the grid of the distances, or None for uneven ones that rise throughout.

    Raises `FileError` for others, which says if those of the other column are in equal steps.
    """
    try:
        return printed_grid(table, x_column, x, numbers)
    except FileError as error:
        z = table.numbers(z_column, "a height", missing=True)
        if even_grid(z if z[0] < z[-1] else z[::-1], table.resolution(z_column)) is not None:
            titles = "exchange their titles" if table.titles else "write titles above them"
            raise FileError(
                f"{table.path}: columns {x_column + 1} and {z_column + 1} look exchanged: expected "
                f"distances in column {x_column + 1}, but column {z_column + 1} goes in equal "
                f"steps; {titles}, such as 'x [mm]' for distances and 'z [mm]' for heights",
                missing="titles",
            ) from error
        steps = np.diff(x)
        if steps.min() > 0.0 and steps.mean() <= _MOST_UNEVEN * np.median(steps):
            return None
        raise


def _resampled(
    path: Path, x: Array, z: Array, notes: list[str], doubts: tuple[Finding, ...]
) -> Profile:
    steps = np.diff(x)
    mean = float(steps.mean())
    with about_file(path):
        even = resample(x, z, mean, bridge=_BRIDGE * mean, name=path.stem, source=str(path))
    text = f"uneven steps of {in_mm(steps.min(), 3)} to {in_mm(steps.max(), 3)}"
    return replace(even, notes=(*notes, text, *even.notes), doubts=doubts)


def _profile(
    path: Path, x: Array, z: Array, notes: list[str], doubts: tuple[Finding, ...]
) -> Profile:
    with about_file(path):
        return Profile(x, z, path.stem, str(path), notes=tuple(notes), doubts=doubts)


# What a title says of heights that may be counted downwards.
_DEPTH = re.compile(r"depth|tiefe|profondeur|profundidad|profondit", re.IGNORECASE)


def depth_doubts(table: TextTable, column: int) -> tuple[Finding, ...]:
    """Return the doubt that a column of heights holds depths, if its title says so."""
    title = table.columns[column].name
    if not _DEPTH.search(title):
        return ()
    down, up = (CaseKey("z_axis", way) for way in ("down", "up"))
    text = f"column {column + 1}, titled {checks.short_repr(title)}, is taken as height, up: "
    cure = Words(down, " turns it over, ", up, " confirms it.")
    return (doubt(text, cure, topic=Topic.SURFACE),)


def _heights(table: TextTable, column: int, unit: str) -> tuple[Array, list[str]]:
    """Return heights as printed, NaN where missing, and what stands for missing ones."""
    z = table.numbers(column, f"a number in column {column + 1}", missing=True)
    if z.size < FEWEST_POINTS:
        raise FileError(f"{table.path}: expected at least {FEWEST_POINTS} points; got {z.size}")
    if np.isnan(z).all():
        raise FileError(f"{table.path}: expected heights; got {z.size} points, all missing")
    z, code = without_codes(z)
    notes = [] if code is None else [f"heights of {code:g} {unit} stand for missing ones"]
    return z, notes


def _stated_steps(
    path: Path, steps: tuple[float, float] | None, by_header: tuple[float, float] | None
) -> tuple[float, float] | None:
    """Return the caller's steps [m], or those that the file states, which must be the same."""
    if steps is None or by_header is None or np.allclose(steps, by_header, rtol=1e-6, atol=0.0):
        return steps or by_header
    by_caller, by_file = (
        " and ".join(in_mm(s) for s in dict.fromkeys(pair)) for pair in (steps, by_header)
    )
    raise InputError(f"step is {by_caller}, but {path} says {by_file}; give one of them")


def read_text_map(
    path: Path, *, x_unit: str | None, z_unit: str | None, step: tuple[float, float] | None
) -> HeightMap:
    """Read a map from a text file: a table of heights with a `step` along x and y [m], or points.

    Raises `FileError`, which names the line if possible, if the file cannot be read or understood,
    `InputError` if an argument is unknown or contradicts the file.
    """
    lines = titled_lines(read_lines(path))
    header = read_header(lines)
    table = _read_table(path, lines, "rows of heights, or of x, y and z")
    count = len(table.columns)
    titled = [_titled(table, t) for t in (_DISTANCE_TITLE, _ACROSS_TITLE, _HEIGHT_TITLE)]
    columns = [at for (at,) in titled] if all(len(hits) == 1 for hits in titled) else None
    if columns is None and count == 3:
        columns = [0, 1, 2]
    if columns is None:
        step = _stated_steps(path, step, header.steps(count, len(table.rows)))
    elif step is not None:
        raise InputError(f"step must be left out; {path} states where its points are")
    doubts: tuple[Finding, ...] = ()
    if columns is not None:
        x, y, z = _points(table, columns, x_unit, z_unit, header)
        doubts = depth_doubts(table, columns[2])
    elif count < FEWEST_POINTS:
        line = "; a line of two columns is for gripscale.read_profile" if count == 2 else ""
        raise FileError(
            f"{table.path}, line {table.line_numbers[0]}: expected three columns, x, y and z, or "
            f"a table of heights with at least {FEWEST_POINTS}; got {count}{line}"
        )
    elif step is None:
        raise unstated(
            f"{table.path}: a table of heights has no steps; give ",
            "step",
            ", the distance between points along x and y, such as 0.1 mm; a line above it may "
            "state it, too: # Spacing: 0.1 mm",
            kind=FileError,
        )
    else:
        z_unit = length_unit(table.path, "the table", header.z_unit, "z_unit", z_unit)
        heights = [
            table.numbers(column, f"a height in column {column + 1}", missing=True)
            for column in range(count)
        ]
        even = [even_grid(z, table.resolution(at)) for at, z in enumerate(heights[:2])]
        if even[0] is not None and even[1] is None:
            raise FileError(
                f"{path}: expected heights in column 1, which goes in equal steps: leave out the "
                "distances at the edges of the table, or write points x, y, z"
            )
        z = quantity_in_si(without_codes(np.array(heights))[0], z_unit, "length")
        x, y = (d * np.arange(n) for n, d in zip(z.shape, step, strict=True))
    with about_file(path):
        return HeightMap(x, y, z, path.stem, str(path), doubts=doubts)


def _points(
    table: TextTable, columns: list[int], x_unit: str | None, z_unit: str | None, header: Header
) -> tuple[Array, Array, Array]:
    """Return axes and heights [m] of points (x, y, z) in any order; those left out are NaN."""
    along, up = ("x_unit", x_unit, header.x_unit), ("z_unit", z_unit, header.z_unit)
    arguments = zip(columns, (along, along, up), strict=True)
    units = [_column_unit(table, column, *unit) for column, unit in arguments]
    axes, numbers = [], []
    for column, unit in zip(columns[:2], units[:2], strict=True):
        printed = table.numbers(column, f"a distance in column {column + 1}")
        distances, which = np.unique(printed, return_inverse=True)
        if distances.size < FEWEST_POINTS:
            raise FileError(
                f"{table.path}: expected a map of at least {FEWEST_POINTS} points a way; got "
                f"{distances.size} distances in column {column + 1}"
            )
        grid = printed_grid(table, column, distances)
        axes.append(quantity_in_si(grid.points(distances), unit, "length"))
        numbers.append(grid.number[which])
    printed = table.numbers(columns[2], f"a number in column {columns[2] + 1}", missing=True)
    heights, _ = without_codes(printed)
    nx, ny = (axis.size for axis in axes)
    if nx * ny > _MOST_TIMES * len(heights):
        raise FileError(
            f"{table.path}: expected points on a grid; got {len(heights)} on one of {nx} x {ny}"
        )
    at = numbers[0] * ny + numbers[1]
    order = np.argsort(at, kind="stable")
    repeated = np.flatnonzero(np.diff(at[order]) == 0)
    if repeated.size:
        first, second = (table.line_numbers[order[repeated[0] + i]] for i in (0, 1))
        raise FileError(
            f"{table.path}, line {second}: expected each point once; got that of line {first} again"
        )
    z = np.full(nx * ny, np.nan)
    z[at] = heights
    return axes[0], axes[1], quantity_in_si(z.reshape(nx, ny), units[2], "length")
