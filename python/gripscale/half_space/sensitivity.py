"""What decides the friction of a direct contact: its derivatives, from one adjoint solution.

With K the response of the half-space, A the points in contact, N points and mu = p . D p / (N p_0),

    (K^T lam)_A + nu = 2 (D p)_A / (N p_0),    sum lam = 0,    lam = 0 outside A,
    d mu / d h(x) = lam(x),    d mu / d ln p_0 = nu N p_0 - mu,    d mu = Re sum_q c(q) dM/M.

docs/derivations.md has c(q), the change of M with E' and E'', and why A may be taken as fixed. The
contact fraction has no such derivative: its are differences of contacts.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy
import xarray as xr

from gripscale.conditions.conditions import state_by_scale
from gripscale.core import InputError, RubberWarning, checks, labelled, provenance
from gripscale.core.arrays import Array, ComplexArray, Quantity
from gripscale.half_space.active_set import DIFFERENCE_ACCURACY, close_gap, solve_grid
from gripscale.half_space.grid import Grid
from gripscale.half_space.grid_sequence import grid_contact_fraction
from gripscale.half_space.response import HalfSpace, Response
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.theory.layers import Layers

# Residual of the adjoint system over its right side, both as pressures. Five digits of the
# derivatives would do; the two frictions' identities hold to this.
ADJOINT_TOLERANCE = 1e-8
SPEED_STEP = 1e-3  # change of ln v in the differences of the moduli, which are smooth
TEMPERATURE_STEP = 0.01  # [K], likewise
# Change of the logarithm of an input in differences of the contact fraction. A tenth of it moves
# too few points of a grid in and out of contact.
AREA_STEP = 0.2
_SOURCE = "gripscale adjoint of the direct contact"

# By the end of their name in a Dataset.
Derivatives = Mapping[str, Array | float]

TEXTS = {
    "ln_storage": ("1", "E' in the band"),
    "ln_loss": ("1", "E'' in the band"),
    "ln_modulus": ("1", "a modulus of the Prony series"),
    "ln_speed": ("1", "speed"),
    "ln_pressure": ("1", "nominal pressure"),
    "ln_bulk_modulus": ("1", "bulk modulus"),
    "ln_cut_off": ("1", "smallest wavelength"),
    "temperature": ("1/K", "temperature"),
}


@dataclass(frozen=True)
class FrictionAdjoint:
    """Multipliers of a solved contact, and the derivatives of its friction from dissipation."""

    contact: RoughContact = field(repr=False)
    layer: int  # of a stack, whose moduli count
    multiplier: Array = field(repr=False)  # N p_0 lam, shape of the grid [Pa / m]
    rigid: float  # N p_0 nu [-]
    products: int  # products with the transposed response
    residual: float  # of the linear system, relative [-]

    @classmethod
    def of(
        cls, contact: RoughContact, layer: int = 0, tolerance: float = ADJOINT_TOLERANCE
    ) -> FrictionAdjoint:
        """Return the multipliers of a contact that slides."""
        grid = contact.grid
        response = Response.of(contact.body, grid, 1)
        where = np.flatnonzero(contact.active)
        lost = -2.0 * grid.along * response.compliance.imag * scipy.fft.rfftn(contact.pressure)
        right = scipy.fft.irfftn(lost, s=grid.shape).reshape(-1)[where]
        gap = np.zeros(grid.points)
        gap[where] = -right
        start = np.zeros(where.size)
        closed = close_gap(response.transposed, where, gap, start, tolerance, check=True)
        multiplier = np.zeros(grid.points)
        multiplier[where] = closed.pressure
        rigid = -float(np.mean(gap[where]))
        field = multiplier.reshape(grid.shape)
        return cls(contact, layer, field, rigid, closed.products, closed.missing)

    @property
    def by_height(self) -> Array:
        """Derivative of mu by the height of each point of the grid [1/m]."""
        return self.multiplier / (self.contact.grid.points * self.contact.nominal_pressure)

    @property
    def by_log_pressure(self) -> float:
        """Derivative of mu by ln p_0 [-]."""
        return self.rigid - self.contact.friction_from_dissipation

    @cached_property
    def weight(self) -> ComplexArray:
        """c(q) [-], over the half spectrum of the grid."""
        contact, grid = self.contact, self.contact.grid
        compliance = contact.body.compliance(grid)
        pressure = scipy.fft.rfftn(contact.pressure)
        other = scipy.fft.rfftn(self.multiplier) + 1j * grid.along * pressure
        scale = grid.weight / (grid.points**2 * contact.nominal_pressure)
        return np.asarray(scale * compliance * other.conj() * pressure)

    def by_modulus(self, change: ComplexArray) -> Array:
        """Return what `change` in ln M of each wave [-] changes in mu, over the half spectrum."""
        return np.asarray((self.weight * _on_grid(change, self.contact.grid)).real)

    def by_log_terms(self) -> Array:
        """Return d mu / d ln E_i [-] of the Prony moduli, the equilibrium modulus first."""
        contact, (_, relative) = self.contact, relative_change(self.contact, self.layer)
        scales = contact.by_scale
        rubber = contact.body.of_layer(self.layer).rubber if scales is None else scales.rubber

        def young_modulus(terms: slice) -> ComplexArray:
            # the whole rubber has warned
            with warnings.catch_warnings(action="ignore", category=RubberWarning):
                alone = Rubber(
                    rubber.equilibrium_modulus,
                    rubber.moduli[terms],
                    rubber.relaxation_times[terms],
                    rubber.bulk_modulus,
                )
            by_scale = None if scales is None else replace(scales, rubber=alone)
            return HalfSpace(alone, contact.speed, by_scale=by_scale).young_modulus(contact.grid)

        relaxed = young_modulus(slice(0))
        terms = [slice(at, at + 1) for at in range(rubber.moduli.size)]
        changes = [relaxed, *(young_modulus(term) - relaxed for term in terms)]
        return np.array([float(self.by_modulus(relative * change).sum()) for change in changes])

    def log_derivatives(self, bands: Bands) -> Derivatives:
        """Return the derivatives of ln mu; those of E' and E'' by band."""
        contact = self.contact
        friction = contact.friction_from_dissipation
        storage, loss = modulus_changes(contact, self.layer)
        scalars = scalar_changes(contact, self.layer)
        return {
            "temperature": math.nan,
            "ln_storage": bands.sums(self.by_modulus(storage)) / friction,
            "ln_loss": bands.sums(self.by_modulus(loss)) / friction,
            "ln_modulus": self.by_log_terms() / friction,
            **{name: float(self.by_modulus(by).sum()) / friction for name, by in scalars.items()},
            "ln_pressure": self.by_log_pressure / friction,
            "ln_cut_off": contact.cut_off_exponents.friction,
        }


