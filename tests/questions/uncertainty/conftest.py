"""A small case that is solved in milliseconds: a self-affine road, a noisy rubber, half-planes."""

import numpy as np
import pytest

from gripscale import Rubber
from gripscale.case_file import read_case
from gripscale.surface import self_affine_profile
from tests.samples import HALF_PLANE, case_text, write_master_curve, write_road

CASE = case_text(
    'files = ["road.txt"]\nscales = 4\nsmallest_wavelength = "1 mm"\ns_amplitude = 2.1',
    'file = "dma.txt"\nterms = 8',
    HALF_PLANE,
)
"""With a factor stated, as each sample fits its waves anew."""


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """A folder with a road, a master curve with 3 % of noise, and a case."""
    folder = tmp_path_factory.mktemp("uncertain")
    road = self_affine_profile(0.8, 3e-3, 8e-4, length=0.4, step=2e-4, seed=1)
    write_road(folder / "road.txt", road)
    frequency = np.geomspace(1e-1, 1e6, 40)
    modulus = Rubber(6e6, [3e6, 4e6, 8e6, 2e7], [1e-2, 1e-3, 1e-4, 1e-5]).complex_modulus(
        2 * np.pi * frequency
    )
    noise = np.exp(0.03 * np.random.default_rng(1).standard_normal((2, frequency.size)))
    noisy = modulus.real * noise[0] + 1j * modulus.imag * noise[1]
    write_master_curve(folder / "dma.txt", frequency, noisy)
    (folder / "case.toml").write_text(CASE)
    return folder


@pytest.fixture(scope="session")
def small_case(folder):
    """The case in the folder."""
    return read_case(folder / "case.toml")


@pytest.fixture(scope="session")
def known(folder):
    """The case with a choice of waves."""
    path = folder / "any_waves.toml"
    path.write_text(CASE.replace("s_amplitude = 2.1", ""))
    return read_case(path)
