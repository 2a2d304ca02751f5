"""The chain: the pressure that leaves the contact of one wave is what the next wave receives.

With A_i the contact length of wave i projected on the mean plane (Lind & Wangenheim 2014,
IMECE2014-37998, equation 1):

    p_(i+1)  = p_i lambda_i / A_i

That is a mean. With several pressure classes its distribution is handed down instead, see
`gripscale.chain.prediction`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

from gripscale import model
from gripscale.chain.conditions import mark_unsettled, solve_coupled_chain
from gripscale.chain.prediction import Prediction, PressureClasses, RubberAt, usable
from gripscale.conditions.conditions import Conditions
from gripscale.core import checks, provenance
from gripscale.core.errors import ConvergenceError, ExtrapolationError, InputError
from gripscale.model import MOST_CLASSES, LoadTime, NominalLoad
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import CHOICES, require_measured
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import PreparedSurface, SineStack, SurfacePart
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.kernel import RefinableSolver, WaveSolver, solver_of
from gripscale.wave.problem import Load, Sine, WaveProblem
from gripscale.wave.result import WaveResult

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber


# The solvers of one wave a chain can be asked for by name.

WAVE_SOLVERS: dict[str, Any] = {solver.name: solver for solver in (FiniteStrainBlock, HalfPlane)}
"""By name. A new one is added here."""

WaveSolverLike = WaveSolver | str | Callable[..., WaveResult]


def wave_solver(solver: WaveSolverLike, options: Mapping[str, Any]) -> WaveSolver:
    """Return the solver of a name, a face or itself, with its options.

    Raises `InputError` for an unknown name or option, or options of a solver that has its own.
    """
    if isinstance(solver, str):
        made = WAVE_SOLVERS[checks.one_of("solver", solver, WAVE_SOLVERS)]
        return _checked(made.of(**options))
    face = solver_of(solver)
    if face is not None:
        return _checked(face.of(**options))
    if not isinstance(solver, WaveSolver):
        raise InputError(
            f"solver must be one of {', '.join(WAVE_SOLVERS)} or a WaveSolver such as "
            f"HalfPlane(points=1024); got {checks.short_repr(solver)}"
        )
    if options:
        raise InputError(
            f"{min(options)} belongs to the solver: give it there, as in HalfPlane(points=1024)"
        )
    return solver


def _checked(made: Any) -> WaveSolver:
    assert isinstance(made, WaveSolver)
    return made


class ChainError(ConvergenceError):
    """A wave of the chain did not converge; `partial` holds everything solved up to it.

    The last entry of `partial.scales` is the wave that failed, with its status.
    """

    def __init__(self, message: str, partial: Prediction) -> None:
        super().__init__(message)
        self.partial = partial


def predict(
    rubber: Rubber,
    sines: SineStack,
    *,
    pressure: float,
    speed: float,
    footprint: float,
    solver: WaveSolverLike = "finite_strain",
    smallest_wavelength: float | None = None,
    max_scales: int | None = None,
    pressure_classes: int = 1,
    load_time: LoadTime = "passage",
    on_scale: Callable[[Prediction], None] | None = None,
    start: Prediction | None = None,
    rubber_at: RubberAt | None = None,
    conditions: Conditions | None = None,
    extrapolate: str = "warn",
    **options: Any,
) -> Prediction:
    """Run the chain over the waves of `sines`, largest first.

    Parameters
    ----------
    rubber
        The rubber, handed to the solver.
    sines
        Waves in order of falling wavelength [m], amplitude = half peak-to-valley [m].
    pressure
        Nominal pressure on the largest wave [Pa], above zero.
    speed
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    footprint
        Length of the nominal contact [m]; with `speed` it gives wave 1 its load time.
    solver
        "finite_strain", "half_plane", the function that is its face (`solve_scale`,
        `theory.solve_half_plane`), or any `WaveSolver`.
    smallest_wavelength
        Waves shorter than this are left out [m].
    max_scales
        Number of waves after which to stop.
    pressure_classes
        In how many classes of equal load the pressure in the contact of a wave is handed down to
        the next, which is solved once for each; 1 hands down the mean pressure, 8 its distribution
        to some per cent of the totals.
    load_time
        "passage": wave i is loaded while the contact above it passes,
        t_1 = footprint/speed, t_i = A_(i-1)/speed. A number fixes it for every wave [s],
        infinity lets the mean state relax fully. Always infinite at zero speed.
    on_scale
        Called with the prediction so far after every wave; where the rubber depends on what is
        solved, of every pass, with the status `conditions not settled`, and once at the end.
    start
        A prediction at a neighbouring speed, pressure or rubber: each wave starts from its wave of
        the same number, as far as there is one. The results are the same to the solver's residual,
        found sooner.
    rubber_at
        Gives the rubber of each wave, from the wave and what was solved so far.
    conditions
        Temperature, softening, heat and area term; the chain is solved until they agree with it.
        Not together with `rubber_at`.
    extrapolate
        "warn": waves that excite the rubber beyond its `valid_band` are solved, and the result says
        so. "refuse": nothing is solved if one does, at its fundamental frequency.
    **options
        Of a solver given by name: columns, rows, depth, tolerance ...

    Returns
    -------
    Prediction
        One `WaveResult` per wave, with running area and friction.

    Raises
    ------
    ExtrapolationError
        An `InputError`: extrapolation is to be refused.
    InputError
        A value that cannot be used; the pressure is more than ten times what is left of the
        rubber's modulus after the load time of the first wave.
    ChainError
        A wave did not converge; a `ConvergenceError` whose `partial` is the prediction so far.
    """
    checks.instance("sines", sines, SineStack)
    load = NominalLoad(pressure, speed, footprint, load_time)
    one = wave_solver(solver, options)
    waves = select_waves(sines, smallest_wavelength=smallest_wavelength, max_scales=max_scales)
    count = checks.whole("pressure_classes", pressure_classes, least=1, most=MOST_CLASSES)
    if conditions is not None and rubber_at is not None:
        raise InputError("rubber_at must be None with conditions, which give the rubber; got both")
    before = rubber if conditions is None else conditions.before(rubber)
    require_load_bearing(before, load.pressure, load.time_under(load.footprint))
    if checks.one_of("extrapolate", extrapolate, CHOICES) == "refuse":
        require_measured(before, [wave.wavelength for wave in waves], load.speed)
    nothing = Prediction(rubber, sines, load, [], len(waves), conditions)
    walk = ChainSolve(nothing, waves, one, count, on_scale)
    if conditions is None:
        return walk(rubber_at, start)
    if not conditions.iterated:
        return walk(lambda wave, so_far: before, start)
    if on_scale is None:
        return solve_coupled_chain(walk, rubber, conditions)
    passing = replace(walk, on_scale=lambda so_far: on_scale(mark_unsettled(so_far)))
    settled = solve_coupled_chain(passing, rubber, conditions)
    on_scale(settled)
    return settled


def select_waves(
    sines: SineStack,
    *,
    smallest_wavelength: float | None = None,
    max_scales: int | None = None,
) -> list[Sine]:
    """Return the waves the chain visits.

    Raises `InputError` if the limits leave none.
    """
    pairs = zip(sines.wavelength, sines.amplitude, strict=True)
    waves = [Sine(float(wavelength), float(amplitude)) for wavelength, amplitude in pairs]
    if smallest_wavelength is not None:
        least = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
        largest = waves[0].wavelength
        waves = [wave for wave in waves if wave.wavelength >= least]
        if not waves:
            raise InputError(
                f"smallest_wavelength must not exceed the largest wave, {largest:g} m; "
                f"got {least:g} m"
            )
    if max_scales is not None:
        waves = waves[: checks.whole("max_scales", max_scales, least=1, most=1000)]
    return waves


@dataclass(frozen=True)
class ChainSolve:
    """All waves solved one after the other, added to `nothing`."""

    nothing: Prediction
    waves: Sequence[Sine]
    solver: WaveSolver
    count: int
    """Of classes in which a wave hands its pressure down."""
    on_scale: Callable[[Prediction], None] | None

    def __call__(self, rubber_at: RubberAt | None, start: Prediction | None) -> Prediction:
        """Return the prediction with the rubber of each wave, each from its wave of `start`."""
        result, load = self.nothing, self.nothing.load
        classes, length = PressureClasses.uniform(load.pressure), load.footprint
        for number, wave in enumerate(self.waves):
            first = start.scales[number] if start and number < len(start.scales) else None
            own = result.rubber if rubber_at is None else rubber_at(wave, result)
            time = load.time_under(length)
            asked = [Load(float(pressure), load.speed, time) for pressure in classes.pressure]
            solved = [self.solver.solve(WaveProblem(own, wave, one), first) for one in asked]
            scale = classes.together(solved)
            result = replace(result, scales=[*result.scales, scale])
            if self.on_scale is not None:
                self.on_scale(result)
            _require_contact(result)
            length = scale.contact_length
            classes = classes.handed_down(solved, self.count)
        return result

    def coarser(self) -> ChainSolve | None:
        """Return the same in a fraction of the time, if the solver knows how."""
        if not isinstance(self.solver, RefinableSolver):
            return None
        return replace(self, solver=self.solver.coarser(), on_scale=None)

    @property
    def warm(self) -> bool:
        """Whether a wave can be started from its last solution."""
        return isinstance(self.solver, RefinableSolver)


def _require_contact(so_far: Prediction) -> None:
    """Raise `ChainError` unless the last wave may hand its pressure on."""
    scale = so_far.scales[-1]
    if not scale.converged:
        raise ChainError(so_far.failure(), so_far)
    if not usable(scale):
        raise ChainError(
            f"{so_far.place()} has a contact fraction of {scale.contact_fraction:g}; "
            "expected more than 0 and at most 1",
            so_far,
        )


# The chain as one of the models that can be compared, varied, drawn and reported.


@dataclass(frozen=True)
class Chain(model.Model):
    """Waves solved one after the other, each with the pressure that leaves the one above.

    Parameters
    ----------
    solver : WaveSolver
        What solves one wave.
    rubber_at : RubberAt, optional
        Conditions that change the rubber on the way; a frozen dataclass, so that it can be kept.
    pressure_classes : int
        In how many classes of equal load a wave hands its pressure down, see `predict`.
    extrapolate : str
        "warn" or "refuse", see `predict`.
    conditions : Conditions, optional
        Temperature, softening, heat and area term, see `predict`.

    Raises
    ------
    InputError
        If `pressure_classes` is no whole number from 1 to 64, or `extrapolate` another word.
    """

    name: ClassVar[str] = "chain"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"waves"})
    takes_conditions: ClassVar[bool] = True

    solver: WaveSolver = field(default_factory=FiniteStrainBlock)
    rubber_at: RubberAt | None = None
    pressure_classes: int = 1
    extrapolate: str = "warn"
    conditions: Conditions | None = None

    def __post_init__(self) -> None:
        checks.one_of("extrapolate", self.extrapolate, CHOICES)
        checks.whole("pressure_classes", self.pressure_classes, least=1, most=MOST_CLASSES)

    def with_conditions(self, conditions: Conditions | None) -> Chain:
        """Return the chain under other conditions."""
        return replace(self, conditions=conditions)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the prediction as a Dataset; `on_progress` gets the `Prediction` so far.

        A wave that does not converge ends the chain and is its last, refused extrapolation ends it
        before the first; `prediction_status` says why.
        """
        try:
            result = predict(
                rubber,
                surface.sines,
                pressure=load.pressure,
                speed=load.speed,
                footprint=load.footprint,
                pressure_classes=self.pressure_classes,
                load_time=load.load_time,
                solver=self.solver,
                rubber_at=self.rubber_at,
                extrapolate=self.extrapolate,
                conditions=self.conditions,
                on_scale=on_progress,
            )
        except ChainError as failure:
            return failure.partial.to_dataset().assign(prediction_status=str(failure))
        except ExtrapolationError as refusal:
            return _refused(str(refusal), load)
        return result.to_dataset()


def _refused(why: str, load: NominalLoad) -> xr.Dataset:
    """Return the answer of a chain that was not begun."""
    import xarray as xr

    nothing = xr.Dataset(attrs=provenance.attributes())
    return model.answer(nothing, dict.fromkeys(model.TOTALS, math.nan), why, Chain.name, load)
