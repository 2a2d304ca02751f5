"""Persson's theory: contact area and hysteresis friction of a randomly rough surface.

B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626; S: M. Scaraggi & B. N. J.
Persson, J. Phys.: Condens. Matter 27 (2015) 105102, doi:10.1088/0953-8984/27/10/105102. Equations,
cut-off, softening and limits: docs/theories.md. M is 2 / (q K(q)) of `gripscale.theory.layers`
where the rubber has a thickness. `TheoryResult` is the base of the results of all theories.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gripscale import model
from gripscale.conditions.conditions import Conditions
from gripscale.core import (
    ZERO_CELSIUS,
    Array,
    Described,
    InputError,
    Quantity,
    Status,
    checks,
    provenance,
)
from gripscale.core.checks import Checked, checked
from gripscale.cut_off_exponents import NOT_CONVERGED, of_curve
from gripscale.model import Load, Model, OnProgress
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import by_wavelength
from gripscale.surface import Profile, areal_spectrum, profile_spectrum
from gripscale.surface.low_pass import transmission
from gripscale.surface.spectrum import ArealSpectrum, ProfileSpectrum, last_wavenumber
from gripscale.surface.surface import Surface, SurfacePart
from gripscale.theory import layers

if TYPE_CHECKING:
    import xarray as xr


Values = tuple[Array, ...]
# Name of variable and attribute, dimension, unit and meaning.
Variable = tuple[str, Any, str, str]


@dataclass(frozen=True, repr=False)
class TheoryResult(Described):
    """Base of the results of theories: friction down to each wavelength and its Dataset."""

    name: ClassVar[str]
    title: ClassVar[str]
    source: ClassVar[str]
    variables: ClassVar[Sequence[Variable]]

    rubber: Rubber
    load: Load
    # `converged` if doubling the resolution changed every integral by less than the tolerance.
    status: Status
    # Cut-offs, from the largest wave of the surface falling to the smallest one asked for [m].
    wavelength: Array = field(repr=False)
    running_friction: Array = field(repr=False)  # friction coefficient with each cut-off [-]
    # Change of the friction coefficient when the resolution was doubled last [-].
    friction_error: float

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area [-]; NaN of a theory without it."""
        return math.nan

    @property
    def friction(self) -> float:
        """Friction coefficient [-]."""
        return float(self.running_friction[-1])

    @property
    def converged(self) -> bool:
        """Whether the integrals met the tolerance."""
        return self.status == Status.CONVERGED

    def to_dataset(self) -> xr.Dataset:
        """Return everything over `scale`, the wavelengths; totals are NaN unless it converged."""
        import xarray as xr

        from gripscale.core.arrays import labelled

        data = {
            variable: labelled(dims, getattr(self, variable), unit, text, self.source)
            for variable, dims, unit, text in self.variables
        }
        number = np.arange(1, self.wavelength.size + 1)
        coordinate = labelled("scale", number, "1", "number of the wavelength", self.source)
        out = xr.Dataset(data, coords={"scale": coordinate}).assign_attrs(
            title=self.title,
            rubber=f"{self.rubber.name}; {self.rubber.source}".strip("; "),
            rubber_parameters=json.dumps(self.rubber.to_dict()),
            method=self.source,
            **provenance.version_attributes(),
        )
        speed, friction = self.load.speed, self.running_friction
        area = getattr(self, "running_contact_fraction", np.full(number.size, math.nan))
        totals, exponents = dict.fromkeys(model.TOTALS, math.nan), NOT_CONVERGED
        if self.converged:
            totals = dict.fromkeys(model.TOTALS, self.friction)
            totals["total_contact_fraction"] = self.contact_fraction
            exponents = of_curve(self.wavelength, area, friction, moving=speed > 0.0)
        beyond = by_wavelength(self.rubber, speed, self.wavelength, friction)
        return model.predicted_answer(
            out, totals, str(self.status), self.name, self.load, beyond, exponents
        )


def divided(nodes: Array, intervals: int) -> Array:
    """Return `nodes` with each step between them cut into so many equal intervals."""
    inside = np.arange(intervals) / intervals
    return np.append((nodes[:-1, None] + np.diff(nodes)[:, None] * inside).ravel(), nodes[-1])


