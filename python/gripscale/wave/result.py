"""Contact and friction of one wave, with the evidence for them, as an object and as a Dataset.

`numbers.csv` lists fields of a `ScaleResult`; derived numbers, which follow from these and are
written for the reader; and details, which only some solvers have.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import gripscale
from gripscale.core import Array, Pictured, Status, labelled
from gripscale.rubber import Rubber, extrapolation
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Statuses of a wave in which the forces on its nodes vanish.
EQUILIBRIUM = (Status.CONVERGED, Status.TOLERANCE_NOT_MET, Status.FRICTIONS_DISAGREE)
LARGE_MISMATCH = 0.05  # relative difference of the two frictions above which a result is in doubt


def harmonics(x: Array, pressure: Array, period: float, order: NDArray[np.int_]) -> Array:
    """Return |p_k| [Pa] of the harmonics of `order`, by the trapezoidal rule on uneven `x`."""
    finite = np.isfinite(x) & np.isfinite(pressure)
    position = np.mod(x[finite], period)
    sequence = np.argsort(position)
    position, height = position[sequence], pressure[finite][sequence]
    width = np.diff(np.append(position, position[0] + period))
    weight = 0.5 * (width + np.roll(width, 1))
    phase = np.exp(-2j * np.pi * np.outer(order, position) / period)
    return np.asarray(np.abs(phase @ (weight * height)) / period)


@dataclass(frozen=True, repr=False)
class ScaleResult(Pictured):
    """Contact and friction of one wave, or of one period of a profile, with the evidence for them.

    All lengths in m, pressures in Pa, speeds in m/s, angular frequencies in rad/s.
    """

    wavelength: float
    """Of the wave; of a profile the period [m]."""
    amplitude: float
    """Of the wave; of a profile half the range of heights [m]."""
    pressure_received: float
    """Mean pressure on this wave [Pa]."""
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

    A twentieth of the larger friction. Frictions below 0.04 of the slope 2 pi amplitude/wavelength
    (root of two times the rms slope of a profile) have the bound of that value.
    """
    loss_by_depth: tuple[Array, Array] | None = field(default=None, repr=False, compare=False)
    """Depths between the rows of elements at rest [m], shape (rows + 1,), and the contribution of
    each row to `friction_from_dissipation` [-], shape (rows,); None if unknown. Not written to
    files."""
    solution: Any = field(default=None, repr=False, compare=False)
    """State of the solver, to start another wave from; not written to files."""

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields without the state of the solver, which cannot be pickled."""
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
        """The status, with both frictions if they disagree, or the share of the pressure."""
        if self.converged:
            return str(self.status)
        if self.status == Status.FRICTIONS_DISAGREE:
            slope = self.details.get("contact_slope")
            where = "" if slope is None else f" with contact on slopes up to {slope:.2g}"
            return (
                f"{self.status}, {self.friction:.3g} from traction and "
                f"{self.friction_from_dissipation:.3g} from dissipation{where}: "
                "more columns are needed"
            )
        reached = self.details.get("load_reached", math.nan)
        if self.status == Status.CONTACT_TOO_NARROW and "expected_contact_width" in self.details:
            return (
                f"{self.status}: about {self.details['expected_contact_width']:.2g} m is expected, "
                f"the finest mesh resolves {self.details['smallest_contact_width']:.2g} m; "
                "the pressure is too small for the block"
            )
        if "smallest_wave_carried" in self.details:
            return (
                f"{self.status} for {self.details['columns']} columns: solved with waves down to "
                f"{self.details['smallest_wave_carried']:.2g} m only; leave out shorter waves, or "
                "take more columns"
            )
        if not math.isfinite(reached) or reached == 1.0:
            return str(self.status)
        return f"{self.status} at {100.0 * reached:.3g} % of the pressure"

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two frictions, which is an error of the discretisation."""
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0

    @property
    def slope(self) -> float:
        """Largest slope of a sine, 2 pi amplitude / wavelength [-].

        For a profile that of a sine with its period and range; the profile itself is steeper.
        """
        return 2.0 * math.pi * self.amplitude / self.wavelength

    @property
    def angular_frequency(self) -> float:
        """Fundamental excitation 2 pi speed / wavelength [rad/s], of the wave or the period."""
        return 2.0 * math.pi * self.speed / self.wavelength

    @property
    def modulus(self) -> float:
        """|E*| of the rubber at the fundamental excitation [Pa], NaN if unknown."""
        return abs(self._complex_modulus())

    @property
    def loss_factor(self) -> float:
        """Tan delta = E''/E' of the rubber at the fundamental excitation [-], NaN if unknown."""
        modulus = self._complex_modulus()
        return modulus.imag / modulus.real

    @property
    def outside_band(self) -> bool:
        """Whether more than 1 % of the friction uses the rubber beyond its measured band."""
        return self.extrapolation.share > WORTH_SAYING

    @property
    def extrapolation(self) -> Extrapolation:
        """Share of the friction that uses the rubber beyond its measured band; zero at rest.

        The share of a sine is 1 if its fundamental, or its harmonic n = ceil(wavelength / contact
        length), is beyond the band. The friction of a profile is split by the harmonics of its
        pressure, |p_k|^2 Im(M)/|M|^2 each, as on a half-plane.
        """
        if self.speed == 0.0:
            return extrapolation.NOTHING_BEYOND
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

    def plot(self) -> Figure:
        """Draw contact pressure and deformed mesh; see `gripscale.questions.block_figure`."""
        return gripscale.questions.block_figure(waves_to_dataset([self]))

    def _complex_modulus(self) -> complex:
        if self.rubber is None:
            return complex(math.nan, math.nan)
        return complex(self.rubber.complex_modulus(self.angular_frequency))


