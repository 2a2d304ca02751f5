"""Results to report on: a coarse run; the same with a failed wave; a small study."""

import json
import shutil

import numpy as np
import pytest
import xarray as xr

from gripscale.chain.chain import Chain
from gripscale.core.provenance import CASE_TITLE
from gripscale.io import netcdf
from gripscale.model import METHOD, TOTALS
from tests.run_case import run_case
from tests.samples import COARSE_BLOCK, case_text, three_waves, write_maxwell, write_road

CASE = '# A small case <b>with</b> "marks" & signs\n' + case_text(
    'files = ["road.txt", "lane.txt"]\ncrop = ["10 mm", "390 mm"]\nscales = 3\ns_wavelength = 3',
    'file = "dma.txt"\nterms = 6',
    COARSE_BLOCK + '\n\n[output]\nfolder = "results"',
)
WAVES = 3


def write_inputs(folder):
    """Write two roads of three waves, a Maxwell rubber and the case."""
    for name, phase in (("road", 0.0), ("lane", 0.7)):
        write_road(folder / f"{name}.txt", three_waves(phase))
    write_maxwell(folder / "dma.txt")
    (folder / "case.toml").write_text(CASE)


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory):
    """The results folder of a real run, without its printed figures."""
    folder = tmp_path_factory.mktemp("somewhere-private")
    write_inputs(folder)
    run_case(folder / "case.toml", folder / "results")
    yield folder / "results"
    shutil.rmtree(folder)


def read(path):
    """Return a prediction and the groups beside it."""
    tree = netcdf.load_tree(path)
    groups = {name: part.to_dataset(inherit=False) for name, part in tree.children.items()}
    return tree.to_dataset(), groups


def fail_second_wave(data):
    """Return a prediction that ended at its second wave."""
    cut = data.isel(scale=slice(0, 2)).copy(deep=True)
    cut["status"] = ("scale", np.array(["converged", "iteration limit"], dtype=object))
    cut["load_reached"].values[1] = 0.4
    for name in ("running_contact_fraction", "running_friction"):
        cut[name].values[1] = np.nan
    for name in TOTALS:
        cut[name] = np.nan
    return cut.assign(
        prediction_status="wave 2 of 3 did not converge: iteration limit",
        prediction_status_word="iteration limit",
    )


@pytest.fixture
def failed_folder(run_folder, tmp_path):
    """The run with a chain that failed at its second wave."""
    target = tmp_path / "failed"
    shutil.copytree(run_folder, target)
    data, _ = read(target / "chain.nc")
    netcdf.save(fail_second_wave(data), target / "chain.nc")
    return target


@pytest.fixture(scope="session")
def study_file(tmp_path_factory):
    """A study over two speeds and two rubbers, one prediction of which failed."""
    axes, waves = ("speed", "rubber"), ("speed", "rubber", "scale")
    area = np.linspace(0.2, 0.9, 12).reshape(2, 2, 3)
    area[1, 1, 2] = np.nan
    status = np.full((2, 2), "converged", dtype=object)
    status[1, 1] = "wave 3 of 3 did not converge: iteration limit"
    word = np.where(status == "converged", "converged", "iteration limit").astype(object)
    running, friction = np.cumprod(area, axis=2), np.cumsum(0.1 * area, axis=2)
    data = xr.Dataset(
        {
            "total_contact_fraction": (axes, running[:, :, -1]),
            "total_friction": (axes, friction[:, :, -1]),
            "prediction_status": (axes, status),
            "prediction_status_word": (axes, word),
            "wavelength": (waves, np.broadcast_to([1e-2, 2e-3, 4e-4], area.shape)),
            "contact_fraction": (waves, area),
            "running_contact_fraction": (waves, running),
            "running_friction": (waves, friction),
        },
        {
            "speed": ("speed", [0.03, 3.0], {"units": "m/s", "long_name": "sliding speed"}),
            "rubber": np.array(["tread", "<b>SBR</b>"], dtype=object),
            "scale": [1, 2, 3],
        },
        {
            "kind": "study",
            "title": "Study of <contact>",
            CASE_TITLE: "tread on <contact>",
            "case": CASE,
            "display_units": '{"pressure": "bar", "footprint": "mm"}',
            "nominal_pressure": 3e5,
            "footprint": 0.1,
            "conditions": "null",
            METHOD: json.dumps(Chain.method),
            "version_gripscale": "0.1.0",
        },
    )
    return netcdf.save(data, tmp_path_factory.mktemp("study") / "study.nc")