def _on_grid(change: ComplexArray, grid: Grid) -> ComplexArray:
    """Return a change in ln M; of |M|, by its real part, where a wave is its own opposite."""
    return np.where(grid.own_opposite, change.real, change)


def half_space_of(
    contact: RoughContact, *, speed: float | None = None, warmer: float = 0.0
) -> HalfSpace:
    """Return the rubber of a contact, strained as it is, at another speed [m/s] or `warmer` [K]."""
    sliding, scales = contact.speed if speed is None else speed, contact.by_scale

    def warmed(rubber: Rubber) -> Rubber:
        kelvin = rubber.reference_temperature
        return rubber.at(kelvin + warmer) if warmer and kelvin is not None else rubber

    if contact.layers is not None:
        layers = [(warmed(rubber), height) for rubber, height in contact.layers]
        return HalfSpace(layers[0][0], sliding, layers=Layers(layers))
    rubber, before = contact.rubber, contact.rubber.reference_temperature
    if contact.scales is None or contact.conditions is None:
        rubber = warmed(rubber)
    elif warmer and before is not None:
        scales = state_by_scale(
            replace(contact.conditions, temperature=before + warmer),
            rubber,
            wavenumber=contact.scales.wavenumber,
            warming=contact.scales.warming,
            strain=contact.scales.strain,
        ).rubber
    return HalfSpace(rubber, sliding, by_scale=scales, thickness=contact.thickness)