def filled_in(nodes: Array, widest: float) -> Array:
    """Return `nodes` with wider steps than `widest` cut into equal ones."""
    parts = np.ceil(np.diff(nodes) / widest).astype(int)
    cut = [divided(nodes[at : at + 2], count)[:-1] for at, count in enumerate(parts)]
    return np.concatenate([*cut, nodes[-1:]])


def running_integral(values: Array, x: Array) -> Array:
    """Return the integral of `values` along their last axis from the first to each `x`."""
    steps = 0.5 * (values[..., 1:] + values[..., :-1]) * np.diff(x)
    return np.concatenate((np.zeros_like(values[..., :1]), np.cumsum(steps, axis=-1)), axis=-1)


def refine_intervals(
    at: Callable[[int], Values], first: int, most: int, tolerance: float
) -> tuple[Values, tuple[float, ...], Status]:
    """Return `at(intervals)` on a fine grid, its change by the last doubling, and the status.

    Intervals are doubled from `first` until the last entry of every array changes by less than
    `tolerance` of itself, or `most` is reached.
    """
    coarse = at(first)
    while True:
        first *= 2
        fine = at(first)
        errors = tuple(float(abs(b[-1] - a[-1])) for a, b in zip(coarse, fine, strict=True))
        met = all(e <= tolerance * abs(b[-1]) for e, b in zip(errors, fine, strict=True))
        if met or first >= most:
            return fine, errors, Status.CONVERGED if met else Status.TOLERANCE_NOT_MET
        coarse = fine


_TOLERANCE = 1e-4  # relative error of the integrals below which a result is converged
# Intervals between neighbouring points of the spectrum, doubled from the first to the last.
_COARSEST, _FINEST = 4, 128
_WIDEST = 0.25  # widest step of log q on the coarsest grid, times the intervals there
_ANGLES = 12  # angles of a quarter turn beyond the number of intervals


@dataclass(frozen=True, repr=False)
class PerssonResult(TheoryResult):
    """Contact and friction of a randomly rough surface, down to each wavelength.

    All lengths in m, pressures in Pa, speeds in m/s; numbers along `wavelength` have its shape.
    """

    name = "persson"
    title = "Real contact area and friction of rubber on a randomly rough surface"
    source = "Persson 2001, J. Chem. Phys. 115, 3840"
    variables = (
        ("wavelength", "scale", "m", "wavelength"),
        ("running_contact_fraction", "scale", "1", "real over nominal contact area so far"),
        ("running_friction", "scale", "1", "friction coefficient so far"),
        ("rms_gradient", (), "1", "areal root mean square gradient"),
        ("profile_rms_slope", (), "1", "root mean square slope of lines"),
        ("contact_fraction_error", (), "1", "estimated error of the contact fraction"),
        ("friction_error", (), "1", "estimated error of the friction coefficient"),
        ("gamma", (), "1", "share of the deformation left in small contacts"),
    )

    running_contact_fraction: Array = field(repr=False)
    """A/A_0 down to each wavelength, P(q) [-]."""
    contact_fraction_error: float
    """Change of the contact fraction when the resolution was doubled last [-]."""
    gamma: float
    rms_gradient: float
    """Of the surface, down to the smallest wavelength: areal [-]."""
    profile_rms_slope: float
    """Of lines through the same waves: the areal number over sqrt(2) [-]."""
    conditions: Conditions | None = None

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area [-]."""
        return float(self.running_contact_fraction[-1])

    @property
    def notes(self) -> str:
        """What of the conditions the theory does not have, and a strain beyond their law."""
        if self.conditions is None:
            return ""
        out = [word for word in ("heat", "water") if getattr(self.conditions, word) is not None]
        text = f"Without {' and '.join(out)}, which Persson's theory does not have." if out else ""
        law, strain = self.conditions.softening, STRAIN_OF_GRADIENT * self.rms_gradient
        kelvin = self.conditions.temperature_of(self.rubber)
        if law is not None and np.any(law.factors(strain, kelvin).outside):
            text += f" Strain or temperature of the softening ends before {strain:.2g}"
            text += "." if kelvin is None else f" or {kelvin - ZERO_CELSIUS:.3g} C."
        return text.strip()

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield the notes first."""
        yield from [("notes", self.notes)] if self.notes else []
        yield from super().shown_rows()

    def to_dataset(self) -> xr.Dataset:
        """Return everything over `scale`, with the area term of the conditions."""
        data, effects = super().to_dataset(), self.conditions
        if effects is None:
            return data
        area = self.contact_fraction if self.converged else math.nan
        kelvin = effects.temperature_of(self.rubber)
        term = effects.adhesive_friction(area, self.load.pressure, self.load.speed, kelvin)
        return model.with_area_term(data, term).assign_attrs(notes=self.notes)


