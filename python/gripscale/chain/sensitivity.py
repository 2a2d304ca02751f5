"""What decides the friction of one wave, or of a chain of them: its derivatives, from differences.

An input x is changed up and down by a step s, and the waves are solved again, each on its mesh and
from its own solution:

    d ln mu / d ln x = (ln mu(x e^s) - ln mu(x e^-s)) / 2 s,

and so for the contact fraction. Of a band of frequency E' or E'' is changed in the harmonics that
excite the rubber there (`gripscale.rubber.banded`). The chain hands down pressures and load times,
so that its derivatives hold what the waves do to one another. A wave that a change does not reach
is kept.

The step is a compromise. Friction and contact fraction of a mesh scatter about smooth functions of
the inputs, because nodes come into contact one by one; and a wave near full contact closes within a
few per cent of pressure. See `docs/sensitivity.md` for what steps and meshes give.
"""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from gripscale.chain.prediction import CLASS_PRESSURES, ChainResult, ChainSolve
from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError, RubberWarning
from gripscale.core.labels import labelled
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sensitivity import (
    Bands,
    derivative_variables,
    derivatives_dataset,
)
from gripscale.half_space.sensitivity import contact_sensitivity as contact_sensitivity
from gripscale.model import Load
from gripscale.rubber import Rubber
from gripscale.rubber.banded import Band, BandedRubber
from gripscale.surface import SineStack
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.problem import Mesh, Sine, WaveLoad, WaveProblem
from gripscale.wave.result import ScaleResult

STEP = 0.05
"""Change of the logarithm of an input."""
_KELVIN_STEP = 2.0
"""Change of the temperature [K]."""
SETTINGS = {"residual_tolerance": 1e-6, "most_mismatch": 1e6, "fewest_contact_nodes": 1}
"""Of the waves solved again: no finer mesh, and five digits are enough."""
_SOURCE = "differences of solved waves"
Change = Callable[[float], tuple[Sequence[Rubber], Load]]
"""The rubbers of all waves and the load, with an input changed by so much."""


@dataclass(frozen=True)
class NeighbourSolver:
    """Solves each wave near one that is solved, on the same mesh and from its solution."""

    solved: Sequence[ScaleResult]
    name: str = "neighbour"

    def solve(self, problem: WaveProblem, start: ScaleResult | None = None) -> ScaleResult:
        """Return the solved wave itself for its own problem, else a new solution."""
        profile, load = problem.profile, problem.load
        wave = next(each for each in self.solved if each.wavelength == profile.wavelength)
        same = WaveLoad(wave.pressure_received, wave.speed, wave.load_time) == load
        if same and problem.rubber is wave.rubber:
            return wave
        details = wave.details
        if wave.model == HalfPlane.name:
            return HalfPlane(int(details["points"]), details.get("poisson_ratio")).solve(problem)
        columns, rows, order = (int(details[key]) for key in ("columns", "rows", "element_order"))
        block = FiniteStrainBlock(Mesh(columns, rows, details["depth"], order), settings=SETTINGS)
        return block.solve(problem, wave if wave.solution is not None else None)


