"""Flow of a fluid through the gap between rubber and surface: Reynolds' equation on a map.

    div(h^3 grad P) = 0,    <grad P> = 1 along an axis,    phi = <h^3 dP/dx> / <h>^3

O. Reynolds, Phil. Trans. R. Soc. 177 (1886) 157, doi:10.1098/rstl.1886.0005; N. Patir & H. S.
Cheng, J. Lubr. Technol. 100 (1978) 12, doi:10.1115/1.3453103. Finite volumes: points are cells,
and neighbours exchange with the harmonic mean of their h^3. With s the largest |ln phi_c / phi| of
the four grids of every second point, the error of a grid is phi e^-cs to phi e^cs, and from zero if
one of them does not percolate; its evidence is in docs/seals.md.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

import gripscale
from gripscale.core import Array, InputError, Mask, Pictured, checks, labelled, provenance, readable
from gripscale.flow.multigrid import Multigrid, laplacian
from gripscale.half_space.regions import periodic_regions
from gripscale.half_space.result import RoughContact

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Gap over its mean below which a point is closed: less than the contact is solved to.
NARROWEST = 1e-8
# Relative errors of a flow factor from the iteration, and of those of every second point.
FLOW_TOLERANCE, COARSE_FLOW_TOLERANCE = 1e-6, 1e-3
ERROR_SHARE = 0.5  # c, the error of a grid over its difference from those of twice the spacing
FEWEST_CELLS = 8  # points along each axis from which a grid with half of them is of use


@dataclass(frozen=True)
class Junction:
    """Narrowest passage of the widest path: position from the first point and gap [m]."""

    x: float
    y: float
    gap: float


@dataclass(frozen=True, repr=False)
class GapFlow(Pictured):
    """Flow through a gap, along x and along y."""

    flow_factor: tuple[float, float]
    """Flow over that of a parallel gap of the mean height [-]."""
    flow_factor_interval: tuple[tuple[float, float], tuple[float, float]]
    """Lower and upper end of the flow factors by the error of the grid [-]; NaN on a grid that has
    no coarser one."""
    mean_gap: float
    """Over the whole map, contact included [m]."""
    percolates: tuple[bool, bool]
    """Whether an open path leads from end to end."""
    junction: tuple[Junction | None, Junction | None]
    """Critical junction of each axis; None without a path."""
    contact_fraction: float
    """Closed points over all points [-]."""
    gap: Array = field(repr=False)
    """[m], shape (nx, ny)."""
    spacing: tuple[float, float]
    """Distance of the points [m]."""
    pressure: Array = field(repr=False)
    """Fluid pressure in a mean gradient of one period, shape (2, nx, ny) [-]: it falls from 1 to 0
    along the axis. NaN where nothing flows."""
    density: Array = field(repr=False)
    """Flow through each point over the mean flow along the axis, shape (2, nx, ny) [-]."""

    def leak_rate(
        self, *, length: float, width: float, pressure_difference: float, viscosity: float
    ) -> tuple[float, float]:
        """Return the volume that leaks through a seal in a second [m^3/s], along x and along y.

        `length` and `width` are those of the nominal contact along and across the leak [m];
        `pressure_difference` [Pa] drives an incompressible fluid of the `viscosity` [Pa s].
        """
        share = (
            checks.positive("width", width, unit="m")
            / checks.positive("length", length, unit="m")
            * checks.not_negative("pressure_difference", pressure_difference, unit="Pa")
            / checks.positive("viscosity", viscosity, unit="Pa s")
        )
        along_x, along_y = (phi * self.mean_gap**3 / 12.0 * share for phi in self.flow_factor)
        return along_x, along_y

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield gap and closed share, and what flows along each axis."""
        yield "mean_gap", readable(self.mean_gap, "m")
        yield "contact_fraction", f"{self.contact_fraction:.3g}"
        for axis, name in enumerate("xy"):
            junction, text = self.junction[axis], "no open path, flow factor 0"
            if junction is not None:
                low, high = self.flow_factor_interval[axis]
                text = (
                    f"flow factor {self.flow_factor[axis]:.4g} ({low:.3g} to {high:.3g}); critical "
                    f"junction {readable(junction.gap, 'm')} high at x = "
                    f"{readable(junction.x, 'm')}, y = {readable(junction.y, 'm')}"
                )
            yield f"along {name}", text

    def to_dataset(self) -> xr.Dataset:
        """Return numbers and fields as a labelled Dataset."""
        low, high = np.transpose(self.flow_factor_interval)
        x, y = (step * np.arange(n) for step, n in zip(self.spacing, self.gap.shape, strict=True))
        narrow = [each.gap if each else 0.0 for each in self.junction]
        fields = ("axis", "x", "y")
        variables = {
            "flow_factor": ("axis", self.flow_factor, "1", "flow over that of the mean gap"),
            "flow_factor_low": ("axis", low, "1", "its lower end by the error of the grid"),
            "flow_factor_high": ("axis", high, "1", "its upper end by the error of the grid"),
            "percolates": ("axis", self.percolates, "1", "whether an open path leads through"),
            "mean_gap": ((), self.mean_gap, "m", "mean gap, contact included"),
            "closed_fraction": ((), self.contact_fraction, "1", "closed points over all points"),
            "junction_gap": ("axis", narrow, "m", "height of the critical junction"),
            "gap": (("x", "y"), self.gap, "m", "gap between rubber and surface"),
            "fluid_pressure": (fields, self.pressure, "1", "over the fall along a period"),
            "x": ("x", x, "m", "x"),
            "y": ("y", y, "m", "y"),
        }
        data = {name: labelled(*entry, "gripscale gap flow") for name, entry in variables.items()}
        return xr.Dataset(data, {"axis": ["x", "y"]}, provenance.version_attributes())

    def plot(self) -> Figure:
        """Draw fluid pressure and paths of the flow, along the axis with more flow."""
        return gripscale.flow.gap_flow_figure(self)


