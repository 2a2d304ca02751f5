"""Persson's diffusion from the pressures of a direct contact: roughness of any depth below it.

The contact is solved with the waves down to q_0. Its pressures p, in equal shares of the contact,
spread by the waves beyond, of the areal spectrum C, and leave the contact at zero pressure:

    dV/d(ln q)  = 1/4 W(P) R(q)      R = q^4 C int_0^2pi dphi |M(q v cos phi)|^2 / p_0^2
    P(q)        = P(q_0) < erf(p / (p_0 sqrt(2 V))) >
    dmu/d(ln q) = 1/2 S(P) P L(q)    L = q^4 C int_0^2pi dphi cos phi Im M(q v cos phi) / p_0

with V(q_0) = 0 and mu(q_0) that of the direct contact; V is the variance of the pressures over
p_0^2. With W = 1, a uniform pressure p_0 and P = 1 this is `gripscale.theory.persson`. In partial
contact the rubber does not follow the waves, so their pressures and their losses are smaller than
in full contact, by

    W = w + (1 - w) P^2        w = 0.54 + 0.255 sin(delta)
    S = s + (1 - s) P^(3/2)    s = 0.72 - 0.25 (1 - H) - 0.12 sin(delta)
                                   + 0.44 d(ln sin(delta))/d(ln q)

with sin(delta) = L R^(-1/2) sqrt(2 pi)/4 (q^4 C)^(-1/2), the mean of all directions. The form is
that of the elastic energy in M. Scaraggi & B. N. J. Persson, J. Phys.: Condens. Matter 27 (2015)
105102, doi:10.1088/0953-8984/27/10/105102, who find about 1/2. The constants are fitted to direct
contacts of Gaussian maps, and checked on others: see docs/theories.md. Why they have these signs:

- lossy rubber lifts off behind asperities and presses harder before them (w rises with delta);
- a wave loses a part of its contact to the next shorter ones, which P(q) does not count, the more
  the faster the slopes grow (s falls with 1 - H);
- the pressure of a wave in partial contact has harmonics shorter than the wave. They lose more if
  the loss angle grows with frequency (the last term).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError
from gripscale.model import Load
from gripscale.rubber import Rubber
from gripscale.surface.cut_off import PowerLaw
from gripscale.theory.persson import (
    COARSEST,
    FINEST,
    TOLERANCE,
    PerssonResult,
    divided,
    over_angles,
    refined,
    running_integral,
)

CLASSES = 256
"""Pressures, each of an equal share of the contact, that stand for all of them."""

STRESS_SHARE, STRESS_BY_LOSS = 0.54, 0.255
"""Constants of w."""

SHARE, BY_ROUGHNESS, BY_LOSS, BY_GROWTH = 0.72, 0.25, 0.12, 0.44
"""Constants of s, in the order of the formula above."""


class ContactPressures(Checked, eq=False):
    """What the diffusion starts from: the pressures of a contact, its area and friction.

    Raises `InputError` if a value is out of range.
    """

    pressure: Array = checked(checks.positive_vector, unit="Pa")
    """Pressures in the contact [Pa], above zero, each of an equal share of it."""
    contact_fraction: float = checked(checks.positive)
    """Real over nominal contact area [-]."""
    friction: float = checked(checks.number)
    """Friction coefficient [-]."""
    wavelength: float = checked(checks.positive, unit="m")
    """Shortest wave of the roughness that was solved [m]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.at_most_one("contact_fraction", self.contact_fraction)

    def classes(self, pressure: float) -> Array:
        """Return the mean pressures [Pa] of equal parts of the contact, rising.

        They carry a nominal pressure [Pa]. On a coarse grid those of the points do not: more points
        are in contact than belong to the area.
        """
        carried = self.contact_fraction * float(self.pressure.mean())
        rising = np.sort(self.pressure) * (pressure / carried)
        ends = np.linspace(0.0, rising.size, min(CLASSES, rising.size) + 1)
        sums = np.interp(ends, np.arange(rising.size + 1.0), np.append(0.0, np.cumsum(rising)))
        return np.asarray(np.diff(sums) / np.diff(ends))


@dataclass(frozen=True)
class DiffusionResult(PerssonResult):
    """Contact and friction below a direct contact, down to each wavelength.

    `wavelength` falls by octaves from the start to the smallest. The gradients are those of the
    waves between both; `gamma` is s of the last wave.
    """

    name: ClassVar[str] = "diffusion"
    title: ClassVar[str] = "Real contact area and friction below a direct contact"


