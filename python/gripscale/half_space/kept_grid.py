"""The contact on the last solved grid of a sequence, in a file: a solution that stopped resumes."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.core import InputError
from gripscale.experiment.task import content_hash
from gripscale.half_space.grid import Grid
from gripscale.half_space.grid_sequence import GridRecord, GridSequence, Level, LevelContact
from gripscale.io.folders import make_folder
from gripscale.io.netcdf import write_whole
from gripscale.theory.half_plane import GridContact


@dataclass(frozen=True)
class KeptGrid:
    """The file of one problem in a folder."""

    path: Path
    key: str

    @classmethod
    def of(cls, folder: str | Path, sequence: GridSequence) -> KeptGrid:
        """Return the file of a sequence; raise `FileError` if the folder cannot be made."""
        body = sequence.body
        if body.by_scale is not None:
            raise InputError("folder must be None with softening or heat, which solve many grids")
        heights = sequence.heights
        waves = heights.spectrum.view(heights.spectrum.real.dtype)
        surface = heights.grid.lengths, heights.smallest_wavelength, heights.whole, waves
        rubber = body.layers or body.rubber
        inputs = rubber, body.speed, body.thickness, sequence.pressure, surface
        make_folder(Path(folder))
        return cls(Path(folder) / "grid.npz", content_hash(inputs))

    def load(self, sequence: GridSequence, plan: list[Level]) -> list[GridRecord]:
        """Return the numbers of solved grids, which leave the `plan`; none of another problem."""
        if not self.path.exists():
            return []
        with np.load(self.path) as data:
            if str(data["key"]) != self.key:
                return []
            records = [GridRecord(**numbers) for numbers in json.loads(str(data["records"]))]
            numbers: dict[str, Any] = json.loads(str(data["numbers"]))
            pressure, gap = data["pressure"], data["gap"]
        level = Level(Grid(pressure.shape, sequence.heights.grid.lengths), records[-1].cut_off)
        del plan[: plan.index(level) + 1 if level in plan else len(plan)]
        height = sequence.heights.on(level.grid.shape, level.cut_off)
        contact = GridContact(pressure, gap, pressure > 0.0, **numbers)
        sequence.last = LevelContact(level, height, contact, records[-1])
        return records

    def save(self, solved: LevelContact, records: list[GridRecord]) -> None:
        """Replace the file by the contact on the last grid."""
        contact, names = solved.contact, ("iterations", "settled", "products", "missing")
        arrays: dict[str, Any] = {"pressure": contact.pressure, "gap": contact.gap}
        arrays["records"] = json.dumps([asdict(record) for record in records])
        arrays["numbers"] = json.dumps({name: getattr(contact, name) for name in names})

        def write(part: Path) -> None:
            with part.open("wb") as file:
                np.savez(file, key=self.key, **arrays)

        write_whole(self.path, write)
