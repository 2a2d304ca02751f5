"""The comparisons in a folder: of one case under its load, and over varied inputs."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import xarray as xr

from gripscale.questions.compare.charts_of_ladder import varied
from gripscale.questions.result import predicted_tree
from gripscale.questions.uncertainty.propagation import of_same_inputs

COMPARISON = "comparison"
"""Folder of a comparison in that of the run, and the name of its file."""
OVER = "over_*.nc"
"""Files of comparisons over a varied input."""


@dataclass(frozen=True)
class Compared:
    """The comparisons of one case: under its own load, and over varied inputs."""

    ladder: xr.Dataset | None = None
    over: list[xr.Dataset] = field(default_factory=list)
    uncertainty: xr.Dataset | None = None
    """What was sampled of the case, or of another."""

    @property
    def parts(self) -> list[xr.Dataset]:
        """All of them."""
        return [*([] if self.ladder is None else [self.ladder]), *self.over]

    @property
    def case(self) -> str:
        """The text of the case."""
        return str(self.parts[0].attrs.get("case", ""))

    @property
    def own_uncertainty(self) -> xr.Dataset | None:
        """What was sampled of this very case, or None."""
        data = self.uncertainty
        return data if data is not None and of_same_inputs(data, self.case) else None

    def of(self, case: object) -> Compared:
        """Return those of just this text of a case."""
        return Compared.holding([data for data in self.parts if data.attrs.get("case") == case])

    @classmethod
    def holding(cls, parts: list[xr.Dataset]) -> Compared:
        """Return the comparisons, of which at most one has no axis."""
        ladders = [data for data in parts if not varied(data)]
        return cls(ladders[0] if ladders else None, [data for data in parts if varied(data)])


def stored_comparisons(folder: Path) -> Compared:
    """Read the comparisons in `folder`."""
    paths = [folder / f"{COMPARISON}.nc", *sorted(folder.glob(OVER))]
    return Compared.holding([predicted_tree(path).to_dataset() for path in paths if path.is_file()])
