"""The variables of all results of the experiments, as they are kept in `experiments.npz`."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import gripscale as gs
from studies.isotropic_maps.map_factor import map_over_lines

from .experiments import Experiments
from .instruction_set import Values

NEW_NAMES = {
    "storage_factor": "storage_modulus_ratio",
    "loss_factor_left": "loss_modulus_ratio",
    "beyond_sweep": "strain_extrapolated",
    "beyond_shift": "temperature_extrapolated",
    "rubber_beyond_shift": "rubber_temperature_extrapolated",
    "warming_uniform": "flash_temperature_rise_uniform",
    "warming_larger_waves": "flash_temperature_rise_larger_waves",
    "warming_own": "flash_temperature_rise_own",
}
RENAMED: dict[str, str] = {
    f"{folder}/{before}": f"{folder}/{now}"
    for folder in ("run_conditions/chain", "study_effects/study", "study/study")
    for before, now in NEW_NAMES.items()
}
"""Today's name of a variable, "file/variable" or "file/group/variable", by its name in the file."""

STORES = {"predictions", "effects"}
"""Folders of single finished predictions, named by keys: their numbers are in the results too."""

NOT_PINNED = {"seconds", "prediction_key"}
"""Times, and keys that depend on the folder of the inputs."""

LONGEST = 150
"""Values kept of a variable at most: of longer ones every so many."""


def experiment_numbers(made: Experiments) -> Values:
    """Return all numeric variables and texts of all results by "file/group/variable"."""
    names = {now: before for before, now in RENAMED.items()}
    out: Values = {}
    for path in result_files(made.folder):
        name = path.relative_to(made.folder).with_suffix("").as_posix()
        for group, data in datasets(path):
            for variable, values in data.variables.items():
                if variable not in NOT_PINNED:
                    key = "/".join(filter(None, [name, group, str(variable)]))
                    out[names.get(key, key)] = _kept(values.values, made.folder)
    return out | _synthetic_map(made.folder)


def result_files(folder: Path) -> list[Path]:
    """Return the netCDF files of all results below `folder`."""
    return [path for path in sorted(folder.rglob("*.nc")) if not STORES & set(path.parts)]


def datasets(path: Path) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield name and content of each group of a netCDF file, the root's name being empty."""
    with xr.open_datatree(path, engine="netcdf4") as tree:
        for node in tree.subtree:
            yield node.path.strip("/"), node.to_dataset(inherit=False).load()


def _kept(values: NDArray[Any], folder: Path) -> NDArray[Any]:
    if np.issubdtype(values.dtype, np.number) or values.dtype == bool:
        flat = np.asarray(values, dtype=float)
        return flat if flat.size <= LONGEST else flat.ravel()[:: flat.size // LONGEST + 1]
    texts = [str(text).replace(str(folder), "FOLDER") for text in values.ravel().tolist()]
    return np.array(texts, dtype=str).reshape(values.shape)


def _synthetic_map(folder: Path) -> Values:
    """Return a synthetic map over its lines, much coarser than the comparison's own."""
    profiles = [gs.read_profile(folder / f"{name}.txt") for name in ("road", "lane")]
    rubber = gs.Rubber(6e6, [2e6, 3e6, 5e6], [1e-1, 1e-3, 1e-5])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = map_over_lines(
            rubber,
            [gs.clean(profile)[0] for profile in profiles],
            pressure=3e5,
            speed=0.3,
            smallest_wavelength=2.5e-3,
            points=128,
            construction="spectrum",
            seeds=[0],
            lines=1,
        )
    data = made.to_dataset()
    return {f"map_over_lines/{name}": data[name].values for name in data.data_vars}