def modulus_changes(contact: RoughContact, layer: int = 0) -> tuple[ComplexArray, ComplexArray]:
    """Return dln M / dln E' and dln M / dln E'' of each wave [-], over the half spectrum."""
    modulus, relative = relative_change(contact, layer)
    return relative * modulus.real, relative * 1j * modulus.imag


def relative_change(contact: RoughContact, layer: int = 0) -> tuple[ComplexArray, ComplexArray]:
    """Return E* [Pa] of a layer and dln M / dE* [1/Pa] of each wave, over the half spectrum."""
    grid, body = contact.grid, contact.body
    modulus = np.broadcast_to(body.of_layer(layer).young_modulus(grid), grid.spectrum_shape)
    return modulus, body.log_modulus_by(grid, layer)[0] / modulus


def scalar_changes(contact: RoughContact, layer: int = 0) -> dict[str, ComplexArray]:
    """Return the derivatives of ln M of each wave, over the half spectrum, by names of `TEXTS`.

    By temperature [1/K] only with a shift of every rubber. The bulk modulus is that of a layer.
    """
    grid = contact.grid

    def difference(low: HalfSpace, high: HalfSpace, step: float) -> ComplexArray:
        change = np.log(high.modulus(grid) / low.modulus(grid)) / (2.0 * step)
        return np.asarray(np.broadcast_to(change, grid.spectrum_shape))

    slow, fast = (
        half_space_of(contact, speed=contact.speed * math.exp(by))
        for by in (-SPEED_STEP, SPEED_STEP)
    )
    stiffening = contact.body.log_modulus_by(grid, layer)[1]
    changes = {
        "ln_speed": difference(slow, fast, SPEED_STEP),
        "ln_bulk_modulus": np.broadcast_to(stiffening, grid.spectrum_shape),
    }
    rubbers = contact.body.rubbers
    if all(each.shift is not None and each.reference_temperature is not None for each in rubbers):
        cold, warm = (
            half_space_of(contact, warmer=by) for by in (-TEMPERATURE_STEP, TEMPERATURE_STEP)
        )
        changes["temperature"] = difference(cold, warm, TEMPERATURE_STEP)
    return changes


@dataclass(frozen=True)
class Bands:
    """Bands of the frequencies that the waves of a contact excite, equal in their logarithm."""

    edge: Array  # [rad/s], rising, shape (bands + 1,)
    of_wave: Array  # band of each wave, over the half spectrum; the first also holds waves at rest

    @classmethod
    def of(cls, contact: RoughContact, per_decade: int, shift: float = 1.0) -> Bands:
        """Return the bands of a contact, `shift` times its frequencies; heat shifts them, too."""
        grid = contact.grid
        omega = np.broadcast_to(np.abs(grid.along) * contact.speed * shift, grid.spectrum_shape)
        if contact.by_scale is not None:
            omega = omega * contact.by_scale.shift(grid.wavenumber)
        moving = omega > 0.0
        decade = np.floor(per_decade * np.log10(np.where(moving, omega, np.inf)) + 1e-9)
        first, last = decade.min(), decade[moving].max()
        of_wave = np.where(moving, decade - first, 0.0).astype(int)
        return cls(10.0 ** (np.arange(first, last + 2.0) / per_decade), of_wave)

    @property
    def centre(self) -> Array:
        """Geometric centre of each band [rad/s]."""
        return np.sqrt(self.edge[:-1] * self.edge[1:])

    def sums(self, values: Array) -> Array:
        """Return the sum of values of the half spectrum over each band."""
        weights = np.broadcast_to(values, self.of_wave.shape).reshape(-1)
        return np.bincount(self.of_wave.reshape(-1), weights, self.edge.size - 1).astype(float)


