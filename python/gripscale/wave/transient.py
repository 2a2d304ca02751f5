"""Sliding in time on one rigid sine wave: start, stop, reversal, steps in speed and pressure.

In the frame of the wave the rubber moves through the mesh by one column per step, and the state of
every temporary network moves with it, exactly (unit CFL number). All relaxation times act at once.
The steady state of `gripscale.solve_scale` is the limit of a long run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gripscale.core import Array, Checked, Described, InputError, Quantity, Status, checked, checks
from gripscale.rubber import Rubber
from gripscale.wave import kernel
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.problem import Sine
from gripscale.wave.result import ScaleResult

DEFAULT_COLUMNS = 96
DEFAULT_ROWS = 14


class Stage(Checked):
    """A period of constant speed and pressure.

    >>> gs.Stage(duration="10 ms", speed="0.1 m/s", pressure="3 bar")
    Stage(duration=10 ms, speed=0.1 m/s, pressure=300 kPa)
    """

    duration: float = checked(checks.positive, unit="s")
    """Duration [s]; a sliding stage is rounded to whole columns of the mesh."""
    speed: float = checked(checks.number, unit="m/s")
    """Speed of the rubber's surface over the wave [m/s]; negative slides backwards, 0 dwells."""
    pressure: float = checked(checks.positive, unit="Pa")
    """Mean pressure [Pa]."""


@dataclass(frozen=True, eq=False, repr=False)
class TransientResult(Described):
    """Friction and contact against time; arrays of shape (moments,).

    `status` is `converged`, or the reason why the run ended early; its moments are valid.
    """

    time: Array
    distance: Array
    speed: Array
    pressure: Array
    friction: Array
    """Horizontal over vertical force [-]; positive opposes sliding in +x."""
    contact_fraction: Array
    indentation: Array
    """Approach of wave and block [m]."""
    status: Status
    newton_iterations: int
    wavelength: float

    @property
    def converged(self) -> bool:
        """Whether the whole programme was run."""
        return self.status == Status.CONVERGED

    def cycle(self, wavelengths: float = 1.0) -> dict[str, tuple[float, float, float]]:
        """Return mean, least and largest friction and contact over the last `wavelengths`."""
        path = np.cumsum(np.abs(np.diff(self.distance, prepend=self.distance[0])))
        last = path[-1] - path <= wavelengths * self.wavelength
        kept = {name: getattr(self, name)[last] for name in ("friction", "contact_fraction")}
        return {
            name: (float(values.mean()), float(values.min()), float(values.max()))
            for name, values in kept.items()
        }


def solve_transient(
    rubber: Rubber,
    *,
    wavelength: Quantity,
    amplitude: Quantity,
    stages: Sequence[Stage],
    start: ScaleResult | None = None,
    depth: float = 1.5,
    columns: int = DEFAULT_COLUMNS,
    rows: int = DEFAULT_ROWS,
    workers: int | None = None,
    **options: Any,
) -> TransientResult:
    """Press a rubber block on a rigid sine wave and slide it through a programme in time.

    The programme sets the speed of the rubber's *surface* over the wave (the lid follows the
    block's mean shear), which makes a dwell one of constant mean shear. Raises `InputError` if a
    value is not a number or out of its range, or there are no stages.

        >>> stages = [gs.Stage("5 ms", 0.1, "3 bar")]
        >>> gs.solve_transient(rubber, wavelength="2 mm", amplitude=1e-4, stages=stages).converged
        True

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid.
    wavelength, amplitude : float
        Of the wave [m].
    stages : sequence of Stage
        The programme. The first pressure acts at once, on rubber at rest.
    start : ScaleResult, optional
        A static or steady state to start from, solved with the same rubber and wave.
    depth, columns, rows, workers, **options
        As in `gripscale.solve_scale`.
    """
    checks.instance("rubber", rubber, Rubber)
    stages = checks.instances("stages", stages, Stage)
    if options.get("tolerance") is not None:
        raise InputError(
            f"tolerance cannot be kept in time, where the mesh stays as it is: give columns and "
            f"rows; got {checks.short_repr(options['tolerance'])}"
        )
    first = None if start is None else kernel.solution_of(start)
    profile = Sine(wavelength, amplitude)
    block = FiniteStrainBlock.of(depth=depth, columns=columns, rows=rows, **options)
    programme = [(stage.duration, stage.speed, stage.pressure) for stage in stages]
    run = kernel.solve_stages(
        rubber, profile, block.mesh, block.settings, programme, first, block.time_limit, workers
    )
    moments = ("time", "distance", "speed", "pressure", "friction", "contact_fraction")
    return TransientResult(
        **{name: getattr(run, name) for name in moments},
        indentation=run.approach * profile.wavelength,
        status=Status(run.status),
        newton_iterations=run.newton_iterations,
        wavelength=profile.wavelength,
    )
