"""The measured friction a case names."""

from __future__ import annotations

from gripscale.case.read import CaseFile
from gripscale.errors import about_keys
from gripscale.measured.friction import MeasuredFriction, read_measured_friction


@about_keys("measured")
def friction_of_case(file: CaseFile) -> MeasuredFriction | None:
    """Return what `[measured] friction` of a case names, None if it names nothing.

    Raises `FileError` if it cannot be read.
    """
    name = file.case.measured.friction
    return None if name is None else read_measured_friction(file.resolve(name))
