"""What `gripscale run` answers, from Python: `python examples/run_case.py [CASE.toml [FOLDER]]`."""

import sys
from pathlib import Path

import gripscale as gs

path = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent / "road_and_tread" / "case.toml"
folder = Path(sys.argv[2] if len(sys.argv) > 2 else "results/run_case")

answer = gs.answer(gs.read_case(path))
print(answer)
folder.mkdir(parents=True, exist_ok=True)
answer.save(folder / "answer.nc")
