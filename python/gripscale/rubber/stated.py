"""What a caller states of a file of moduli: its columns, units and kind of modulus."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

from gripscale import checks
from gripscale.checks import shortened
from gripscale.errors import InputError
from gripscale.rubber.titles import modulus_kind, quantity
from gripscale.textfile import TextTable
from gripscale.units import in_si, listed, spelled

MODULI = ("storage", "loss", "loss_factor", "magnitude")
PAIRS = (
    ("storage", "loss"),
    ("storage", "loss_factor"),
    ("loss", "loss_factor"),
    ("magnitude", "loss_factor"),
)
"""Two that tell the modulus, the first choice first."""
QUANTITIES = ("temperature", "frequency", *MODULI)
"""What a column of a file of moduli may hold."""
THREE = ("frequency", "storage", "loss")
"""What three columns without names hold, in this order."""

Columns = Mapping[str, str | int] | Sequence[str | int]
"""Columns by quantity, or three of them; each by its title or its number from 1."""


@dataclass(frozen=True)
class Stated:
    """What is stated of a file; it goes before its titles, or after them if those come first."""

    columns: Mapping[str, str | int] = field(default_factory=dict)
    """Title or number from 1 of the column of a quantity."""
    units: Mapping[str, str | None] = field(default_factory=dict)
    """Unit of each kind of quantity, None where not stated."""
    modulus: str | None = None
    """E or G."""
    titles_first: bool = False
    """Whether what the titles say goes before what is stated here."""

    @property
    def expected(self) -> list[str]:
        """The titles to look for."""
        return [column for column in self.columns.values() if isinstance(column, str)]

    def in_order(self) -> Stated:
        """Return the same with frequency, storage and loss in the first three columns."""
        return replace(self, columns={name: at for at, name in enumerate(THREE, start=1)})

    def of(self, table: TextTable) -> Stated:
        """Return what counts for a table: no columns where its titles come first and name them."""
        if not (self.titles_first and self.columns):
            return self
        titles = replace(self, columns={})
        told = {one for one in QUANTITIES if titles.column(table, one) is not None}
        enough = "frequency" in told and any(told.issuperset(pair) for pair in PAIRS)
        return titles if enough else self

    def column(self, table: TextTable, wanted: str) -> int | None:
        """Return the column of a quantity; None if no title means it and none is stated.

        Raises `InputError` if several titles mean it, or there is no such column.
        """
        if wanted in self.columns:
            return position_of(table, self.columns[wanted])
        taken = {position_of(table, column) for column in self.columns.values()}
        named = [at for at, one in enumerate(table.columns) if quantity(one.name) == wanted]
        hits = [at for at in named if at not in taken]
        first = [row[hits[0]] for row in table.rows] if hits else []
        if any([row[at] for row in table.rows] != first for at in hits[1:]):
            raise InputError(
                f"{table.path}: columns must say which is the {wanted}, because {len(hits)} titles "
                f"mean it ({', '.join(table.columns[at].name for at in hits)})"
            )
        return hits[0] if hits else None

    def unit(self, table: TextTable, chosen: Sequence[int], kind: str) -> str:
        """Return the unit of the `chosen` columns; raise `InputError` if nothing states it."""
        given = self.units.get(kind)
        if given is not None:
            in_si(1.0, given, kind, f"{kind}_unit")
        written = {
            spelled(unit, kind) or unit for unit in (table.columns[at].unit for at in chosen)
        }
        one = next(iter(written)) if len(written) == 1 else None
        known = spelled(one, kind)
        if given is not None and not (self.titles_first and known):
            return given
        if known is None:
            what = "no unit" if one is None else checks.shown(one)
            raise InputError(
                f"{table.path}: {kind}_unit must be given ({listed(kind)}), because the header "
                f"states {what if len(written) == 1 else 'different units'}"
            )
        return known

    def modulus_of(self, table: TextTable, chosen: Sequence[int]) -> str:
        """Return E or G, whichever modulus the `chosen` columns hold."""
        given = self.modulus
        if given is not None:
            checks.one_of("modulus", given, ("E", "G"))
        titled = {modulus_kind(table.columns[at].name) for at in chosen}
        one = titled.pop() if len(titled) == 1 else None
        if given is not None and not (self.titles_first and one):
            return given
        if one is None:
            raise InputError(
                f"{table.path}: modulus must be given (E for Young's or G for shear), because the "
                "header does not tell"
            )
        return one


def columns_of(
    columns: Columns | None, quantities: Collection[str] = QUANTITIES
) -> dict[str, str | int]:
    """Return columns by quantity, of a mapping or of three in the order of a master curve.

    Raises `InputError` if they are neither.
    """
    if columns is None:
        return {}
    if isinstance(columns, Mapping):
        checks.known("quantity in columns", columns, quantities)
        return dict(columns)
    if (
        not isinstance(columns, Sequence)
        or isinstance(columns, str)
        or not all(isinstance(column, str | int) for column in columns)
        or len(columns) != len(THREE)
        or len(set(columns)) != len(THREE)
    ):
        raise InputError(
            "columns must be three different names or numbers from 1 for frequency, storage and "
            f"loss, or map quantities ({', '.join(quantities)}) to them; "
            f"got {checks.shown(columns)}"
        )
    return dict(zip(THREE, columns, strict=True))


def position_of(table: TextTable, column: str | int) -> int:
    """Return the position, from 0, of a column given by its number from 1 or by its title."""
    if not isinstance(column, str):
        return checks.counted(f"{table.path}: a column", column, len(table.columns))
    if table.names.count(column) != 1:
        known = table.titles or "no names"
        raise InputError(
            f"{table.path}: columns must be among the header's names ({known}); "
            f"got {checks.shown(column)}"
        )
    return table.names.index(column)


def missing(table: TextTable, what: str, argument: str) -> InputError:
    """Return the refusal of a table in which a quantity cannot be found."""
    names = shortened(", ".join(filter(None, table.names)))
    known = f"the header has {names}" if names else "no header"
    return InputError(f"{table.path}: {argument} must give the {what}; {known}")
