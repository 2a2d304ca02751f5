"""What running a case gives: its inputs as prepared, and a prediction in motion and at rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.case_file.prepare import PreparedRubber
from gripscale.case_file.read import CaseFile, prediction_key
from gripscale.chain import Chain, ChainError
from gripscale.chain.prediction import Prediction
from gripscale.conditions.conditions import Conditions
from gripscale.core.units import DisplayUnit, display_unit
from gripscale.model import Doubtful, Load, doubt_sentences, load_doubts
from gripscale.rubber import Rubber, temperature_doubts
from gripscale.surface import Surface

if TYPE_CHECKING:
    import xarray as xr


DYNAMIC, STATIC = "dynamic", "static"


@dataclass
class CaseResults:
    """Everything a case gave: its inputs as prepared, and predictions as far as they were got."""

    file: CaseFile
    surface: Surface
    rubber: PreparedRubber
    chain: Chain
    """With its conditions."""
    predictions: dict[str, Prediction] = field(default_factory=dict)
    """By name, "dynamic" and "static"."""
    failures: dict[str, ChainError] = field(default_factory=dict)
    """Why a prediction has no totals, by name."""
    folder: Path | None = None
    """Where the results were written."""
    direct: xr.Dataset | None = None
    """Totals of the direct contact of the measured profiles, which judges the predictions."""
    continued: dict[Load, xr.Dataset] = field(default_factory=dict)
    """Contact against the cut-off, below the measurement, by load; empty if not asked for."""
    _keys: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    @property
    def load(self) -> Load:
        """The load of the case, at its speed."""
        return self.file.case.load.nominal

    def key(self, name: str) -> str:
        """Return what the prediction `name` depends on, as one word.

        Raises `FileError` if a file of the case cannot be read any more.
        """
        if name not in self._keys:
            self._keys[name] = prediction_key(self.file, name)
        return self._keys[name]

    def dataset(self, name: str) -> xr.Dataset:
        """Return the prediction `name` with what it is of: case, surface, rubber."""
        sources = {
            "case_file": str(self.file.path),
            "surface_source": self.surface.source,
            "rubber_source": self.rubber.source,
        }
        return self.predictions[name].to_dataset().assign_attrs(self.file.attributes | sources)

    def display_unit(self, name: str) -> DisplayUnit:
        """Return how `pressure`, `speed` or `footprint` is shown: as the case gives it."""
        return display_unit(name, self.file.units)

    @property
    def conditions(self) -> Conditions | None:
        """What changes the rubber, or None where nothing was asked for."""
        return self.chain.conditions

    @property
    def rubber_before(self) -> Rubber:
        """The rubber at the temperature before the contact."""
        rubber = self.rubber.rubber
        return rubber if self.conditions is None else self.conditions.before(rubber)

    def conditions_notes(self) -> list[str]:
        """Return what the conditions ask for that was not measured."""
        if self.conditions is None or self.conditions.temperature is None:
            return []
        warnings = temperature_doubts({self.rubber.rubber.name or "rubber": self.rubber_before})
        return [f"{text[0].upper()}{text[1:]}." for text in warnings]

    def load_notes(self) -> list[str]:
        """Return what is doubtful about the load on this surface."""
        footprint, largest = self.load.footprint, float(self.surface.sines.wavelength[0])
        if footprint >= largest:
            return []
        length_unit = self.display_unit("footprint")
        return [
            f"The footprint, {length_unit.text(footprint, 3)}, is shorter than the largest wave, "
            f"{length_unit.text(largest, 3)}, "
            "which it cannot hold once: is its unit right? If so, leave such waves out."
        ]

    def doubts(
        self, surfaces: Iterable[Surface] | None = None, loads: Iterable[Load] | None = None
    ) -> list[str]:
        """Return why the answer may be that of another road, rubber or load, a sentence each.

        Of an answer on other surfaces or under other loads than those of the case, these count.
        """
        roads = [self.surface] if surfaces is None else surfaces
        inputs: list[Doubtful] = [*roads, self.rubber]
        texts = [text for each in inputs for text in doubt_sentences(each)]
        texts += load_doubts([self.load] if loads is None else loads, self.file.units)
        texts = list(dict.fromkeys(texts))
        if self.rubber.rubber.reference_temperature is None:
            texts.append(
                "Neither the file of the rubber nor the case states the temperature of its moduli: "
                "state reference_temperature in [rubber]."
            )
        return texts

    @property
    def dynamic(self) -> Prediction | None:
        """The rubber sliding, or None if it was not asked for or did not get so far."""
        return self.predictions.get(DYNAMIC)

    @property
    def static(self) -> Prediction | None:
        """The relaxed rubber at rest, or None if it was not asked for or did not get so far."""
        return self.predictions.get(STATIC)

    @property
    def converged(self) -> bool:
        """Whether every prediction asked for may be used."""
        return not self.failures

    def planned(self) -> Iterator[tuple[str, float]]:
        """Yield name and speed [m/s] of the predictions the case asks for."""
        load = self.file.case.load
        if load.speed > 0.0:
            yield DYNAMIC, load.speed
        if load.static or load.speed == 0.0:
            yield STATIC, 0.0


def title(speed: float, speed_unit: DisplayUnit) -> str:
    """Return what tables and figures call a prediction at `speed` [m/s], shown in `speed_unit`."""
    return "Static" if speed == 0.0 else f"Dynamic, {speed_unit.text(speed)}"