def persson(
    rubber: Rubber,
    spectrum: ArealSpectrum | ProfileSpectrum,
    *,
    pressure: Quantity,
    speed: Quantity,
    smallest_wavelength: Quantity | None = None,
    gamma: float = 0.5,
    thickness: Quantity | None = None,
    conditions: Conditions | None = None,
) -> PerssonResult:
    """Return contact and friction of a randomly rough surface by Persson's theory.

    A `status` other than "converged" says that the integrals are not accurate. Raises `InputError`
    if an argument is out of its range.

    Parameters
    ----------
    rubber : Rubber
        The sliding half-space, at small strain.
    spectrum : ArealSpectrum or ProfileSpectrum
        Of the surface; of a line, `areal_spectrum` makes it that of an isotropic surface.
    pressure, speed : float
        Nominal pressure [Pa], above zero, and sliding speed [m/s]; zero is static contact of the
        relaxed rubber, without friction.
    smallest_wavelength : float, optional
        Cut-off of the surface [m], see `gripscale.solve_rough_contact`; by default all waves of the
        spectrum count in full.
    gamma : float
        Share of the deformation that is left where contact is small, 0 to 1.
    thickness : float, optional
        Thickness of the rubber on a rigid base [m]; None: a half-space.
    conditions : Conditions, optional
        Temperature, softening and area term count; heat and water do not, see `.notes`.
    """
    checks.instance("rubber", rubber, Rubber)
    effects = Conditions() if conditions is None else replace(conditions, heat=None, water=None)
    solid = effects.before(rubber)
    if isinstance(spectrum, ProfileSpectrum):
        spectrum = areal_spectrum(spectrum)
    if not isinstance(spectrum, ArealSpectrum):
        raise InputError(
            f"spectrum must be an ArealSpectrum or a ProfileSpectrum; "
            f"got {checks.short_repr(spectrum)}"
        )
    share = checks.share("gamma", gamma)
    end = last = last_wavenumber(spectrum.wavenumber, smallest_wavelength)
    if smallest_wavelength is not None:
        end = min(LAST_OVER_CUT_OFF * last, float(spectrum.wavenumber[-1]))
    inside = spectrum.wavenumber[spectrum.wavenumber < end]
    points = np.unique(np.concatenate((inside, (last, end))))
    nodes = np.exp(filled_in(np.log(points), _WIDEST))
    ends, kept = None, spectrum
    if smallest_wavelength is not None:
        ends = nodes[nodes <= last * (1.0 + 1e-9)]
        passed = gaussian_power(nodes, ends[-1:])[0]
        kept = ArealSpectrum(nodes, spectrum.at(nodes) * passed)
    load = Load(pressure, speed, 2.0 * np.pi / nodes[0], thickness=thickness)
    (area, friction), (area_error, friction_error), status = refine_intervals(
        partial(integrals, solid, effects, spectrum, load, share, nodes, ends),
        _COARSEST,
        _FINEST,
        _TOLERANCE,
    )
    return PerssonResult(
        rubber=rubber,
        load=load,
        status=status,
        wavelength=2.0 * np.pi / (nodes if ends is None else ends),
        running_friction=friction,
        friction_error=friction_error,
        running_contact_fraction=area,
        contact_fraction_error=area_error,
        gamma=share,
        rms_gradient=kept.rms_gradient(),
        profile_rms_slope=kept.profile_rms_slope(),
        conditions=conditions,
    )


# Uniaxial strain of all waves over their rms gradient, by the theory.
STRAIN_OF_GRADIENT = 0.5
# Largest wavenumber that counts over that of a cut-off: the Gaussian transmits 1/500 there.
LAST_OVER_CUT_OFF = 3.0


def gaussian_power(q: Array, ends: Array) -> Array:
    """Return the share of the power of waves `q` that cut-offs at `ends` [rad/m] transmit."""
    return transmission(q, 2.0 * np.pi / ends[:, None]) ** 2


