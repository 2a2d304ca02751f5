"""Sliding contact by stepping in time with Tamaas (`MaxwellViscoelastic`), in its own process.

Run as `python tamaas_march.py PROBLEM.npz`, by a Python that has numpy and Tamaas 2.9 or newer; it
needs nothing of gripscale. The rubber rests on the grid and the surface moves under it, one point
further in every step (backward Euler), from the unloaded state until its creep (relaxation time
times glassy over relaxed modulus, of one element) has forgotten the start to 0.001. Lengths are in
periods, stresses in relaxed shear moduli. Prints a line of JSON.
"""

from __future__ import annotations

import json
import math
import sys
import time

import numpy as np
import tamaas

FORGOTTEN = 1e-3
TOLERANCE = 1e-6


def main() -> None:
    """March the problem of the file named on the command line."""
    tamaas.set_log_level(tamaas.LogLevel.error)
    tamaas.initialize(1)
    problem = np.load(sys.argv[1])
    length, relaxed = float(problem["lengths"][0]), float(problem["relaxed"])
    height, slope = problem["height"] / length, problem["slope"]
    moduli = problem["moduli"] / relaxed
    times = problem["times"] * problem["speed"] / length
    step = 1.0 / len(height)
    creep = times.max() * (1.0 + moduli.sum())
    steps = math.ceil(-math.log(FORGOTTEN) * creep / step)
    start = time.process_time()
    surface = height.copy()
    kinds = {1: tamaas.model_type.basic_1d, 2: tamaas.model_type.basic_2d}
    lengths = [float(other / length) for other in problem["lengths"]]
    model = tamaas.ModelFactory.createModel(kinds[height.ndim], lengths, list(height.shape))
    model.nu = float(problem["poisson_ratio"])
    model.E = 2.0 * (1.0 + model.nu)
    solver = tamaas.MaxwellViscoelastic(
        model, surface, TOLERANCE, step, moduli.tolist(), times.tolist()
    )
    solver.max_iter = 10000
    for taken in range(steps):
        surface[...] = np.roll(height, -taken, axis=0)  # the solver reads it where it is
        solver.solve(float(problem["pressure"]) / relaxed)
    pressure = np.roll(model.traction, steps - 1, axis=0)
    friction = float(np.mean(pressure * slope) / pressure.mean())
    print(
        json.dumps(
            {
                "seconds": time.process_time() - start,
                "steps": steps,
                "friction": friction,
                "touching": float(np.mean(pressure > 0.0)),
            }
        )
    )


if __name__ == "__main__":
    main()