@dataclass(frozen=True)
class WaveDifferences:
    """Derivatives of ln mu and ln A_r/A_0 of solved waves."""

    solved: ChainResult

    @cached_property
    def rubbers(self) -> list[Rubber]:
        """Of each wave."""
        return [wave.rubber or self.solved.rubber for wave in self.solved.scales]

    def by(self, change: Change, step: float) -> Array:
        """Return the derivatives of both along a change of the inputs."""
        low, high = (self._logs(*change(by)) for by in (-step, step))
        return np.asarray((high - low) / (2.0 * step))

    def _logs(self, rubbers: Sequence[Rubber], load: Load) -> Array:
        scales = self.solved.scales
        chain = ChainSolve(
            replace(self.solved, scales=[], load=load),
            [Sine(wave.wavelength, wave.amplitude) for wave in scales],
            NeighbourSolver(scales),
            max(np.size(wave.details.get(CLASS_PRESSURES, 1.0)) for wave in scales),
            None,
        )
        near = chain(lambda wave, so_far: rubbers[len(so_far.scales)], None)
        return np.array([math.log(near.friction), math.log(near.contact_fraction)])

    def by_bands(self, part: str, bands: Bands, shifts: Sequence[float]) -> Array:
        """Return the derivatives by E' or E'' of each band, shape (bands, 2).

        A wave excites the band at its frequencies times its entry of `shifts` [-].
        """
        ends = [0.0, *bands.edge[1:-1], math.inf]
        omega = [a * _harmonics(w) for a, w in zip(shifts, self.solved.scales, strict=True)]

        def change_of(low: float, high: float) -> Change:
            def change(by: float) -> tuple[Sequence[Rubber], Load]:
                factors = (math.exp(by), 1.0) if part == "ln_storage" else (1.0, math.exp(by))
                rubbers = [
                    BandedRubber.of(rubber, Band(low / a, high / a, *factors))
                    if ((each >= low) & (each < high)).any()
                    else rubber
                    for rubber, a, each in zip(self.rubbers, shifts, omega, strict=True)
                ]
                return rubbers, self.solved.load

            return change

        return np.array([self.by(change_of(*pair), STEP) for pair in itertools.pairwise(ends)])

    def by_terms(self) -> Array:
        """Return the derivatives by each Prony modulus, the relaxed one first, shape (terms, 2)."""

        def change_of(term: int) -> Change:
            def change(by: float) -> tuple[Sequence[Rubber], Load]:
                return [_with_term(r, term, math.exp(by)) for r in self.rubbers], self.solved.load

            return change

        count = self.solved.rubber.moduli.size + 1
        return np.array([self.by(change_of(term), STEP) for term in range(count)])

    def by_numbers(self) -> dict[str, Array]:
        """Return the derivatives by inputs that are one number each, by the end of their name."""
        load, rubbers = self.solved.load, self.rubbers

        def bulk(by: float) -> tuple[Sequence[Rubber], Load]:
            factor = math.exp(by)
            return [replace(r, bulk_modulus=r.bulk_modulus * factor) for r in rubbers], load

        def warmer(by: float) -> tuple[Sequence[Rubber], Load]:
            return [r.at((r.reference_temperature or math.nan) + by) for r in rubbers], load

        derivatives = {
            "ln_speed": self.by(
                lambda by: (rubbers, replace(load, speed=load.speed * math.exp(by))), STEP
            ),
            "ln_pressure": self.by(
                lambda by: (rubbers, replace(load, pressure=load.pressure * math.exp(by))), STEP
            ),
            "ln_bulk_modulus": self.by(bulk, STEP),
            "temperature": np.full(2, math.nan),
        }
        if self.solved.rubber.shift is not None:
            derivatives["temperature"] = self.by(warmer, _KELVIN_STEP)
        return derivatives


def _with_term(rubber: Rubber, term: int, factor: float) -> Rubber:
    """Return a rubber with a factor of one Prony modulus; term 0 is the equilibrium modulus."""
    factors = np.ones(rubber.moduli.size + 1)
    factors[term] = factor
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # the rubber itself has warned
        return replace(
            rubber,
            equilibrium_modulus=rubber.equilibrium_modulus * factors[0],
            moduli=rubber.moduli * factors[1:],
            admissible=None,
        )


