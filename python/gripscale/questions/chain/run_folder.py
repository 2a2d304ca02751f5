"""What a run left in its folder: predictions, inputs, answer, and what was asked of them since."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.experiment.measured_friction import MeasuredFriction, stored_measurement
from gripscale.questions.answer.answer import ANSWER_FILE
from gripscale.questions.chain.run import DYNAMIC, STATIC
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.compare.page import COMPARISON, Compared, stored_comparisons
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.stored import predicted_tree
from gripscale.questions.uncertainty.propagation import of_same_inputs, stored_uncertainty
from gripscale.questions.vary.effects import stored_effects


@dataclass(frozen=True)
class RunSource:
    """The predictions of one run, the record of its inputs and comparisons; both may be missing."""

    predictions: list[PredictionView]
    inputs: xr.Dataset
    # Models side by side over the same case, as far as they are there.
    compared: Compared = field(default_factory=Compared)
    # What each effect of its conditions is worth, model by model.
    effects: list[xr.Dataset] = field(default_factory=list)
    uncertainty: xr.Dataset | None = None  # what was sampled of it, or of another case
    direct: xr.Dataset | None = None  # totals of the direct contact of the measured profiles
    cut_off: xr.Dataset | None = None  # contact and friction against the cut-off

    @property
    def data(self) -> xr.Dataset:
        """The first prediction: load, waves, provenance, versions."""
        return self.predictions[0].data

    @property
    def attrs(self) -> dict[Any, Any]:
        """Attributes of the first prediction."""
        return self.data.attrs

    @property
    def record(self) -> InputRecord:
        """The record of its inputs."""
        return InputRecord(self.inputs)

    @property
    def measured(self) -> MeasuredFriction | None:
        """Measured friction that its case names."""
        return stored_measurement(self.inputs)

    @property
    def by_wave(self) -> list[PredictionView]:
        """The predictions of models that go wave by wave."""
        return [prediction for prediction in self.predictions if prediction.waves]

    @property
    def own_uncertainty(self) -> xr.Dataset | None:
        """What was sampled of its very inputs, or None."""
        data, case = self.uncertainty, str(self.attrs.get("case", ""))
        if data is None or not of_same_inputs(data, case, self.record.digests):
            return None
        return data


def read_run(folder: Path) -> RunSource | None:
    """Return what a run left in a folder; None if there is no prediction of a run in it.

    Raises `FileError` if a file is damaged or is no result of gripscale.
    """
    paths = [folder / f"{name}.nc" for name in (DYNAMIC, STATIC)]
    trees = {path.stem: predicted_tree(path) for path in paths if path.is_file()}
    if not trees:
        return None
    run = run_of(trees)
    case = run.attrs.get("case")

    def of_this_case(path: Path) -> xr.Dataset | None:
        data = predicted_tree(path).to_dataset() if path.is_file() else None
        return data if data is not None and data.attrs.get("case") == case else None

    return replace(
        run,
        compared=stored_comparisons(folder / COMPARISON),
        effects=stored_effects((folder / COMPARISON, folder), case),
        uncertainty=stored_uncertainty(folder),
        direct=of_this_case(folder / ANSWER_FILE),
        cut_off=of_this_case(folder / "cut_off.nc"),
    )


def run_of(trees: dict[str, xr.DataTree]) -> RunSource:
    """Return the run of its predictions by name, with the record of inputs of the first."""
    views = [PredictionView(tree.to_dataset(), name) for name, tree in trees.items()]
    return RunSource(views, InputRecord.of_tree(next(iter(trees.values()))).data)