@dataclass(frozen=True)
class ContactFractionDifferences:
    """Derivatives of the contact fraction, from contacts on the same grid with other inputs."""

    contact: RoughContact
    layer: int = 0

    @cached_property
    def compliance(self) -> ComplexArray:
        """K(q) of the contact [m/Pa], over the half spectrum."""
        return self.contact.body.compliance(self.contact.grid)

    def log_derivatives(self, bands: Bands) -> Derivatives:
        """Return the derivatives of ln(A_r/A_0); those of E' and E'' by band."""
        contact = self.contact

        def by_band(change: ComplexArray) -> Array:
            each = (np.where(bands.of_wave == n, change, 0.0) for n in range(bands.centre.size))
            return np.array([self.by_modulus(part) for part in each])

        storage, loss = modulus_changes(contact, self.layer)
        scalars = scalar_changes(contact, self.layer)
        return {
            "temperature": math.nan,
            "ln_storage": by_band(storage),
            "ln_loss": by_band(loss),
            **{name: self.by_modulus(change) for name, change in scalars.items()},
            "ln_pressure": self.by_log_pressure(),
            "ln_cut_off": contact.cut_off_exponents.contact_fraction,
        }

    def by_modulus(self, change: ComplexArray) -> float:
        """Return d ln(A_r/A_0) along a derivative of ln M of each wave, over the half spectrum."""
        largest = float(np.abs(change).max())
        if largest == 0.0:
            return 0.0
        return self._difference(_on_grid(change, self.contact.grid), 0.0, AREA_STEP / largest)

    def by_log_pressure(self) -> float:
        """Return d ln(A_r/A_0) / d ln p_0 [-]."""
        return self._difference(0.0, 1.0, AREA_STEP)

    def _difference(self, stiffer: ComplexArray | float, pressed: float, step: float) -> float:
        """Return d ln(A_r/A_0) along changes of ln M and ln p_0."""
        contact, logs = self.contact, []
        for by in (-step, step):
            compliance = self.compliance * np.exp(-by * stiffer)
            response = Response.with_compliance(compliance, contact.grid, 1)
            pressure = contact.nominal_pressure * math.exp(by * pressed)
            start = contact.pressure * (pressure / contact.pressure.mean())
            solved = solve_grid(response, contact.height, start, DIFFERENCE_ACCURACY)
            fraction = grid_contact_fraction(solved.active, solved.gap, response.loss_angle)
            logs.append(math.log(fraction))
        return (logs[1] - logs[0]) / (2.0 * step)