def diffusion(
    rubber: Rubber,
    start: ContactPressures,
    law: PowerLaw,
    *,
    pressure: float,
    speed: float,
    smallest_wavelength: float,
    corrected: bool = True,
) -> DiffusionResult:
    """Return contact and friction of the roughness below a contact, by Persson's diffusion.

    A `status` other than "converged" says that the integrals are not accurate. Raises `InputError`
    if an argument is out of its range.

    Parameters
    ----------
    rubber : Rubber
        The sliding half-space, at small strain.
    start : ContactPressures
        The contact with all longer waves.
    law : PowerLaw
        Mean square gradient of the surface below the shortest wave of `start`.
    pressure, speed : float
        Nominal pressure [Pa], above zero, and sliding speed [m/s].
    smallest_wavelength : float
        Smallest wave that counts [m], below that of `start`.
    corrected : bool
        Whether W and S are those above. If not, W = 1 and S = 1/2 + P^2/2, as in `persson`.
    """
    checks.instance("rubber", rubber, Rubber)
    checks.instance("start", start, ContactPressures)
    checks.instance("law", law, PowerLaw)
    last = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    if last >= start.wavelength:
        raise InputError(
            f"smallest_wavelength must be below {start.wavelength:.4g} m, the shortest wave of the "
            f"start; got {last:.4g}"
        )
    octaves = math.log2(start.wavelength / last)
    wavelength = start.wavelength * 2.0 ** -np.append(np.arange(math.ceil(octaves - 1e-9)), octaves)
    load = Load(pressure, speed, start.wavelength)
    integrals = _Integrals(
        rubber, start, law, load, 2.0 * np.pi / wavelength, checks.flag("corrected", corrected)
    )
    (area, friction, share), (area_error, friction_error, _) = refined(
        integrals.at_nodes, COARSEST, FINEST, TOLERANCE
    )
    gradient = math.sqrt(law.added(start.wavelength / last))
    return DiffusionResult(
        rubber=rubber,
        load=load,
        gamma=float(share[-1]),
        wavelength=wavelength,
        running_contact_fraction=area,
        running_friction=friction,
        rms_gradient=gradient,
        profile_rms_slope=gradient / math.sqrt(2.0),
        contact_fraction_error=area_error,
        friction_error=friction_error,
    )


@dataclass(frozen=True)
class _Integrals:
    """The integrals over the wavenumbers of `nodes` [rad/m]."""

    rubber: Rubber
    start: ContactPressures
    law: PowerLaw
    load: Load
    nodes: Array
    corrected: bool

    def at_nodes(self, intervals: int) -> tuple[Array, Array, Array]:
        """Return P, mu and s at the nodes: Heun's rule for V, the trapezoidal rule for mu."""
        log_q = divided(np.log(self.nodes), intervals)
        # a narrow distribution of pressures spreads within a small part of the first octave
        first = log_q[: intervals + 1]
        first[:] = first[0] + (first[-1] - first[0]) * np.linspace(0.0, 1.0, intervals + 1) ** 3
        q = np.exp(log_q)
        stiff, lossy = over_angles(self.rubber, self.load, q, intervals)
        sine = lossy / (4.0 * np.sqrt(stiff / (2.0 * np.pi)))
        stress_share, share, power = np.ones(q.size), np.full(q.size, 0.5), 2.0
        if self.corrected:
            by_octave = np.gradient(sine, log_q, edge_order=2)
            growth = np.divide(by_octave, sine, out=np.zeros(q.size), where=sine > 0.0)
            stress_share = STRESS_SHARE + STRESS_BY_LOSS * sine
            share = SHARE - BY_ROUGHNESS * (1.0 - self.law.hurst) - BY_LOSS * sine
            share, power = np.clip(share + BY_GROWTH * growth, 0.0, 1.0), 1.5
        # d<|grad z|^2> = 2 pi q^4 C d(ln q)
        weight = self.law.growth / (2.0 * np.pi) * (q / q[0]) ** (2.0 - 2.0 * self.law.hurst)
        area = self.area(log_q, weight * stiff / 4.0, stress_share)
        added = weight * lossy / 2.0 * (share + (1.0 - share) * area**power) * area
        friction = self.start.friction + running_integral(added, log_q)
        return area[::intervals], friction[::intervals], share[::intervals]

    def area(self, log_q: Array, rate: Array, share: Array) -> Array:
        """Return P at each of `log_q` from the growth of V in full contact and w."""
        from scipy.special import erf

        load = self.load.pressure
        classes = self.start.classes(load) / (math.sqrt(2.0) * load)

        def fraction(variance: float) -> float:
            if variance == 0.0:
                return self.start.contact_fraction
            return self.start.contact_fraction * float(erf(classes / math.sqrt(variance)).mean())

        def slope(at: int, area: float) -> float:
            return float(rate[at] * (share[at] + (1.0 - share[at]) * area**2))

        variance = 0.0
        area = [self.start.contact_fraction]
        for at, step in enumerate(np.diff(log_q)):
            first = slope(at, area[-1])
            second = slope(at + 1, fraction(variance + step * first))
            variance += 0.5 * step * (first + second)
            area.append(fraction(variance))
        return np.array(area)