def integrals(
    rubber: Rubber,
    effects: Conditions,
    spectrum: ArealSpectrum,
    load: Load,
    gamma: float,
    nodes: Array,
    ends: Array | None,
    intervals: int,
) -> tuple[Array, Array]:
    """Return P and mu with cut-offs at `ends` [rad/m], by the trapezoidal rule in log q.

    Without `ends` they are those of the waves down to each of the nodes [rad/m], in full. `effects`
    soften the rubber.
    """
    from scipy.special import erf

    log_q = divided(np.log(nodes), intervals)
    q = np.exp(log_q)
    real, imaginary, lossy = over_angles(rubber, load, q, intervals)
    weight = q**4 * spectrum.at(q)  # q^3 C dq with dq = q d(log q)
    if ends is not None:
        weight = weight * gaussian_power(q, ends)
    if effects.softening is not None:
        strain = STRAIN_OF_GRADIENT * np.sqrt(2.0 * np.pi * running_integral(weight, log_q))
        ratios = effects.softening.factors(strain, effects.temperature_of(rubber))
        real, imaginary = ratios.storage**2 * real, ratios.loss**2 * imaginary
        lossy = ratios.loss * lossy
    with np.errstate(divide="ignore"):
        area = erf(1.0 / np.sqrt(running_integral(weight * (real + imaginary) / 2.0, log_q)))
    factor = gamma + (1.0 - gamma) * area**2
    friction = running_integral(weight * lossy * factor * area / 2.0, log_q)
    if ends is None:
        return area[::intervals], friction[::intervals]
    return area[:, -1], friction[:, -1]


def over_angles(rubber: Rubber, load: Load, q: Array, intervals: int) -> tuple[Array, Array, Array]:
    """Return int (M'/p_0)^2, int (M''/p_0)^2 and int cos(phi) M''/p_0, dphi over a turn, at `q`.

    Four times a quarter turn: with cos(phi) = sin(psi) and psi = pi/2 s^4 Gauss points in s are
    dense where the frequency q v sin(psi) runs through many decades.
    """
    abscissae, weights = np.polynomial.legendre.leggauss(_ANGLES + intervals)
    s = 0.5 * (1.0 + abscissae)
    real, imaginary, lossy = np.zeros((3, q.size))
    for cosine, width in zip(np.sin(0.5 * np.pi * s**4), 4.0 * np.pi * s**3 * weights, strict=True):
        omega = q * load.speed * cosine
        over = layers.effective_modulus(rubber, omega, q, load.thickness) / load.pressure
        real += width * over.real**2
        imaginary += width * over.imag**2
        lossy += width * cosine * over.imag
    return real, imaginary, lossy


class Persson(Checked, Model):
    """Persson's theory; the profiles are lines on an isotropic surface."""

    name: ClassVar[str] = "persson"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement", "cut_off"})
    takes_conditions: ClassVar[bool] = True

    smallest_wavelength: float | None = checked(checks.positive, unit="m", default=None)
    """Smallest wave that counts [m]; by default the end of the surface's sine waves, see
    `SineStack.cutoff_wavelength`."""
    gamma: float = checked(checks.not_negative, default=0.5)
    """See `persson`."""
    conditions: Conditions | None = None
    """See `persson`."""

    def with_conditions(self, conditions: Conditions | None) -> Persson:
        """Return the theory under other conditions."""
        return replace(self, conditions=conditions)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer as a Dataset; `on_progress` gets the `PerssonResult`.

        Raises `InputError` if the surface was not measured, or not down to the smallest wave.
        """
        result = persson(
            rubber,
            profile_spectrum(followed_profiles(surface, self.name)),
            pressure=load.pressure,
            speed=load.speed,
            smallest_wavelength=self.smallest_wavelength or surface.cutoff_wavelength,
            gamma=self.gamma,
            thickness=load.thickness,
            conditions=self.conditions,
        )
        return answer_of(replace(result, load=load), on_progress)


def answer_of(result: TheoryResult, on_progress: OnProgress) -> xr.Dataset:
    """Call `on_progress` with a result and return its Dataset."""
    if on_progress is not None:
        on_progress(result)
    return result.to_dataset()


def followed_profiles(surface: Surface, name: str) -> list[Profile]:
    """Return the profiles that rubber follows for a theory; `InputError` without any."""
    if surface.measured is None:
        raise InputError(
            f"{name} needs measured profiles; got a surface of sine waves only ({surface.source})"
        )
    return surface.measured.followed
