"""What a package needs only in one function it must not load when it is imported."""

import subprocess
import sys
from pathlib import Path

import pytest

import gripscale

# A bare parent package, so that only the package itself is loaded.
PROGRAM = """
import importlib, sys, types
parent = types.ModuleType("gripscale")
parent.__path__ = [sys.argv[1]]
sys.modules["gripscale"] = parent
importlib.import_module(sys.argv[2])
print(*sorted({name.partition(".")[0] for name in sys.modules}))
"""


@pytest.mark.parametrize(
    ("package", "light"),
    [
        ("gripscale.surface", set()),
        ("gripscale.surface.surface", {"numpy"}),
        ("gripscale.rubber", {"numpy"}),
        ("gripscale.case_file", set()),
        ("gripscale.case_file.read", {"numpy", "pydantic"}),
        # numpy reads how many threads BLAS may take, which the command sets, as it is imported
        ("gripscale.cli", {"typer"}),
    ],
)
def test_a_package_loads_only_what_it_must(package, light):
    folder = str(Path(gripscale.__file__).parent)
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, folder, package], capture_output=True, text=True, check=True
    )
    heavy = {"numpy", "scipy", "xarray", "pandas", "matplotlib", "pydantic", "typer", "rich"}
    assert set(done.stdout.split()) & heavy == light


def test_a_saved_result_needs_no_dask(tmp_path):
    """Dask, where it is installed, takes longer to import than a prediction to be solved."""
    program = (
        "import sys, xarray; from gripscale.io import netcdf; "
        "netcdf.save(xarray.Dataset({'friction': 0.2}), sys.argv[1]); "
        "print('distributed' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "saved.nc")],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "False"
