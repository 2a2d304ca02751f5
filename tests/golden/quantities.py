"""The numbers a move of code must leave as they are: whole results, through public names only."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from tests.samples import EXAMPLES

DATA = EXAMPLES / "data"

Numbers = dict[str, NDArray[np.float64]]

COUNTS = ("load_steps", "load_reached", "indentation", "columns", "rows")
FIELDS = (
    *("wavelength", "amplitude", "pressure_received", "speed", "load_time", "contact_fraction"),
    *("contact_length", "friction", "friction_from_dissipation", "friction_mismatch"),
    *("newton_iterations", "residual", "min_stretch", "max_stretch"),
    *("contact_fraction_error", "friction_error"),
)


def all_numbers() -> Numbers:
    """Solve everything."""
    sines, rubber = _inputs()
    out: Numbers = {
        "sines/wavelength": sines.wavelength,
        "sines/amplitude": sines.amplitude,
        "rubber/moduli": rubber.moduli,
        "rubber/relaxation_times": rubber.relaxation_times,
        "rubber/equilibrium_modulus": np.array(rubber.equilibrium_modulus),
    }
    load = {"pressure": 3e5, "footprint": 0.1}
    dynamic = gs.solve_chain(rubber, sines, speed=0.3, **load)
    out |= _chain("dynamic", dynamic)
    out |= _chain("static", gs.solve_chain(rubber, sines, speed=0.0, **load))
    out |= _chain("tolerance", gs.solve_chain(rubber, sines, speed=0.3, tolerance=0.01, **load))
    half_plane = gs.solve_chain(rubber, sines, speed=0.3, solver="half_plane", **load)
    out |= _chain("half_plane", half_plane)
    out |= _transient(rubber, sines)
    return {name: np.asarray(values, dtype=float) for name, values in out.items()}


def _inputs() -> tuple[gs.SineStack, gs.Rubber]:
    road = DATA / "road"
    profiles = [
        gs.clean(
            gs.read_profile(road / f"20211011_aylesbury_dec_station_{station}.dat"),
            crop=(0.12, 1.78),
        )[0]
        for station in (0, 1)
    ]
    sines = gs.fit_sines(gs.height_difference(profiles), scales=8, smallest_wavelength=1e-4)
    master = gs.read_master_curve(
        DATA / "rubber" / "measured_dma.txt", reference_temperature=293.15
    )
    return sines, gs.fit_prony(master)


def _chain(name: str, prediction: gs.ChainResult) -> Numbers:
    out: Numbers = {
        f"{name}/total_contact_fraction": np.array(prediction.contact_fraction),
        f"{name}/total_friction": np.array(prediction.friction),
        f"{name}/running_contact_fraction": prediction.running_contact_fraction,
        f"{name}/running_friction": prediction.running_friction,
        f"{name}/modulus": np.array([scale.modulus for scale in prediction.scales]),
        f"{name}/loss_factor": np.array([scale.loss_factor for scale in prediction.scales]),
        f"{name}/outside_band": np.array([scale.outside_band for scale in prediction.scales]),
    }
    for i, scale in enumerate(prediction.scales):
        at = f"{name}/{i + 1}"
        assert scale.status == "converged"
        for field in FIELDS:
            out[f"{at}/{field}"] = np.array(getattr(scale, field))
        for field in COUNTS:
            out[f"{at}/{field}"] = np.array(scale.details.get(field, math.nan))
        out[f"{at}/x"], out[f"{at}/pressure"] = scale.x, scale.pressure
        if scale.deformed_mesh is not None:
            # Meshes are long: every fourth column of every second layer tells a change.
            for part, values in zip("xz", scale.deformed_mesh, strict=True):
                out[f"{at}/mesh_{part}"] = values[::2, ::4]
    return out


def _transient(rubber: gs.Rubber, sines: gs.SineStack) -> Numbers:
    wavelength, amplitude = float(sines.wavelength[2]), float(sines.amplitude[2])
    stages = [
        gs.Stage(duration=1.0 * wavelength / 0.3, speed=0.3, pressure=2e6),
        gs.Stage(duration=0.01, speed=0.0, pressure=2e6),
        gs.Stage(duration=0.5 * wavelength / 0.3, speed=-0.3, pressure=3e6),
    ]
    run = gs.solve_transient(
        rubber, wavelength=wavelength, amplitude=amplitude, stages=stages, columns=32, rows=8
    )
    assert run.status == "converged"
    names = ("time", "distance", "speed", "pressure", "friction", "contact_fraction")
    out = {f"transient/{name}": getattr(run, name) for name in (*names, "indentation")}
    return out | {"transient/newton_iterations": np.array(run.newton_iterations)}
