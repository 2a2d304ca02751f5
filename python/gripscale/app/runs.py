"""The runs of one visit."""

from __future__ import annotations

import param

from gripscale.app.run import Run
from gripscale.app.state import CaseState
from gripscale.case import CaseFile, folder
from gripscale.case.results import planned
from gripscale.errors import InputError


class Runs(param.Parameterized):
    """All runs in order; `changes` counts whenever one starts or ends."""

    changes: int = param.Integer(0)  # type: ignore[assignment]

    def __init__(self, state: CaseState) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._state = state
        self.all: list[Run] = []

    @property
    def going(self) -> Run | None:
        """The run whose process is there."""
        return next((run for run in self.all if run.going), None)

    def start(self) -> Run:
        """Run the case as it is now; a stopped run of the same text goes on.

        Raises what is wrong with the case, and `InputError` while another run is going.
        """
        if self.going is not None:
            raise InputError(f"{self.going.name} is still going; stop it or wait for its end")
        file = self._state.file()
        text = file.text
        run = next((one for one in self.all if one.stopped and one.text == text), None)
        if run is None:
            run = self._new(file)
            self.all.append(run)
        run.stopped = False
        run.start()
        self.changes += 1
        return run

    def stop(self) -> None:
        """End whatever is going."""
        for run in self.all:
            run.stop()
        self.changes += 1

    def _new(self, file: CaseFile) -> Run:
        """Return a run of a case, saved beside the files it names."""
        name = f"run-{len(self.all) + 1}"
        place = self._state.place.path
        case = folder.write_text(place / f"{name}.toml", file.text)
        return Run(
            name,
            case,
            place / "runs" / name,
            file.text,
            predictions=len(list(planned(file.case.load))),
            passing=file.case.conditions.iterated,
        )
