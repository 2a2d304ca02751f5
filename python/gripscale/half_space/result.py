"""Result of the direct contact, as numbers and as a labelled Dataset.

By octave of wavelength, `wavelength` being its lower end, the Dataset holds the `friction` lost in
the harmonics 2 pi/|q| of the pressure, which sums to `friction_from_dissipation` exactly, and the
`contact_fraction` of another contact, with only the waves of the surface not shorter than
`wavelength`, NaN where none was solved. The effect of the cut-off follows from such contacts:
docs/cut-off.md.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from dataclasses import fields as fields_of
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

import gripscale
from gripscale.conditions.conditions import Conditions, RubberByScale, StateByScale
from gripscale.core import Array, InputError, Mask, Status, labelled, provenance
from gripscale.core.described import Described, Pictured
from gripscale.core.units import readable
from gripscale.cut_off_exponents import NOT_CONVERGED, OCTAVE, CutOffExponents, between
from gripscale.half_space.grid import Grid
from gripscale.half_space.grid_sequence import GridRecord, lost_by_harmonic
from gripscale.half_space.regions import periodic_regions
from gripscale.half_space.response import HalfSpace
from gripscale.model import CUT_OFF_EXPONENTS, OUTSIDE_BAND
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import NOTHING_BEYOND, Extrapolation, of_spectrum
from gripscale.theory.layers import Layers

if TYPE_CHECKING:
    from matplotlib.figure import Figure


STEEP = 0.5  # rms slope in the contact beyond which small strain is not a good approximation
VERY_STEEP = 1.0  # slope of flanks where neither small strain nor a laser is to be trusted
_SOURCE = "gripscale direct contact"
# Shares of the contact whose pressures a Dataset holds.
_SHARES = (0.05, 0.25, 0.5, 0.75, 0.95, 0.99)

_NUMBERS = {
    "contact_fraction": ("1", "real over nominal contact area"),
    "contact_fraction_error": ("1", "its estimated error of the grid"),
    "friction": ("1", "friction coefficient from the contact traction"),
    "friction_from_dissipation": ("1", "friction coefficient from the energy lost in the rubber"),
    "friction_error": ("1", "estimated error of the friction coefficients of the grid"),
    "friction_mismatch": ("1", "relative difference of the two friction coefficients"),
    "slope_in_contact": ("1", "rms slope of the surface in the contact"),
    "missing_share": ("1", "share of the contact on interpolated heights"),
    "smallest_wavelength": ("m", "cut-off of the surface as solved"),
    "full_contact": ("1", "1 where the contact is full"),
}


# Lower ends of the classes of |dh/dx|; the last has no upper end.
SLOPES = (0.0, 0.25, 0.5, 1.0, 2.0)
# Numbers of a contact with trapped water.
TRAPPED_WATER = {
    "water_load_share": "share of the load on water",
    "dry_contact_fraction": "contact fraction without water",
    "dry_friction": "friction without water",
}
SHARES_BY_SLOPE = {
    "friction_by_slope": "share of the friction from contact on slopes of the class",
    "load_by_slope": "share of the load carried on slopes of the class",
    "contact_by_slope": "share of the contact area on slopes of the class",
}


def shares_by_slope(contact: RoughContact) -> xr.Dataset:
    """Return the shares of friction from traction, load and contact area by slope of the surface.

    The result has `friction_by_slope`, `load_by_slope` and `contact_by_slope` [-] over `slope`, the
    lower end of the classes of |dh/dx|: 0 to 0.25, to 0.5, to 1, to 2 and above. Each sums to 1;
    the friction is NaN where there is none.
    """
    slope = contact.grid.slope(contact.height)
    index = np.digitize(np.abs(slope), SLOPES[1:], right=True).reshape(-1)
    force = contact.pressure * slope
    if not (contact.speed > 0.0 and force.sum() > 0.0):
        force = np.full(force.shape, math.nan)
    data = {}
    amounts = (force, contact.pressure, contact.active)
    for (name, text), amount in zip(SHARES_BY_SLOPE.items(), amounts, strict=True):
        sums = np.bincount(index, np.asarray(amount, dtype=float).reshape(-1), len(SLOPES))
        data[name] = labelled("slope", sums / amount.sum(), "1", text, _SOURCE)
    ends = labelled("slope", np.array(SLOPES), "1", "lower end of |dh/dx|", "input")
    return xr.Dataset(data, {"slope": ends})


@dataclass(frozen=True, repr=False)
class TrappedWater(Described):
    """Water in pools that the contact closes."""

    film: float
    """Mean thickness of the water before the contact [m]; infinite: flooded."""
    pool: NDArray[np.intp] = field(repr=False)
    """Number of the pool of each point, from 1; 0 outside."""
    pool_pressure: Array = field(repr=False)
    """Of each pool [Pa]; zero where room is left."""
    pool_volume: Array = field(repr=False)
    """Water in each pool [m^3]."""
    dry_contact_fraction: float
    """Real over nominal contact area without water [-]."""
    dry_friction: float
    """Friction from dissipation without water [-]."""

    @property
    def pressure(self) -> Array:
        """Pressure of the water [Pa], shape of the grid; zero where it drains."""
        return np.asarray(np.append(0.0, self.pool_pressure)[self.pool])


@dataclass(frozen=True, repr=False)
class RoughContact(Pictured):
    """Contact and friction of a whole surface (m, Pa, m/s); arrays have the shape of the grid."""

    rubber: Rubber = field(repr=False)
    nominal_pressure: float
    speed: float
    smallest_wavelength: float
    """Of the surface as it was solved [m]."""
    contact_fraction: float
    """Real over nominal contact area, corrected for the grid [-]."""
    friction: float
    """Friction coefficient from the contact traction [-]."""
    friction_from_dissipation: float
    """Friction coefficient from the energy lost in the rubber per sliding distance [-]."""
    contact_fraction_error: float
    """Estimated error of the grid [-]; NaN if there is only one."""
    friction_error: float
    """Estimated error of the grid [-]; NaN if there is only one."""
    status: Status
    """`converged`, or why the numbers are not to be trusted."""
    residuals: dict[str, float]
    """`pressure`: missing over rms pressure; `gap`: largest gap in contact or overlap outside it,
    over the rms height; `load`: relative error of the mean pressure."""
    full_contact: bool
    """Whether every point is in contact; the solution then is in closed form."""
    grid: Grid = field(repr=False)
    origin: tuple[float, ...] = field(repr=False)
    height: Array = field(repr=False)
    """Of the surface as it was solved, mean zero [m]."""
    pressure: Array = field(repr=False)
    """Pressure on the rubber [Pa], of the contact and of trapped water; zero elsewhere."""
    gap: Array = field(repr=False)
    """Between rubber and surface [m], zero in contact."""
    measured: Mask = field(repr=False)
    """Where heights were measured and not interpolated."""
    grids: list[GridRecord] = field(repr=False)
    """Numbers of every grid that was solved, in order."""
    by_scale: RubberByScale | None = field(default=None, repr=False)
    """The rubber at each scale under conditions; None: `rubber` at all scales."""
    scales: StateByScale | None = field(default=None, repr=False)
    """Temperature, strain and moduli at each scale under iterated conditions."""
    passes: int = 1
    """Solutions until rubber, strains and heat agreed."""
    coarse_passes: int = 0
    """Further solutions, on grids that only resolve the surface."""
    surface_warming: Array | None = field(default=None, repr=False)
    """Temperature rise of the rubber's surface over that before the contact [K]; None without
    heat."""
    conditions: Conditions | None = None
    """Conditions of the rubber, and the area term."""
    thickness: float | None = None
    """Of the rubber on a rigid base [m]; None: a half-space, or `layers`."""
    layers: Layers | None = None
    """The stack, that in contact first and also `rubber`; None: one rubber."""
    water: TrappedWater | None = None
    """Pools that the contact closes; None: a dry contact."""

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield status, contact, friction, load and grid."""
        yield "status", str(self.status)
        for name in ("contact_fraction", "friction"):
            error = getattr(self, f"{name}_error")
            grid = "" if math.isnan(error) else f" ± {error:.2g}"
            yield name, f"{getattr(self, name):.4g}{grid}"
        yield "friction_from_dissipation", f"{self.friction_from_dissipation:.4g}"
        yield "load", f"{readable(self.nominal_pressure, 'Pa')}, {readable(self.speed, 'm/s')}"
        spacing = " and ".join(readable(step, "m") for step in self.grid.spacing)
        yield "grid", f"{' x '.join(map(str, self.grid.shape))} points, step {spacing}"
        yield "smallest_wavelength", readable(self.smallest_wavelength, "m")
        yield from (("note", note) for note in self.notes[:2])

    @property
    def adhesive_friction(self) -> float:
        """Friction coefficient of the area term [-]; NaN without an area term, and at rest."""
        if self.conditions is None:
            return math.nan
        warming = 0.0
        if self.surface_warming is not None:
            warming = float(np.average(self.surface_warming, weights=self.pressure))
        return self.adhesive_friction_at(self.conditions, warming)

    def adhesive_friction_at(self, conditions: Conditions, warming: float) -> float:
        """Return the friction of an area term [-] at a mean rise in the contact [K]."""
        kelvin = conditions.temperature_of(self.rubber)
        return conditions.adhesive_friction(
            self.contact_fraction,
            self.nominal_pressure,
            self.speed,
            None if kelvin is None else kelvin + warming,
        )

    @property
    def total_friction(self) -> float:
        """Sum of hysteresis and area term [-]; NaN without an area term."""
        return self.friction + self.adhesive_friction

    @cached_property
    def body(self) -> HalfSpace:
        """The rubber as it slides; it keeps its moduli on lines."""
        return HalfSpace(
            self.rubber,
            self.speed,
            by_scale=self.by_scale,
            thickness=self.thickness,
            layers=self.layers,
        )

    @property
    def converged(self) -> bool:
        """Whether the solution may be used."""
        return self.status == Status.CONVERGED

    @property
    def usable(self) -> bool:
        """Whether the contact counts in an answer; it does if its frictions disagree."""
        return self.status in (Status.CONVERGED, Status.FRICTIONS_DISAGREE)

    @property
    def has_friction(self) -> bool:
        """Whether its friction has a logarithm."""
        return self.usable and self.friction_from_dissipation > 0.0

    @property
    def x(self) -> Array:
        """Positions along the sliding direction [m], shape (nx,)."""
        return self._positions(0)

    @property
    def y(self) -> Array:
        """Positions across it [m], shape (ny,); empty for a line."""
        return self._positions(1) if len(self.grid.shape) > 1 else np.empty(0)

    @property
    def active(self) -> Mask:
        """Where the rubber is in contact."""
        if self.water is None:
            return np.asarray(self.pressure > 0.0)
        return np.asarray((self.pressure > 0.0) & (self.water.pool == 0))

    def require_dry(self, why: str) -> None:
        """Raise `InputError`, with the reason, for a contact in water."""
        if self.water is not None:
            raise InputError(f"contact must be solved without water: {why}")

    @property
    def water_load_share(self) -> float:
        """Share of the load on trapped water [-]."""
        if self.water is None:
            return 0.0
        return float(self.water.pressure.mean() / self.nominal_pressure)

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two friction measures, zero at rest."""
        if self.speed == 0.0:
            return 0.0
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0

    @property
    def extrapolation(self) -> Extrapolation:
        """Share of the friction lost beyond the measured frequencies, which heat shifts."""
        if self.speed == 0.0:
            return NOTHING_BEYOND
        omega = np.broadcast_to(self.grid.along * self.speed, self.grid.spectrum_shape)
        if self.by_scale is not None:
            omega = omega * self.by_scale.shift(self.grid.wavenumber)
        return of_spectrum(self.rubber, omega, self.lost_by_harmonic())

    @property
    def cut_off_exponents(self) -> CutOffExponents:
        """Exponents of the cut-off, from contacts solved with this cut-off and with twice it."""
        pairs = [
            (before, last)
            for before in self.grids
            for last in self.grids
            if last.cut_off == self.grids[-1].cut_off
            and last.points == OCTAVE * before.points
            and math.isclose(before.cut_off, OCTAVE * last.cut_off)
        ]
        if not pairs:
            return CutOffExponents(math.nan, math.nan, "solved with one cut-off only")
        before, last = pairs[0]
        if not (before.settled and last.settled):
            return NOT_CONVERGED
        return between(
            OCTAVE,
            (before.contact_fraction, last.contact_fraction),
            (before.friction_from_dissipation, last.friction_from_dissipation),
            moving=self.speed > 0.0,
        )

    @property
    def slope_in_contact(self) -> float:
        """Rms slope of the surface along x in the contact [-]."""
        slope = self.grid.slope(self.height)[self.active]
        return float(np.sqrt(np.mean(slope**2)))

    @property
    def missing_share(self) -> float:
        """Share of the contact that lies on heights which were missing and interpolated [-]."""
        return float(1.0 - self.measured[self.active].mean())

    @property
    def steep_share(self) -> float:
        """Share of the friction from contact on slopes above 1 [-]; NaN without friction."""
        share = self.shares_by_slope.friction_by_slope
        return float(share.where(share.slope >= VERY_STEEP, 0.0).sum(skipna=False))

    @cached_property
    def shares_by_slope(self) -> xr.Dataset:
        """Shares of friction, load and contact area by slope, as the function of this name."""
        return shares_by_slope(self)

    @property
    def patches(self) -> Array:
        """Size of each contact patch, largest first: length [m] on a line, area [m^2] on a map."""
        points = np.bincount(periodic_regions(self.active).labels.reshape(-1))[1:]
        return np.asarray(np.sort(points)[::-1] * math.prod(self.grid.spacing))

    @property
    def notes(self) -> list[str]:
        """Warnings, as sentences."""
        out = []
        if self.slope_in_contact > STEEP:
            out.append(
                f"The rms slope in the contact is {self.slope_in_contact:.2f}, above {STEEP:g}: "
                "small strain is no longer a good approximation."
            )
        if self.missing_share > 0.05:
            out.append(f"{self.missing_share:.0%} of the contact lies on interpolated heights.")
        if self.water is not None:
            out.append(
                f"Trapped water carries {self.water_load_share:.1%} of the load. Without it the "
                f"contact area is {self.water.dry_contact_fraction:.3g} and the friction "
                f"{self.water.dry_friction:.3g}."
            )
        if self.status == Status.FRICTIONS_DISAGREE:
            out.append(
                f"Friction is {self.friction:.3g} from traction and "
                f"{self.friction_from_dissipation:.3g} from dissipation: the grid is too coarse "
                "for the first. Set a tolerance, which refines the grid."
            )
        return out

    def pressure_quantiles(self, shares: ArrayLike) -> Array:
        """Return the pressures [Pa] that the given shares [-] of the contact do not exceed."""
        return np.asarray(np.quantile(self.pressure[self.active], np.asarray(shares, dtype=float)))

    def lost_by_harmonic(self) -> Array:
        """Return the friction each harmonic adds [-], over the half spectrum of the grid."""
        return self._lost

    @property
    def friction_by_layer(self) -> Array:
        """Parts of `friction_from_dissipation` lost in each layer [-], that in contact first."""
        if self.layers is None:
            return np.array([self._lost.sum()])
        losses = self.body.losses_by_layer(self.grid)
        parts = [lost_by_harmonic(1j * loss, self.grid, self.pressure).sum() for loss in losses]
        return np.array(parts)

    @cached_property
    def _lost(self) -> Array:
        lost = lost_by_harmonic(self.body.compliance(self.grid), self.grid, self.pressure)
        lost.flags.writeable = False
        return lost

    def _positions(self, axis: int) -> Array:
        offset = self.grid.spacing[axis] * np.arange(self.grid.shape[axis], dtype=float)
        return np.asarray(self.origin[axis] + offset)

    @property
    def friction_by_wavelength(self) -> xr.Dataset:
        """Friction and contact fraction by octave of wavelength, as the head of the module says."""
        number = np.broadcast_to(self.grid.wavenumber, self.grid.spectrum_shape).reshape(-1)[1:]
        lost = self.lost_by_harmonic().reshape(-1)[1:]
        # a wave of exactly the lower end belongs to the octave, rounding or not
        octave = np.floor(np.log2(2.0 * np.pi / number / self.smallest_wavelength) + 1e-9)
        order = np.arange(octave.max(), octave.min() - 1.0, -1.0)
        friction = np.bincount((octave.max() - octave).astype(int), weights=lost)
        fraction = np.full(order.size, np.nan)
        for grid in self.grids:
            index = round(float(octave.max() - np.log2(grid.cut_off / self.smallest_wavelength)))
            if grid.settled and 0 <= index < order.size:
                fraction[index] = grid.contact_fraction
        columns = {
            "friction": (friction, "1", "friction of the octave", _SOURCE),
            "running_friction": (np.cumsum(friction), "1", "friction down to the octave", _SOURCE),
            "contact_fraction": (fraction, "1", "contact fraction without shorter waves", _SOURCE),
            "wavelength": (
                self.smallest_wavelength * 2.0**order,
                "m",
                "lower end of octave",
                "input",
            ),
        }
        data = {name: labelled("wavelength", *column) for name, column in columns.items()}
        return xr.Dataset(data).set_coords("wavelength")

    def plot(self) -> Figure:
        """Draw rubber on the surface and pressure, or with water the pools."""
        if self.water is not None:
            return gripscale.flow.trapped_water_figure(self)
        return gripscale.questions.rough_contact_figure(self)

    def to_dataset(self, *, fields: bool = True) -> xr.Dataset:
        """Return everything as a labelled Dataset, with `fields` the arrays on the grid too."""
        data: dict[str, xr.Variable] = {}

        def add(name: str, dims: Any, values: Any, unit: str, text: str) -> None:
            data[name] = labelled(dims, values, unit, text, _SOURCE)

        for name, (unit, text) in _NUMBERS.items():
            add(name, (), float(getattr(self, name)), unit, text)
        beyond, exponents = self.extrapolation, self.cut_off_exponents
        for total, (part, text) in OUTSIDE_BAND.items():
            add(total.removeprefix("total_"), (), getattr(beyond, part), "1", text)
        for total, (part, text) in CUT_OFF_EXPONENTS.items():
            add(total.removeprefix("total_"), (), getattr(exponents, part), "1", text)
        octaves = self.friction_by_wavelength
        data["octave_friction"] = octaves["friction"].variable
        data["octave_running_friction"] = octaves["running_friction"].variable
        data["contact_fraction_without_shorter"] = octaves["contact_fraction"].variable
        for name in (entry.name for entry in fields_of(GridRecord)):
            values = [float(getattr(grid, name)) for grid in self.grids]
            add(f"grid_{name}", "grid", values, "1", f"{name} on each grid")
        data |= {name: self.shares_by_slope[name].variable for name in SHARES_BY_SLOPE}
        if self.thickness is not None:
            add("thickness", (), self.thickness, "m", "thickness of the rubber on a rigid base")
        if self.layers is not None:
            text = "friction from the energy lost in the layer"
            add("friction_by_layer", "layer", self.friction_by_layer, "1", text)
            add("layer_thickness", "layer", self.layers.thicknesses, "m", "thickness of the layer")
        if (water := self.water) is not None:
            add("water_film", (), water.film, "m", "mean thickness of the water; inf if flooded")
            carried = (self.water_load_share, water.dry_contact_fraction, water.dry_friction)
            for (name, text), share in zip(TRAPPED_WATER.items(), carried, strict=True):
                add(name, (), share, "1", text)
            add("pool_pressure", "pool", water.pool_pressure, "Pa", "pressure of each pool")
            add("pool_volume", "pool", water.pool_volume, "m3", "water in each pool")
        pressures = self.pressure_quantiles(_SHARES)
        add("contact_pressure", "share", pressures, "Pa", "not exceeded on the share")
        axes = ("x", "y")[: self.height.ndim]
        add("patch_size", "patch", self.patches, "m" if len(axes) == 1 else "m2", "patches")
        if fields:
            for axis in axes:
                add(axis, axis, getattr(self, axis), "m", axis)
            add("height", axes, self.height, "m", "height of the surface as solved")
            add("pressure", axes, self.pressure, "Pa", "contact pressure")
            add("gap", axes, self.gap, "m", "gap between rubber and surface")
            if water is not None:
                add("pool_number", axes, water.pool, "1", "number of the pool, 0 outside")
        for name, value in self.residuals.items():
            add(f"residual_{name}", (), value, "1", f"residual of the {name}")
        add("status", (), np.array(str(self.status), dtype=object), "1", "")
        return xr.Dataset(
            data,
            {
                "share": list(_SHARES),
                "slope": list(SLOPES),
                "wavelength": octaves.wavelength.variable,
            },
            {
                "title": "Direct contact of rubber with a whole rough surface",
                "rubber": f"{self.rubber.name}; {self.rubber.source}".strip("; "),
                "rubber_parameters": json.dumps(self.rubber.to_dict()),
                "nominal_pressure": self.nominal_pressure,
                "speed": self.speed,
                "notes": " ".join(self.notes),
                **provenance.version_attributes(),
            },
        )
