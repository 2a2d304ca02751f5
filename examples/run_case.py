"""A case file run from Python: `python examples/run_case.py [CASE.toml [FOLDER]]`."""

import sys
from pathlib import Path

from gripscale.case_file import run_case

case = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent / "road_and_tread" / "case.toml"
results = run_case(case, output=sys.argv[2] if len(sys.argv) > 2 else "results/run_case")
print(f"A_r/A_0 = {results.dynamic.contact_fraction:.4f}, mu = {results.dynamic.friction:.3f}")
print(f"{len(results.dynamic.scales)} waves on {results.case.rubber.name}")
