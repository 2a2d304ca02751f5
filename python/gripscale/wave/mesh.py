"""The mesh of the finite-strain block."""

from __future__ import annotations

from dataclasses import dataclass

from gripscale import checks


@dataclass(frozen=True)
class Mesh:
    """Elements of the periodic block, one wavelength wide, graded towards the contact.

    Parameters
    ----------
    columns, rows : int
        Elements along the block and across it.
    depth : float
        Height of the block in wavelengths.
    element_order : int
        1: bilinear with one pressure; 2: biquadratic with linear discontinuous pressure.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    columns: int = 128
    rows: int = 20
    depth: float = 1.5
    element_order: int = 1

    def __post_init__(self) -> None:
        checked = {
            "columns": checks.whole("columns", self.columns, least=4, most=4096),
            "rows": checks.whole("rows", self.rows, least=2, most=256),
            "depth": checks.positive("depth", self.depth),
            "element_order": checks.whole("element_order", self.element_order, least=1, most=2),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)