def gap_flow(
    contact: RoughContact | ArrayLike, *, spacing: Sequence[float] | None = None
) -> GapFlow:
    """Return the flow of a fluid through the gap of a contact.

    The gap is that of the dry contact: the pressure of the fluid does not widen it. Raises
    `InputError` for the contact of a line, or a gap with missing or negative values.

        >>> gap = 1e-6 * (1.0 + 0.5 * np.sin(2.0 * np.pi * np.arange(64) / 64))
        >>> flow = gs.gap_flow(np.tile(gap[:, None], (1, 64)), spacing=(1e-6, 1e-6))
        >>> across, along = flow.flow_factor  # of the waves
        >>> f"{across:.3f}, {along:.3f}"
        '0.433, 1.375'

    Parameters
    ----------
    contact : RoughContact or array
        The contact of a map; or a periodic gap [m], zero where closed, shape (nx, ny).
    spacing : pair of float, optional
        Distance of the points of an array along x and y [m].
    """
    gap, steps = _gap_and_spacing(contact, spacing)
    mean = float(gap.mean())
    closed = gap <= NARROWEST * mean
    relative = np.where(closed, 0.0, gap / (mean or 1.0))
    factors, pressure, density, percolates = _flow(relative, steps)
    along_x, along_y = (
        _critical_junction(relative, steps, axis, mean) if open_path else None
        for axis, open_path in enumerate(percolates)
    )
    return GapFlow(
        flow_factor=factors,
        flow_factor_interval=_intervals(relative, steps, factors),
        mean_gap=mean,
        percolates=percolates,
        junction=(along_x, along_y),
        contact_fraction=float(closed.mean()),
        gap=gap,
        spacing=steps,
        pressure=pressure,
        density=density,
    )


def _gap_and_spacing(
    contact: RoughContact | ArrayLike, spacing: Sequence[float] | None
) -> tuple[Array, tuple[float, float]]:
    """Return the gap [m] and the spacing [m]; raise `InputError` for anything but a map."""
    if isinstance(contact, RoughContact):
        if len(contact.grid.shape) == 1:
            raise InputError(
                "contact must be that of a map (HeightMap): a fluid flows around contacts, which "
                "a line does not show; got that of a line"
            )
        dx, dy = contact.grid.spacing
        return contact.gap, (dx, dy)
    expected = "gap must be a map of finite numbers, zero or more [m], with two axes"
    gap = checks.array(contact, expected)
    bad = int((~np.isfinite(gap) | (gap < 0.0)).sum())
    if gap.ndim != 2 or min(gap.shape) < 2 or bad:
        raise InputError(
            f"{expected}; got shape {gap.shape} with {bad} missing, infinite or negative values"
        )
    steps = checks.positive_vector("spacing", () if spacing is None else spacing, unit="m")
    if steps.size != 2:
        raise InputError(
            f"spacing must be the distances of the points along x and y [m]; got {spacing!r}"
        )
    return gap, (float(steps[0]), float(steps[1]))


