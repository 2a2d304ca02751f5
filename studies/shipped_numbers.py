"""The numbers of the shipped road that README and documentation quote.

    python -m studies.shipped_numbers

solves the comparison of the shipped case (a minute of one core) and writes them to
docs/shipped_numbers.json; tests hold the texts to that file and the file to the commands.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.questions.answer.answer import answer
from gripscale.questions.answer.estimate import large_strain_answer
from gripscale.questions.answer.variables import answer_number
from gripscale.questions.compare.question import with_half_widths

ROOT = Path(__file__).resolve().parents[1]
CASE = ROOT / "examples" / "road_and_tread" / "case.toml"
NUMBERS = ROOT / "docs" / "shipped_numbers.json"


def of_run() -> dict[str, Any]:
    """Return what `gripscale run` answers."""
    data = answer(read_case(CASE)).data
    return {
        "run: friction": str(answer_number(data, "friction")),
        "run: contact area": str(answer_number(data, "contact_fraction")),
    }


def of_comparison() -> dict[str, Any]:
    """Return what `gripscale compare` makes of the answer with large strain solved."""
    data = gs.compare(read_case(CASE)).to_dataset()
    large = large_strain_answer(data)
    assert large is not None
    return {"compare: large strain": with_half_widths(large)}


def main() -> None:
    """Write the file."""
    NUMBERS.write_text(
        json.dumps(of_run() | of_comparison(), indent=2, ensure_ascii=False) + "\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