def contact_sensitivity(
    contact: RoughContact,
    *,
    bands_per_decade: int = 2,
    contact_fraction: bool = False,
    reference_temperature: Quantity | None = None,
    layer: int = 0,
) -> xr.Dataset:
    """Return the derivatives of the friction of a direct contact by all of its inputs.

    The friction is that from the energy lost. Under conditions the rubber of each scale keeps its
    strain and temperature rise (`settled` in the attributes). Raises `InputError` if the contact is
    at rest, has no friction or not this layer, or if the rubber has no shift to the reference
    temperature.

    Parameters
    ----------
    contact : RoughContact
        Of `solve_rough_contact`, sliding, with friction above zero.
    bands_per_decade : int
        Bands of frequency in a decade.
    contact_fraction : bool
        Also the derivatives of the contact fraction, under the same names. They are differences of
        four further contacts a band, each a few per cent of the cost of the first.
    reference_temperature : float, optional
        Temperature that the frequencies are shifted to [K], such as that of a master curve; the
        rubber's before the contact by default.
    layer : int
        Of a stack, the layer whose moduli count, zero for that in contact. Speed and temperature
        are those of all layers.

    Returns
    -------
    xarray.Dataset
        Over `frequency` [rad/s], the centre of a band: `d_ln_friction_d_ln_storage` and
        `d_ln_friction_d_ln_loss` [-], of E' and E'' in the band; the bands add up, and the lowest
        holds the relaxed modulus. Scalars: `d_ln_friction_d_ln_speed`, `..._ln_pressure`,
        `..._ln_bulk_modulus`, `..._ln_cut_off` (from the contact with twice the cut-off), and
        `d_ln_friction_d_temperature` [1/K], NaN without a shift. Over `term`:
        `d_ln_friction_d_ln_modulus` [-], of the moduli of the Prony series with `relaxation_time`
        [s], infinite for the equilibrium modulus. Over `x` [m], and `y` of a map:
        `d_friction_d_height` [1/m], of the height of one point of the grid.
    """
    checks.instance("contact", contact, RoughContact)
    checks.whole("layer", layer, least=0, most=len(contact.body.rubbers) - 1)
    rubber = contact.body.of_layer(layer).rubber
    if contact.speed == 0.0 or not contact.friction_from_dissipation > 0.0:
        raise InputError(
            "contact must slide with friction above zero for the derivatives of its logarithm; got "
            f"speed {contact.speed:g} m/s and friction {contact.friction_from_dissipation:.3g}"
        )
    contact.require_dry("derivatives do not know the pools")
    per_decade = checks.whole("bands_per_decade", bands_per_decade, least=1, most=100)
    adjoint = FrictionAdjoint.of(contact, layer)
    shift = 1.0
    if reference_temperature is not None:
        reference = rubber.at(reference_temperature)
        shift = float(rubber.relaxation_times[0] / reference.relaxation_times[0])
    bands = Bands.of(contact, per_decade, shift)
    axes = ("x", "y")[: contact.height.ndim]
    friction_text = "friction coefficient from the energy lost"
    data = {
        name: labelled((), value, "1", text, _SOURCE)
        for name, value, text in (
            ("friction", contact.friction_from_dissipation, friction_text),
            ("contact_fraction", contact.contact_fraction, "real over nominal contact area"),
            ("residual_adjoint", adjoint.residual, "residual of the adjoint system"),
            ("products", float(adjoint.products), "products with the transposed response"),
        )
    }
    derivatives = {"friction": adjoint.log_derivatives(bands)}
    if contact_fraction:
        differences = ContactFractionDifferences(contact, layer)
        derivatives["contact_fraction"] = differences.log_derivatives(bands)
    for quantity, by in derivatives.items():
        for name, value in by.items():
            unit, text = TEXTS[name]
            along = "term" if name == "ln_modulus" else "frequency"
            data[f"d_ln_{quantity}_d_{name}"] = labelled(
                () if np.ndim(value) == 0 else along,
                value,
                unit,
                f"d ln {quantity.replace('_', ' ')} by {text}",
                _SOURCE,
            )
    data["d_friction_d_height"] = labelled(
        axes, adjoint.by_height, "1/m", "d friction / d height of a point", _SOURCE
    )
    times = [math.inf, *rubber.relaxation_times]
    coordinates = {
        "frequency": labelled("frequency", bands.centre, "rad/s", "centre of the band", _SOURCE),
        **{axis: labelled(axis, getattr(contact, axis), "m", axis, "input") for axis in axes},
        "relaxation_time": labelled("term", times, "s", "of the Prony term", "input"),
    }
    attributes = {
        "title": "Derivatives of the friction of a direct contact",
        "status": str(contact.status),
        "bands_per_decade": per_decade,
        "settled": int(contact.by_scale is not None),
        "rubber": f"{rubber.name}; {rubber.source}".strip("; "),
        "nominal_pressure": contact.nominal_pressure,
        "speed": contact.speed,
    }
    return xr.Dataset(data, coordinates, attributes | provenance.version_attributes())