def _flow(
    gap: Array, spacing: tuple[float, float], tolerance: float = FLOW_TOLERANCE
) -> tuple[tuple[float, float], Array, Array, tuple[bool, bool]]:
    """Return flow factors, pressures, densities of flow and percolation of a gap over its mean.

    The mean is that of the whole map, also for a part of its points.
    """
    regions = periodic_regions(gap > 0.0)
    ways = regions.percolates
    factors, pressure = [0.0, 0.0], np.full((2, *gap.shape), math.nan)
    density = np.zeros_like(pressure)
    if ways.any():
        through = regions.where(np.any(ways, axis=1))
        conductance = _conductances(np.where(through, gap, 0.0), spacing)
        network = Multigrid(_matrix(conductance, through))
        for axis in (0, 1):
            carrying = regions.where(ways[:, axis])
            faces = np.where(carrying, conductance, 0.0)
            inflow = spacing[axis] * (faces[axis] - np.roll(faces[axis], 1, axis))
            outset = spacing[axis] ** 2 * float(faces[axis].sum())
            deviation = np.zeros(gap.shape)
            if outset > 0.0:
                deviation[through] = network.solve(inflow[through], outset, tolerance)
            position = spacing[axis] * np.indices(gap.shape, sparse=True)[axis]
            length = spacing[axis] * gap.shape[axis]
            pressure[axis] = np.where(carrying, 1.0 - (deviation + position) / length, math.nan)
            lost = 0.0
            for along, each in enumerate(faces):
                drop = np.roll(deviation, -1, along) - deviation + spacing[axis] * (along == axis)
                rate = each * drop
                lost += float((rate * drop).sum())
                through_cell = (rate + np.roll(rate, 1, along)) * spacing[along]
                density[axis] = np.hypot(density[axis], 0.5 * through_cell)
            factors[axis] = lost / (gap.size * spacing[0] * spacing[1])
            density[axis] *= 1.0 / (spacing[0] * spacing[1] * (factors[axis] or 1.0))
    open_ways = bool(ways[:, 0].any()), bool(ways[:, 1].any())
    return (factors[0], factors[1]), pressure, density, open_ways


def _conductances(gap: Array, spacing: tuple[float, float]) -> Array:
    """Return the conductance from each cell to the next along x and along y, shape (2, nx, ny)."""
    cubed, ratio = gap**3, spacing[1] / spacing[0]
    out = np.empty((2, *gap.shape))
    for axis, shape in enumerate((ratio, 1.0 / ratio)):
        following = np.roll(cubed, -1, axis)
        total = cubed + following
        out[axis] = 2.0 * shape * cubed * following / np.where(total > 0.0, total, 1.0)
    return out


def _matrix(conductance: Array, through: Mask) -> csr_array:
    """Return the matrix of the cells that flow goes `through`."""
    number, count = np.full(through.shape, -1), int(through.sum())
    number[through] = np.arange(count)
    linked = conductance > 0.0
    first = np.broadcast_to(number, linked.shape)[linked]
    second = np.stack([np.roll(number, -1, axis) for axis in (0, 1)])[linked]
    return laplacian(first, second, conductance[linked], count)


def _intervals(
    gap: Array, spacing: tuple[float, float], factors: tuple[float, float]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ends of the flow factors by the error of the grid."""
    if min(gap.shape) < FEWEST_CELLS:
        return (math.nan, math.nan), (math.nan, math.nan)
    nx, ny = (n // 2 for n in gap.shape)
    wide = 2.0 * spacing[0], 2.0 * spacing[1]
    parts = (gap[i::2, j::2][:nx, :ny] for i, j in np.ndindex(2, 2))
    coarse = [_flow(part, wide, COARSE_FLOW_TOLERANCE)[0] for part in parts]
    out = []
    for factor, others in zip(factors, np.transpose(coarse), strict=True):
        if factor == 0.0:
            out.append((0.0, float(max(others))))
            continue
        change = [abs(math.log(other / factor)) for other in others if other > 0.0]
        spread = math.exp(ERROR_SHARE * max(change, default=0.0))
        low = factor / spread if len(change) == len(others) else 0.0
        out.append((low, factor * spread))
    return out[0], out[1]


def _critical_junction(
    gap: Array, spacing: tuple[float, float], axis: int, mean: float
) -> Junction:
    """Return the point with the least gap of the path with the largest least gap, by bisection."""
    values = np.unique(gap[gap > 0.0])

    def is_closed(least: float) -> bool:
        return not periodic_regions(gap >= least).percolates[:, axis].any()

    least = values[bisect_left(values, True, lo=1, key=is_closed) - 1]
    regions = periodic_regions(gap >= least)
    path = regions.where(regions.percolates[:, axis])
    i, j = np.argwhere(path & (gap == least))[0]
    return Junction(float(i * spacing[0]), float(j * spacing[1]), float(least * mean))
