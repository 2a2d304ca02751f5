"""Made-up but well-formed results, so that figures are tested without a solver."""

import numpy as np
import pytest
import xarray as xr

from gripscale.chain import ChainResult
from gripscale.core.status import Status
from gripscale.model import TOTALS, Load, predicted_answer
from gripscale.rubber import Rubber
from gripscale.surface import SineStack
from gripscale.wave import ScaleResult
from gripscale.wave.result import waves_to_dataset

RUBBER = Rubber(5e6, [4e6, 8e6], [1e-2, 1e-4], valid_band=(1e-2, 1e6))


def wave(wavelength, status="converged", *, mesh=True, lifted=0.0):
    """Return a wave of 0.1 wavelengths amplitude with half of it in contact."""
    amplitude, columns = 0.1 * wavelength, 32
    edge = np.linspace(-0.5, 0.5, columns + 1) * wavelength
    depth = np.linspace(0.0, 1.5, 7)[:, None] * wavelength
    x = edge + 0.0 * depth
    z = amplitude + depth + 0.0 * edge + lifted
    pressure = np.maximum(np.cos(2 * np.pi * edge[:-1] / wavelength), 0.0) * 1e6
    return ScaleResult(
        wavelength=wavelength,
        amplitude=amplitude,
        pressure_received=3e5,
        speed=0.3,
        load_time=0.1,
        contact_fraction=0.5,
        friction=0.1,
        friction_from_dissipation=0.099,
        status=Status(status),
        newton_iterations=7,
        residual=1e-9,
        min_stretch=0.6,
        max_stretch=1.8,
        x=edge[:-1],
        pressure=pressure,
        rubber=RUBBER,
        deformed_mesh=(x, z) if mesh else None,
    )


@pytest.fixture
def make_wave():
    """One wave as a Dataset, without a prediction around it."""
    return lambda *values, **options: waves_to_dataset([wave(*values, **options)])


@pytest.fixture
def make_prediction():
    def make(speed=0.3, status="converged", count=3):
        lengths = [20e-3 / 4.0**i for i in range(count)]
        sines = SineStack(wavelength=lengths, amplitude=[0.1 * length for length in lengths])
        statuses = ["converged"] * (count - 1) + [status]
        waves = [wave(length, s) for length, s in zip(lengths, statuses, strict=True)]
        load = Load(3e5, speed, 0.1)
        return ChainResult(RUBBER, sines, load, waves, count).to_dataset()

    return make


@pytest.fixture
def without_waves():
    """The answer of a model without waves."""
    totals = dict(zip(TOTALS, (0.05, 0.6, 0.58), strict=True))
    return predicted_answer(xr.Dataset(), totals, "converged", "toy", Load(3e5, 0.3, 0.1))
