"""The chain: the pressure in the contact of one wave is the mean pressure on the next.

With A_i the contact length of wave i on the mean plane, p_(i+1) = p_i lambda_i / A_i (Lind &
Wangenheim 2014, IMECE2014-37998, equation 1); of its distribution, `gripscale.chain.prediction`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import field, replace
from typing import Any, ClassVar

import xarray as xr

from gripscale import model
from gripscale.chain.conditions import solve_coupled_chain
from gripscale.chain.prediction import ChainError, ChainResult, ChainSolve, RubberAt
from gripscale.conditions.conditions import Conditions
from gripscale.core import Checked, Quantity, checked, checks, provenance
from gripscale.core.errors import ExtrapolationError, InputError
from gripscale.model import MOST_CLASSES, Load, LoadTime, OnProgress
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import CHOICES, require_measured
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import SineStack, Surface, SurfacePart
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.kernel import WaveSolver
from gripscale.wave.problem import Sine

WAVE_SOLVERS: dict[str, Any] = {solver.name: solver for solver in (FiniteStrainBlock, HalfPlane)}
"""Solvers of one wave by name. A new one is added here."""

WaveSolverLike = WaveSolver | str


def wave_solver(solver: WaveSolverLike, options: Mapping[str, Any]) -> WaveSolver:
    """Return a solver by its name with options, or the solver itself."""
    if isinstance(solver, str):
        kind = WAVE_SOLVERS[checks.one_of("solver", solver, WAVE_SOLVERS)]
        out: WaveSolver = kind.of(**options)
        return out
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


def solve_chain(
    rubber: Rubber,
    sines: SineStack,
    *,
    pressure: Quantity,
    speed: Quantity,
    footprint: Quantity,
    solver: WaveSolverLike = "finite_strain",
    smallest_wavelength: Quantity | None = None,
    pressure_classes: int = 1,
    load_time: LoadTime = "passage",
    thickness: Quantity | None = None,
    on_scale: Callable[[ChainResult], None] | None = None,
    start: ChainResult | None = None,
    rubber_at: RubberAt | None = None,
    conditions: Conditions | None = None,
    extrapolate: str = "warn",
    **options: Any,
) -> ChainResult:
    """Predict contact and friction by the chain over the waves of `sines`, largest first.

    Raises `ExtrapolationError` if the rubber would be extrapolated and `extrapolate` is "refuse",
    `InputError` if a value cannot be used or the pressure is more than ten times the relaxed
    modulus after the load time of the first wave, and `ChainError` if a wave does not converge: its
    `partial` is the prediction so far.

        >>> chain = gs.solve_chain(rubber, sines, pressure="3 bar", speed=1.0, footprint="0.1 m")
        >>> f"{chain.friction:.2f}"
        '0.10'

    Parameters
    ----------
    rubber
        The viscoelastic solid.
    sines
        Waves in order of falling wavelength [m], amplitude = half peak-to-valley [m].
    pressure
        Nominal pressure on the largest wave [Pa], above zero.
    speed
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    footprint
        Length of the nominal contact [m]; over `speed` the load time of wave 1.
    thickness
        Thickness of the rubber on a rigid base [m], which no block exceeds; None: no limit.
    solver
        "finite_strain", "half_plane", or any `WaveSolver`.
    smallest_wavelength
        Waves shorter than this are left out [m].
    pressure_classes
        Number of classes of equal load into which the pressure in the contact of a wave is divided;
        the next wave is solved once for each class. 1 uses the mean pressure; 8 resolve its
        distribution to a few per cent of the totals.
    load_time
        "passage": wave i is loaded while the contact above it passes,
        t_1 = footprint/speed, t_i = A_(i-1)/speed. A number fixes it for every wave [s],
        infinity lets the mean state relax fully. Always infinite at zero speed.
    on_scale
        Called with the prediction so far after every wave; with iterated conditions in every
        iteration.
    start
        A prediction at a neighbouring speed, pressure or rubber: each wave starts from its wave of
        the same number, if there is one. The results agree to the residual of the solver, in less
        time.
    rubber_at
        Returns the rubber of each wave, from the wave and the prediction so far.
    conditions
        Temperature, softening, heat and area term. Softening and heat are iterated with the chain.
        Not together with `rubber_at`.
    extrapolate
        "warn": waves that excite the rubber beyond its `valid_band` are solved, and the result
        warns of them. "refuse": raise an error if a wave does, at its fundamental frequency.
    **options
        Of a solver given by name: columns, rows, depth, tolerance ...
    """
    one_wave = wave_solver(solver, options)
    chain = Chain(one_wave, rubber_at, pressure_classes, extrapolate, conditions)
    load = Load(pressure, speed, footprint, load_time, thickness)
    return chain.solve(
        rubber, sines, load, smallest_wavelength=smallest_wavelength, on_scale=on_scale, start=start
    )


class Chain(Checked, model.Model):
    """Model of sine waves: each wave receives the pressure that leaves the contact of the larger.

    Its fields are arguments of `solve_chain`; a frozen dataclass as `rubber_at` lets stored results
    be named by it. Raises `InputError` if `pressure_classes` is no whole number from 1 to 64, or
    `extrapolate` another word.
    """

    name: ClassVar[str] = "chain"
    method: ClassVar[tuple[str, ...]] = (
        "The measured surface is approximated by superposed sine waves. On each wave, largest "
        "first, a rubber block at finite strain is pressed and slid. The next wave receives the "
        "pressure in its contact.",
        *("correlation", "sines", "prony", "network", "steady"),
        *("contact", "pressure", "area", "friction"),
    )
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"waves"})
    takes_conditions: ClassVar[bool] = True

    solver: WaveSolver = field(default_factory=FiniteStrainBlock)
    rubber_at: RubberAt | None = None
    pressure_classes: int = checked(checks.whole, least=1, most=MOST_CLASSES, default=1)
    extrapolate: str = checked(checks.one_of, choices=CHOICES, default="warn")
    conditions: Conditions | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.conditions is not None and self.rubber_at is not None:
            raise InputError(
                "rubber_at must be None with conditions, which give the rubber; got both"
            )
        water = None if self.conditions is None else self.conditions.water
        if water is not None:
            raise InputError(
                f"water of the chain must be left out: waves have no pools; got {water:g} m. The "
                "direct contact of a map has them"
            )

    def with_conditions(self, conditions: Conditions | None) -> Chain:
        """Return the chain under other conditions."""
        return replace(self, conditions=conditions)

    def solve(
        self,
        rubber: Rubber,
        sines: SineStack,
        load: Load,
        *,
        smallest_wavelength: float | None = None,
        on_scale: Callable[[ChainResult], None] | None = None,
        start: ChainResult | None = None,
    ) -> ChainResult:
        """Return the prediction; arguments and errors as for `solve_chain`."""
        checks.instance("sines", sines, SineStack)
        waves = list(map(Sine, sines.wavelength.tolist(), sines.amplitude.tolist()))
        if smallest_wavelength is not None:
            least = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
            largest = waves[0].wavelength
            waves = [wave for wave in waves if wave.wavelength >= least]
            if not waves:
                raise InputError(
                    f"smallest_wavelength must not exceed the largest wave, {largest:g} m; "
                    f"got {least:g} m"
                )
        conditions = self.conditions
        before = rubber if conditions is None else conditions.before(rubber)
        require_load_bearing(before, load.pressure, load.time_under(load.footprint))
        if self.extrapolate == "refuse":
            require_measured(before, [wave.wavelength for wave in waves], load.speed)
        empty = ChainResult(rubber, sines, load, [], len(waves), conditions)
        chain = ChainSolve(empty, waves, self.solver, self.pressure_classes, on_scale)
        if conditions is not None and conditions.iterated:
            return solve_coupled_chain(chain, rubber, conditions)
        return chain(self.rubber_at or (lambda wave, so_far: before), start)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the prediction as a Dataset; `on_progress` gets the `ChainResult` so far.

        A wave that does not converge ends the chain and is its last one. Without permission to
        extrapolate there may be no wave. `prediction_status` holds the reason.
        """
        try:
            result = self.solve(rubber, surface.sines, load, on_scale=on_progress)
        except ChainError as failure:
            ending = {model.STATUS: str(failure), model.STATUS_WORD: str(failure.status or "")}
            return failure.partial.to_dataset().assign(ending)
        except ExtrapolationError as refusal:
            empty = xr.Dataset(attrs=provenance.version_attributes())
            totals = dict.fromkeys(model.TOTALS, math.nan)
            return model.predicted_answer(empty, totals, str(refusal), self.name, load)
        return result.to_dataset()
