"""The record that a run keeps of its inputs, as pages read it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.core.finding import Finding, Severity, Topic, from_json
from gripscale.io.table import significant
from gripscale.report.elements import number_text


@dataclass(frozen=True)
class InputRecord:
    """The record that a run keeps of its inputs, as `record` writes it."""

    data: xr.Dataset

    @classmethod
    def of_tree(cls, tree: xr.DataTree) -> InputRecord:
        """Return the record in a result with its groups; an empty one where it holds none."""
        return cls(tree.children.get("inputs", xr.DataTree()).to_dataset(inherit=False))

    def has(self, name: str) -> bool:
        """Return whether a variable or an attribute is there."""
        return name in self.data or name in self.data.attrs

    def number(self, name: str) -> float:
        """Return an attribute, NaN where it is missing."""
        return float(self.data.attrs.get(name, math.nan))

    def text(self, name: str) -> str:
        """Return an attribute, empty where it is missing."""
        return str(self.data.attrs.get(name, ""))

    def quantity(
        self,
        name: str,
        unit: str = "",
        size: float = 1.0,
        format: Callable[[float], str] = significant,
    ) -> str:
        """Return an attribute as a page shows it, with its unit."""
        return f"{number_text(self.number(name), size, format)} {unit}".rstrip()

    @property
    def is_empty(self) -> bool:
        """Whether nothing was recorded: not the result of `gripscale run`."""
        return not self.data.data_vars

    @property
    def of_map(self) -> bool:
        """Whether a map was measured."""
        return "texture_of" in self.data and "map" in self.data["texture_of"].values

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus of the rubber [Pa]."""
        return self.number("bulk_modulus_Pa")

    @property
    def relaxation_times(self) -> tuple[ArrayLike, ArrayLike]:
        """Times [s] and moduli [Pa] of the Maxwell elements."""
        names = ("term_relaxation_time", "term_modulus")
        times, moduli = (self.data.get(name, xr.DataArray(np.zeros(0))).values for name in names)
        return times, moduli

    @property
    def findings(self) -> list[str]:
        """What the fit of the Prony series found."""
        return self.text("prony_findings").splitlines()

    @property
    def digests(self) -> list[str] | None:
        """Checksums of the files the prediction rests on; None where none were recorded."""
        if "file_sha256" not in self.data:
            return None
        counted = self.data["file_role"].values != "measured"
        return [str(digest) for digest in self.data["file_sha256"].values[counted]]

    @property
    def loss_factor_error(self) -> float:
        """Mean relative error of the loss factor of the Prony series where the waves excite it.

        NaN at rest, without a master curve, and where none of its rows lies between the waves.
        """
        if "master_series_loss" not in self.data:
            return math.nan
        names = ("master_loss", "master_storage", "master_series_loss", "master_series_storage")
        loss, storage, series_loss, series_storage = (self.data[name].values for name in names)
        omega = 2.0 * math.pi * self.data["master_frequency"].values
        low, high = self.number("excited_low_rad_per_s"), self.number("excited_high_rad_per_s")
        inside = (omega >= low) & (omega <= high)
        error = (series_loss / series_storage)[inside] / (loss / storage)[inside] - 1.0
        return float(error.mean()) if inside.any() else math.nan

    def warnings(self) -> Iterator[Finding]:
        """Yield what is doubtful about load, conditions, rubber and surface."""
        yield from from_json(self.text("findings"))
        if self.is_empty:
            text = (
                "The result holds no record of its inputs (a script or an older version wrote it): "
                "profiles, fits, master curve and doubts about the inputs are missing here."
            )
            yield Finding(Severity.WARNING, text, topic=Topic.SOURCE)
