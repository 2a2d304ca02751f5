"""Contact and friction of one wave, with the evidence for them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.rubber import Rubber, extrapolation
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.wave.problem import Status

# Harmonics of a contact pressure that is known at the uneven places of surface nodes.

Array = NDArray[np.float64]


def harmonics(x: Array, pressure: Array, period: float, order: NDArray[np.int_]) -> Array:
    """Return |p_k| [Pa] of the harmonics of `order`, by the trapezoidal rule.

    `x` [m] may be anywhere; where it or `pressure` [Pa] is not finite there is no node.
    """
    known = np.isfinite(x) & np.isfinite(pressure)
    place = np.mod(x[known], period)
    sequence = np.argsort(place)
    place, height = place[sequence], pressure[known][sequence]
    width = np.diff(np.append(place, place[0] + period))
    weight = 0.5 * (width + np.roll(width, 1))
    phase = np.exp(-2j * np.pi * np.outer(order, place) / period)
    return np.asarray(np.abs(phase @ (weight * height)) / period)


LARGE_MISMATCH = 0.05
"""Relative difference of the two frictions above which a result is in doubt."""


@dataclass(frozen=True)
class WaveResult:
    """Contact and friction of one wave, or of one period of a profile, with the evidence for them.

    All lengths in m, pressures in Pa, speeds in m/s, angular frequencies in rad/s.
    """

    wavelength: float
    """Of the wave; of a profile the period [m]."""
    amplitude: float
    """Of the wave; of a profile half the range of heights [m]."""
    pressure_received: float
    """Mean pressure this wave was given [Pa]."""
    speed: float
    load_time: float
    contact_fraction: float
    """Contact length projected on the mean plane over the wavelength [-]."""
    friction: float
    """Friction coefficient from the contact traction [-]."""
    friction_from_dissipation: float
    """Friction coefficient from the energy lost in the rubber per sliding distance [-]."""
    status: Status
    """`converged`, or why the solution is not to be trusted."""
    newton_iterations: int
    residual: float
    """Residual force relative to the applied force [-]."""
    min_stretch: float
    max_stretch: float
    x: Array = field(repr=False)
    """Deformed abscissa of the surface nodes in the frame of the wave [m].

    Zero is the crest of a sine, and the first height of a profile.
    """
    pressure: Array = field(repr=False)
    """Contact pressure at `x` [Pa], zero out of contact."""
    rubber: Rubber | None = field(default=None, repr=False, compare=False)
    """The rubber as it was on this wave."""
    model: str = "finite_strain"
    """Name of the solver: `finite_strain` (the block) or `half_plane` (small strain)."""
    deformed_mesh: tuple[Array, Array] | None = field(default=None, repr=False)
    """Deformed node positions (x, z) [m], each (layers, columns + 1), or None."""
    details: Mapping[str, Any] = field(default_factory=dict, repr=False)
    """Further numbers of the solver (load steps, mesh, indentation ...)."""
    contact_fraction_error: float = math.nan
    """Estimated discretisation error of the contact fraction [-], NaN if unknown."""
    friction_error: float = math.nan
    """Estimated discretisation error of the friction coefficient [-], NaN if unknown."""
    friction_bound: float = math.nan
    """Largest difference of the two frictions of a converged wave [-]; NaN at rest, or if unknown.

    A twentieth of the larger, or of 0.04 of the slope 2 pi amplitude/wavelength (root of two times
    the rms slope of a profile) where friction is less: so small a friction is known to no more.
    """
    loss_by_depth: tuple[Array, Array] | None = field(default=None, repr=False, compare=False)
    """Depths between the rows of elements at rest [m], shape (rows + 1,), and the part of
    `friction_from_dissipation` that each row loses [-], shape (rows,); None where it is not known.
    Not written to files."""
    solution: Any = field(default=None, repr=False, compare=False)
    """What the solver keeps to start another wave from; not written to files."""

    def __getstate__(self) -> dict[str, Any]:
        """Leave the solver's own solution behind when a result is pickled."""
        return {**self.__dict__, "solution": None}

    @property
    def contact_length(self) -> float:
        """Contact length projected on the mean plane [m]."""
        return self.contact_fraction * self.wavelength

    @property
    def converged(self) -> bool:
        """Whether the solution may be used."""
        return self.status == Status.CONVERGED

    @property
    def why(self) -> str:
        """The status, with how the frictions disagree or how much of the pressure was reached."""
        if self.converged:
            return str(self.status)
        if self.status == Status.FRICTIONS_DISAGREE:
            return f"{self.status}, {self._frictions}"
        reached = self.details.get("load_reached", math.nan)
        if self.status == Status.CONTACT_TOO_NARROW and "expected_contact_width" in self.details:
            return (
                f"{self.status}: about {self.details['expected_contact_width']:.2g} m is expected, "
                f"the finest mesh follows {self.details['smallest_contact_width']:.2g} m; "
                "the pressure is too small for the block"
            )
        if "smallest_wave_carried" in self.details:
            return (
                f"{self.status} for {self.details['columns']} columns: found with waves down to "
                f"{self.details['smallest_wave_carried']:.2g} m alone; leave out shorter waves, or "
                "take more columns"
            )
        if not math.isfinite(reached) or reached == 1.0:
            return str(self.status)
        return f"{self.status} at {100.0 * reached:.3g} % of the pressure"

    @property
    def _frictions(self) -> str:
        slope = self.details.get("contact_slope")
        where = "" if slope is None else f" with contact on slopes up to {slope:.2g}"
        return (
            f"{self.friction:.3g} from traction and {self.friction_from_dissipation:.3g} from "
            f"dissipation{where}: more columns are needed"
        )

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two friction measures: the discretisation's own error."""
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0

    @property
    def slope(self) -> float:
        """Largest slope of a sine, 2 pi amplitude / wavelength [-].

        Of a profile that of the sine of its period and range: the profile itself is steeper.
        """
        return 2.0 * math.pi * self.amplitude / self.wavelength

    @property
    def angular_frequency(self) -> float:
        """Fundamental excitation 2 pi speed / wavelength [rad/s], of the wave or the period."""
        return 2.0 * math.pi * self.speed / self.wavelength

    @property
    def modulus(self) -> float:
        """|E*| of the rubber at the fundamental excitation [Pa], NaN if it is not known."""
        return abs(self._complex_modulus())

    @property
    def loss_factor(self) -> float:
        """E''/E' of the rubber at the fundamental excitation [-], NaN if it is not known."""
        modulus = self._complex_modulus()
        return modulus.imag / modulus.real

    @property
    def outside_band(self) -> bool:
        """Whether more than 1 % of its friction rests on the rubber beyond what was measured."""
        return self.extrapolation.share > WORTH_SAYING

    @property
    def extrapolation(self) -> Extrapolation:
        """What of it rests on the rubber beyond what was measured; nothing at rest.

        A sine counts whole if its fundamental, or its harmonic as long as the contact,
        n = ceil(wavelength / contact length), is beyond the band. The friction of a profile is
        split by the harmonics of its pressure, |p_k|^2 Im(M)/|M|^2 each, as on a half-plane.
        """
        if self.speed == 0.0:
            return extrapolation.NONE
        if self.rubber is None:
            return extrapolation.UNKNOWN
        if "smallest_wavelength" in self.details:
            order = np.arange(1, len(self.x) // 2 + 1)
            omega = self.angular_frequency * order
            size = harmonics(self.x, self.pressure, self.wavelength, order)
            modulus = self.rubber.plane_strain_modulus(omega)
            lost = size**2 * modulus.imag / np.abs(modulus) ** 2
            return extrapolation.of_spectrum(self.rubber, omega, lost)
        harmonic = math.ceil(1.0 / self.contact_fraction) if self.contact_fraction > 0.0 else 1
        omega = self.angular_frequency * np.array([1.0, harmonic])
        return extrapolation.of_frequencies(self.rubber, omega)

    def _complex_modulus(self) -> complex:
        if self.rubber is None:
            return complex(math.nan, math.nan)
        return complex(self.rubber.complex_modulus(self.angular_frequency))


ScaleResult = WaveResult
"""Its name as `gripscale.ScaleResult`."""


# Solved waves as a labelled Dataset over `scale`, and back: one table of fields for both ways.

LW = "Lind & Wangenheim 2014, IMECE2014-37998"
CHAIN = "gripscale chain"
SOLVER = "gripscale solver of one wave"
WAVES = "input: sine waves of the surface"
RUBBER = "input: rubber, at the fundamental frequency"


class Field(NamedTuple):
    """A number per wave: its name in the Dataset, unit, meaning, source, and attribute."""

    name: str
    unit: str
    long_name: str
    source: str = SOLVER
    other_name: str = ""

    @property
    def attribute(self) -> str:
        """Name of the attribute of `WaveResult`, or its path."""
        return self.other_name or self.name

    def variable(self, values: Any) -> xr.Variable:
        """Return `values` over the waves with what every variable of a result carries."""
        return labelled("scale", values, self.unit, self.long_name, self.source)


FIELDS = (
    Field("wavelength", "m", "wavelength", WAVES),
    Field("amplitude", "m", "amplitude, half peak-to-valley", WAVES),
    Field("pressure_received", "Pa", "mean pressure on the wave", f"{LW}, equation 1"),
    Field("sliding_speed", "m/s", "sliding speed", "input: load", "speed"),
    Field("load_time", "s", "time the wave is loaded", CHAIN),
    Field("contact_fraction", "1", "contact length over wavelength"),
    Field("friction", "1", "friction coefficient from the contact traction"),
    Field(
        "friction_from_dissipation", "1", "friction coefficient from the energy lost in the rubber"
    ),
    Field("contact_fraction_error", "1", "estimated error of the contact fraction"),
    Field("friction_error", "1", "estimated error of the friction coefficient"),
    Field("friction_bound", "1", "largest difference of the two frictions of a converged wave"),
    Field("min_stretch", "1", "smallest principal stretch"),
    Field("max_stretch", "1", "largest principal stretch"),
    Field("newton_iterations", "1", "Newton iterations"),
    Field("residual", "1", "residual force over applied force"),
)
"""What a `WaveResult` is made of, as far as it is one number."""

DERIVED = (
    Field("contact_length", "m", "contact length on the mean plane"),
    Field("slope", "1", "largest slope, 2 pi amplitude/wavelength", CHAIN),
    Field("angular_frequency", "rad/s", "fundamental excitation, 2 pi speed/wavelength", CHAIN),
    Field("modulus", "Pa", "absolute complex Young's modulus", RUBBER),
    Field("loss_factor", "1", "loss factor", RUBBER),
    Field(
        "outside_band",
        "1",
        "1 where the wave excites the rubber outside the measured frequencies",
        RUBBER,
    ),
    Field(
        "decades_below_band",
        "1",
        "decades by which the slowest excitation is below the measured frequencies",
        RUBBER,
        "extrapolation.below",
    ),
    Field(
        "decades_above_band",
        "1",
        "decades by which the fastest excitation is above the measured frequencies",
        RUBBER,
        "extrapolation.above",
    ),
    Field("friction_mismatch", "1", "relative difference of the two friction coefficients", CHAIN),
)
"""What follows from the fields; written for the reader, not read back."""

DETAILS = (
    Field("load_steps", "1", "load steps"),
    Field("load_reached", "1", "share of the pressure that was reached"),
    Field("indentation", "m", "approach of wave and block"),
    Field("columns", "1", "elements along the block"),
    Field("coarser_columns", "1", "columns of the mesh that the errors are judged by, 0 for none"),
    Field("rows", "1", "elements across the block"),
    Field("depth", "1", "height of the block in wavelengths"),
    Field("element_order", "1", "order of the elements"),
    Field("points", "1", "points along the wave"),
    Field("points_in_contact", "1", "points in contact"),
    Field("full_contact", "1", "1 where the contact is full"),
    Field("passes", "1", "passes until rubber, strains and heat agreed"),
    Field("strain", "1", "uniaxial strain amplitude the softening was taken at", CHAIN),
    Field("storage_factor", "1", "what strain leaves of the storage modulus", CHAIN),
    Field("loss_factor_left", "1", "what strain leaves of the loss modulus", CHAIN),
    Field("series_misfit", "1", "relative misfit of the softened series at the wave", CHAIN),
    Field("beyond_sweep", "1", "1 where the strain lies beyond the sweep of the softening", CHAIN),
    Field("temperature", "K", "temperature of the rubber where the wave loses energy", CHAIN),
    Field("warming_uniform", "K", "of it by the heat of all waves spread evenly", CHAIN),
    Field("warming_larger_waves", "K", "of it in the contact of the larger waves", CHAIN),
    Field("warming_own", "K", "of it by the wave's own heat", CHAIN),
    Field("contact_temperature", "K", "temperature in the contact of the wave", CHAIN),
    Field("beyond_shift", "1", "1 where the temperature lies beyond the shift's", CHAIN),
)
"""Numbers only some solvers have."""

ALONG = {"surface_x": "x", "surface_pressure": "pressure"}
MESH = ("mesh_x", "mesh_z")


def waves_to_dataset(results: Sequence[WaveResult]) -> xr.Dataset:
    """Return `results` over `scale`; what lies along the waves is padded with NaN.

    Every variable carries `units`, `long_name` and `source`.
    """
    data = {field.name: _column(field, results) for field in (*FIELDS, *DERIVED)}
    for detail in DETAILS:
        values = [float(result.details.get(detail.name, math.nan)) for result in results]
        if np.isfinite(values).any():
            data[detail.name] = detail.variable(values)
    data |= _along_the_wave(results) | _meshes(results)
    for name, long_name, texts in (
        ("status", "converged, or why not", [str(result.status) for result in results]),
        ("wave_solver", "solver of the wave", [result.model for result in results]),
        ("rubber_parameters", "the rubber", [_text_of(result.rubber) for result in results]),
    ):
        data[name] = labelled("scale", np.array(texts, dtype=object), "1", long_name, SOLVER)
    number = labelled("scale", np.arange(1, len(results) + 1), "1", "number of the wave", CHAIN)
    return xr.Dataset(data, coords={"scale": number})


def waves_from_dataset(data: xr.Dataset) -> list[WaveResult]:
    """Return the waves of a Dataset, equal to those it was made of but for what starts others."""
    return [_wave(data.isel(scale=i)) for i in range(data.sizes["scale"])]


def labelled(dims: Any, values: Any, unit: str, long_name: str, source: str) -> xr.Variable:
    """Return `values` with what every variable of a result carries."""
    attrs = {"units": unit, "long_name": long_name, "source": source}
    return xr.Variable(dims, np.asarray(values), attrs)


def _column(field: Field, results: Sequence[WaveResult]) -> xr.Variable:
    values = np.array([attrgetter(field.attribute)(result) for result in results])
    if field.name == "friction_mismatch":  # nothing slides: nothing to compare
        values = np.where([result.speed > 0.0 for result in results], values, math.nan)
    if values.dtype == bool:
        values = values.astype(np.int8)
    return field.variable(values)


def _along_the_wave(results: Sequence[WaveResult]) -> dict[str, xr.Variable]:
    dims = ("scale", "surface_node")
    x, pressure = (_padded([getattr(r, name) for r in results]) for name in ALONG.values())
    return {
        "surface_x": labelled(dims, x, "m", "deformed abscissa, crest of the wave at 0", SOLVER),
        "surface_pressure": labelled(dims, pressure, "Pa", "contact pressure", SOLVER),
    }


def _meshes(results: Sequence[WaveResult]) -> dict[str, xr.Variable]:
    meshes = [result.deformed_mesh for result in results]
    if all(mesh is None for mesh in meshes):
        return {}
    none = np.zeros((0, 0))
    out = {}
    for i, (name, long_name) in enumerate(zip(MESH, ("abscissa", "height"), strict=True)):
        values = _padded([none if mesh is None else mesh[i] for mesh in meshes])
        dims = ("scale", "layer", "column")
        out[name] = labelled(dims, values, "m", f"{long_name} of the deformed nodes", SOLVER)
    return out


def _padded(arrays: Sequence[Array]) -> Array:
    """Return arrays of different sizes as one, NaN where they have nothing."""
    shapes = np.array([array.shape for array in arrays])
    out = np.full((len(arrays), *shapes.max(axis=0, initial=0)), math.nan)
    for row, array in zip(out, arrays, strict=True):
        row[tuple(slice(length) for length in array.shape)] = array
    return out


def _wave(one: xr.Dataset) -> WaveResult:
    fields = {field.attribute: float(one[field.name]) for field in FIELDS if field.name in one}
    details = {f.name: float(one[f.name]) for f in DETAILS if f.name in one}
    known = np.isfinite(one["surface_x"].values)
    return WaveResult(
        **{**fields, "newton_iterations": int(fields["newton_iterations"])},  # type: ignore[arg-type]
        status=Status(str(one["status"].item())),
        model=str(one["wave_solver"].item()),
        rubber=_rubber_of(str(one["rubber_parameters"].item())),
        **{name: one[long].values[known] for long, name in ALONG.items()},
        deformed_mesh=_mesh(one),
        details={name: value for name, value in details.items() if math.isfinite(value)},
    )


def _mesh(one: xr.Dataset) -> tuple[Array, Array] | None:
    if MESH[0] not in one:
        return None
    x, z = (one[name].values for name in MESH)
    layers, columns = np.isfinite(x).any(axis=1), np.isfinite(x).any(axis=0)
    return (x[layers][:, columns], z[layers][:, columns]) if layers.any() else None


def _text_of(rubber: Rubber | None) -> str:
    return "" if rubber is None else json.dumps(rubber.to_dict())


def _rubber_of(text: str) -> Rubber | None:
    return Rubber.from_dict(json.loads(text)) if text else None
