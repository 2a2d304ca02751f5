"""The answer of a case file from Python: `python examples/run_case.py [CASE.toml [FOLDER]]`."""

import sys
from pathlib import Path

import gripscale as gs

path = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent / "road_and_tread" / "case.toml"
folder = Path(sys.argv[2] if len(sys.argv) > 2 else "results/run_case")
folder.mkdir(parents=True, exist_ok=True)
answer = gs.answer(gs.read_case(path))
print(answer)
print("Saved:", answer.save(folder / "answer.nc"))