LW = "Lind & Wangenheim 2014, IMECE2014-37998"
CHAIN = "gripscale chain"
SOLVER = "gripscale solver of one wave"


class Number(NamedTuple):
    """A number of a wave: its name in a Dataset, and the attribute or path of a `ScaleResult`."""

    kind: str
    name: str
    attribute: str
    unit: str
    long_name: str
    source: str

    def variable(self, values: Any) -> xr.Variable:
        """Return `values` over the waves as a labelled variable."""
        return labelled("scale", values, self.unit, self.long_name, self.source)


_TABLE = csv.reader(files(__package__).joinpath("numbers.csv").read_text("utf-8").splitlines())
_NUMBERS = [Number(*row) for row in _TABLE]
_KINDS = ("field", "derived", "detail")
FIELDS, DERIVED, DETAILS = ([n for n in _NUMBERS if n.kind == kind] for kind in _KINDS)


def waves_to_dataset(results: Sequence[ScaleResult]) -> xr.Dataset:
    """Return `results` over `scale`; what lies along the waves is padded with NaN."""
    data: dict[str, xr.Variable] = {}
    for number in (*FIELDS, *DERIVED):
        values = np.array([attrgetter(number.attribute)(result) for result in results])
        if number.name == "friction_mismatch":  # without sliding there are no frictions to compare
            values = np.where([result.speed > 0.0 for result in results], values, math.nan)
        if values.dtype == bool:
            values = values.astype(np.int8)
        data[number.name] = number.variable(values)
    for detail in DETAILS:
        values = np.array([float(r.details.get(detail.name, math.nan)) for r in results])
        if np.isfinite(values).any():
            data[detail.name] = detail.variable(values)

    dims: tuple[str, ...] = ("scale", "surface_node")
    x, pressure = padded([r.x for r in results]), padded([r.pressure for r in results])
    data["surface_x"] = labelled(dims, x, "m", "deformed abscissa, crest of the wave at 0", SOLVER)
    data["surface_pressure"] = labelled(dims, pressure, "Pa", "contact pressure", SOLVER)
    meshes = [result.deformed_mesh for result in results]
    if any(mesh is not None for mesh in meshes):
        dims, empty = ("scale", "layer", "column"), np.zeros((0, 0))
        for i, (name, words) in enumerate((("mesh_x", "abscissa"), ("mesh_z", "height"))):
            positions = padded([empty if mesh is None else mesh[i] for mesh in meshes])
            data[name] = labelled(dims, positions, "m", f"{words} of the deformed nodes", SOLVER)

    rubbers = [r.rubber and json.dumps(r.rubber.to_dict()) for r in results]
    for name, long_name, texts in (
        ("status", "converged, or why not", [str(r.status) for r in results]),
        ("wave_solver", "solver of the wave", [r.model for r in results]),
        ("rubber_parameters", "the rubber", [text or "" for text in rubbers]),
    ):
        data[name] = labelled("scale", np.array(texts, dtype=object), "1", long_name, SOLVER)
    scale = labelled("scale", np.arange(1, len(results) + 1), "1", "number of the wave", CHAIN)
    return xr.Dataset(data, coords={"scale": scale})


def waves_from_dataset(data: xr.Dataset) -> list[ScaleResult]:
    """Return the waves of a Dataset, equal to the original ones except for solver states."""
    out = []
    for i in range(data.sizes["scale"]):
        wave = data.isel(scale=i)
        fields = {f.attribute: float(wave[f.name]) for f in FIELDS if f.name in wave}
        details = {f.name: float(wave[f.name]) for f in DETAILS if f.name in wave}
        rubber = str(wave["rubber_parameters"].item())
        node = np.isfinite(wave["surface_x"].values)
        mesh = None
        if "mesh_x" in wave:
            x, z = wave["mesh_x"].values, wave["mesh_z"].values
            layers, columns = np.isfinite(x).any(axis=1), np.isfinite(x).any(axis=0)
            mesh = (x[layers][:, columns], z[layers][:, columns]) if layers.any() else None
        out.append(
            ScaleResult(
                **{**fields, "newton_iterations": int(fields["newton_iterations"])},  # type: ignore[arg-type]
                status=Status(str(wave["status"].item())),
                model=str(wave["wave_solver"].item()),
                rubber=Rubber.from_dict(json.loads(rubber)) if rubber else None,
                x=wave["surface_x"].values[node],
                pressure=wave["surface_pressure"].values[node],
                deformed_mesh=mesh,
                details={name: value for name, value in details.items() if math.isfinite(value)},
            )
        )
    return out


def padded(arrays: Sequence[Array]) -> Array:
    """Return arrays of different sizes as one array, padded with NaN."""
    shapes = np.array([array.shape for array in arrays])
    out = np.full((len(arrays), *shapes.max(axis=0, initial=0)), math.nan)
    for row, array in zip(out, arrays, strict=True):
        row[tuple(slice(length) for length in array.shape)] = array
    return out
