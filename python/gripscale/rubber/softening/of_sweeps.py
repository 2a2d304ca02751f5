"""Softening from measured strain sweeps."""

from __future__ import annotations

from collections.abc import Sequence

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.softening.law import Deformation
from gripscale.rubber.softening.table import SofteningTable
from gripscale.rubber.strain_sweep import StrainSweep


def softening_of_sweeps(sweeps: Sequence[StrainSweep], *, measured_at: float) -> SofteningTable:
    """Return the softening that strain sweeps at one or several temperatures show.

    Parameters
    ----------
    sweeps : sequence of StrainSweep
        In any order; of several, each with another temperature.
    measured_at : float
        Strain amplitude at which the master curve was measured [-], in the deformation of the
        sweeps and within each of them.

    Raises
    ------
    InputError
        If sweeps are of different deformations, several are without or at one temperature, or
        `measured_at` lies outside a sweep.
    """
    sweeps = checks.instances("sweeps", sweeps, StrainSweep)
    kinds = sorted({sweep.deformation for sweep in sweeps})
    if len(kinds) != 1:
        told = " and ".join(kinds) or "none"
        raise InputError(f"sweeps must be at least one, all uniaxial or all shear; got {told}")
    known = [sweep.temperature for sweep in sweeps]
    if len(sweeps) > 1 and (None in known or len(set(known)) < len(known)):
        raise InputError(
            "several strain sweeps must each be at a temperature of its own; got "
            + ", ".join("none" if kelvin is None else f"{kelvin:g} K" for kelvin in known)
        )
    ordered = sorted(sweeps, key=lambda sweep: sweep.temperature or 0.0)
    deformation: Deformation = "shear" if kinds[0] == "shear" else "tension"
    return SofteningTable(
        strain=[sweep.strain.tolist() for sweep in ordered],
        storage=[sweep.storage.tolist() for sweep in ordered],
        loss=[sweep.loss.tolist() for sweep in ordered],
        measured_at=measured_at,
        deformation=deformation,
        temperature=None if None in known else [float(sweep.temperature or 0) for sweep in ordered],
    )