def _harmonics(wave: ScaleResult) -> Array:
    """Return the angular frequencies at which a wave excites the rubber [rad/s], zero first."""
    count = int(wave.details.get("columns", wave.details.get("points", 0)))
    return np.asarray(wave.angular_frequency * np.arange(count // 2 + 1))


def wave_sensitivity(
    result: ChainResult,
    *,
    bands_per_decade: int,
    reference_temperature: float | None,
    terms: bool = False,
) -> xr.Dataset:
    """Return the derivatives of a prediction of the chain; see `sensitivity`.

    By Prony terms only if asked for: they are as many solutions as all bands.
    """
    per_decade = checks.whole("bands_per_decade", bands_per_decade, least=1, most=100)
    _require_solvable(result)
    rubber = result.rubber if result.conditions is None else result.conditions.before(result.rubber)
    if reference_temperature is not None:
        rubber = rubber.at(reference_temperature)
    differences = WaveDifferences(result)
    shifts = [_shift(rubber, each) for each in differences.rubbers]
    omega = [a * _harmonics(wave) for a, wave in zip(shifts, result.scales, strict=True)]
    bands = Bands.over(np.concatenate(omega), per_decade)
    both = differences.by_numbers()
    for part in ("ln_storage", "ln_loss"):
        both[part] = differences.by_bands(part, bands, shifts)
    coordinates = {}
    softened = result.conditions is not None and result.conditions.softening is not None
    if terms and not softened:  # which gives each wave a series of its own
        both["ln_modulus"] = differences.by_terms()
        times = [math.inf, *result.rubber.relaxation_times]
        coordinates["relaxation_time"] = labelled("term", times, "s", "of the Prony term", "input")
    both["ln_cut_off"] = np.array(
        [result.cut_off_exponents.friction, result.cut_off_exponents.contact_fraction]
    )
    data = {
        "friction": labelled((), result.friction, "1", "friction coefficient", _SOURCE),
        "contact_fraction": labelled(
            (), result.contact_fraction, "1", "real over nominal contact area", _SOURCE
        ),
    }
    for at, quantity in enumerate(("friction", "contact_fraction")):
        of_one = {name: value[..., at] for name, value in both.items()}
        data |= derivative_variables(quantity, of_one, _SOURCE)
    return derivatives_dataset(
        data,
        bands,
        title="Derivatives of the friction of sine waves",
        status=str(result.status),
        bands_per_decade=per_decade,
        settled=int(result.conditions is not None and result.conditions.iterated),
        rubber=f"{result.rubber.name}; {result.rubber.source}".strip("; "),
        nominal_pressure=result.load.pressure,
        speed=result.load.speed,
    ).assign_coords(coordinates)


def _require_solvable(result: ChainResult) -> None:
    """Raise `InputError` unless the waves slide, are solved, and can be solved again."""
    solvers = (FiniteStrainBlock.name, HalfPlane.name)
    other = [wave.model for wave in result.scales if wave.model not in solvers]
    if other or any("smallest_wavelength" in wave.details for wave in result.scales):
        raise InputError(
            f"result must be of sine waves of {' or '.join(solvers)} for derivatives; got "
            + (other[0] if other else "one period of a profile")
        )
    if result.load.speed == 0.0 or not (result.converged and result.friction > 0.0):
        raise InputError(
            "result must slide with friction above zero for the derivatives of its logarithm; got "
            f"speed {result.load.speed:g} m/s, friction {result.friction:.3g}, {result.status}"
        )


def _shift(rubber: Rubber, other: Rubber) -> float:
    """Return a_T from the temperature of `other` to that of `rubber` [-]; 1 without a shift."""
    kelvin, warm = rubber.reference_temperature, other.reference_temperature
    if rubber.shift is None or kelvin is None or warm is None:
        return 1.0
    return float(rubber.shift.a(warm, kelvin))


def sensitivity(
    result: RoughContact | ScaleResult | ChainResult,
    *,
    bands_per_decade: int = 2,
    contact_fraction: bool = False,
    reference_temperature: float | None = None,
) -> xr.Dataset:
    """Return the derivatives of the friction of a prediction by all of its inputs.

    Of a direct contact from one adjoint solution, see `gripscale.half_space.sensitivity`. Of one
    wave or of a chain from differences of waves solved again, two for each band and modulus, each
    Prony term and each number. Under conditions the rubber of each scale or wave keeps its strain
    and its temperature rise: the effect of an input on them is left out (`settled` in the
    attributes).

    Parameters
    ----------
    result : RoughContact, ScaleResult or ChainResult
        In motion, with friction above zero. Waves of another solver than "finite_strain" and
        "half_plane", and a period of a profile, are refused.
    bands_per_decade : int
        Bands of frequency in a decade.
    contact_fraction : bool
        Of a direct contact also the derivatives of the contact fraction, from four further contacts
        a band. Waves have them without further cost.
    reference_temperature : float, optional
        Temperature that the frequencies are shifted to [K], such as that of a master curve; the
        rubber's before the contact by default.

    Returns
    -------
    xarray.Dataset
        Over `frequency` [rad/s], the centre of a band: `d_ln_friction_d_ln_storage` and
        `d_ln_friction_d_ln_loss` [-], of E' and E'' in the band; the bands add up, the lowest holds
        the relaxed modulus. Scalars: `d_ln_friction_d_ln_speed`, `..._ln_pressure`,
        `..._ln_bulk_modulus`, `..._ln_cut_off` (NaN for one wave) and `d_ln_friction_d_temperature`
        [1/K], NaN without a shift. The same names with `contact_fraction`. Over `term`, but for
        waves that softening gives series of their own: `d_ln_friction_d_ln_modulus`, of the Prony
        moduli, the equilibrium modulus first. Of a direct contact also `d_friction_d_height` over
        `x` (and `y`).

    Raises
    ------
    InputError
        If the result is at rest, has no friction, or is something else; if the rubber has no shift
        to the reference temperature.
    ChainError
        If a wave with a changed input does not converge.
    """
    if isinstance(result, RoughContact):
        return contact_sensitivity(
            result,
            bands_per_decade=bands_per_decade,
            contact_fraction=contact_fraction,
            reference_temperature=reference_temperature,
        )
    if isinstance(result, ScaleResult):
        result = _chain_of(result)
    if not isinstance(result, ChainResult):
        raise InputError(
            "result must be a RoughContact, ScaleResult or ChainResult; got "
            f"{checks.short_repr(result)}"
        )
    return wave_sensitivity(
        result,
        bands_per_decade=bands_per_decade,
        reference_temperature=reference_temperature,
        terms=True,
    )


def _chain_of(wave: ScaleResult) -> ChainResult:
    """Return the chain of one wave."""
    if wave.rubber is None:
        raise InputError("result must know its rubber for derivatives; got a wave without one")
    sines = SineStack(np.array([wave.wavelength]), np.array([wave.amplitude]))
    load = Load(wave.pressure_received, wave.speed, wave.wavelength, wave.load_time)
    return ChainResult(wave.rubber, sines, load, [wave], 1)
