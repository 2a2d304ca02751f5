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

    parts: list[xr.Dataset] = field(default_factory=list)
    uncertainty: xr.Dataset | None = None
    """What was sampled of the case, or of another."""

    @property
    def ladder(self) -> xr.Dataset | None:
        """The comparison under the load of the case; None without one."""
        return next((data for data in self.parts if not varied(data)), None)

    @property
    def over(self) -> list[xr.Dataset]:
        """The comparisons over varied inputs."""
        return [data for data in self.parts if varied(data)]

    @property
    def own_uncertainty(self) -> xr.Dataset | None:
        """What was sampled of this very case, or None."""
        data, case = self.uncertainty, str(self.parts[0].attrs.get("case", ""))
        return data if data is not None and of_same_inputs(data, case) else None

    def of(self, case: object) -> Compared:
        """Return those of just this text of a case."""
        return Compared([data for data in self.parts if data.attrs.get("case") == case])


def stored_comparisons(folder: Path) -> Compared:
    """Read the comparisons in `folder`."""
    paths = [folder / f"{COMPARISON}.nc", *sorted(folder.glob(OVER))]
    return Compared([predicted_tree(path).to_dataset() for path in paths if path.is_file()])
