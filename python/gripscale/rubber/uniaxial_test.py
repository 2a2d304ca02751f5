"""Measured uniaxial tests: stretch and nominal stress against time."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.excel import read_sheets
from gripscale.textfile import file_path
from gripscale.units import in_si

Array = NDArray[np.float64]


@dataclass(frozen=True, init=False, eq=False)
class UniaxialTest:
    """A measured history of stretch with its nominal stress.

    Parameters
    ----------
    name : str
        What the test is called in messages and figures.
    time : array_like, shape (samples,)
        Rising [s], at least two samples.
    stretch : array_like, shape (samples,)
        Deformed over undeformed length [-], above zero; 1 at rest before the first sample.
    stress : array_like, shape (samples,)
        Nominal stress [Pa], somewhere above zero.

    Raises
    ------
    InputError
        If the lengths differ or a value is out of range.
    """

    name: str
    time: Array = field(repr=False)
    stretch: Array = field(repr=False)
    stress: Array = field(repr=False)

    def __init__(self, name: str, time: ArrayLike, stretch: ArrayLike, stress: ArrayLike) -> None:
        object.__setattr__(self, "name", checks.text("name", name))
        object.__setattr__(self, "time", checks.vector("time", time, unit="s"))
        object.__setattr__(self, "stretch", checks.positive_vector("stretch", stretch))
        object.__setattr__(self, "stress", checks.vector("stress", stress, unit="Pa"))
        lengths = len(self.time), len(self.stretch), len(self.stress)
        if len(set(lengths)) != 1 or lengths[0] < 2:
            raise InputError(
                f"{name}: time, stretch and stress must have the same length, at least 2; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        if (np.diff(self.time) <= 0.0).any():
            at = int(np.argmax(np.diff(self.time) <= 0.0)) + 1
            raise InputError(f"{name}: time must rise [s]; got {self.time[at]:g} at index {at}")
        if self.peak <= 0.0:
            raise InputError(f"{name}: stress must be above zero [Pa] somewhere")

    @property
    def peak(self) -> float:
        """Largest nominal stress [Pa]."""
        return float(self.stress.max())

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])


def read_uniaxial_test(path: str | Path, *, stress_unit: str = "Pa") -> UniaxialTest:
    """Read a test from the first sheet of an Excel file: time [s], stretch [-], nominal stress.

    Parameters
    ----------
    path : str or Path
        An xlsx file whose first three columns hold numbers in every row; no header.
    stress_unit : str
        Unit of the third column, e.g. "kPa".

    Raises
    ------
    FileError
        If openpyxl is missing (`pip install gripscale[formats]`) or the file is not as expected.
    InputError
        If the unit is unknown.
    """
    pascal = in_si(1.0, stress_unit, "modulus", "stress_unit")
    path = file_path(path)
    rows = next(iter(read_sheets(path).values()))
    try:
        if any(len(row) < 3 for row in rows):
            raise InputError("a row has fewer than three cells")
        table = np.array([row[:3] for row in rows], dtype=float).reshape(len(rows), 3)
        return UniaxialTest(path.stem, table[:, 0], table[:, 1], table[:, 2] * pascal)
    except (TypeError, ValueError) as error:
        raise FileError(f"{path}: expected rows of time, stretch, stress ({error})") from error
