"""Roads or compounds side by side, by rank."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gripscale.charts.draw import Picture, image
from gripscale.charts.style import power_of_ten
from gripscale.core.arrays import Array
from gripscale.core.finding import sentences
from gripscale.core.units import MILLI, ZERO_CELSIUS, display_unit_of
from gripscale.io.table import Column, Table, significant
from gripscale.model import input_doubts_of
from gripscale.questions import view
from gripscale.questions.answer.variables import is_estimated
from gripscale.questions.inputs.page import rubbers_of, texture_table
from gripscale.questions.vary.friction_ratio import RANKED
from gripscale.questions.vary.inputs import READING_NOTES, TEMPERATURE
from gripscale.questions.vary.question import Variation
from gripscale.report.elements import Card, Page, Section, as_elements
from gripscale.surface.surface import SURFACE_KIND

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.rubber import Rubber

# Confidence from which one lies over another, as outside of a two-sided 90 % interval.
SIGNIFICANT = 0.95
_CERTAIN = 0.995


def percent_sure(confidence: float) -> str:
    """Return a confidence in per cent."""
    return "> 99 %" if confidence > _CERTAIN else f"{100.0 * confidence:.0f} %"


class SideBySide(Variation):
    """Answers of several surfaces or compounds, read by the rank of their friction."""

    dim: ClassVar[str]  # dimension of what stands side by side

    @cached_property
    def names(self) -> list[str]:
        """What stands side by side is called."""
        return [str(name) for name in self.data[self.dim].values]

    @cached_property
    def friction(self) -> Array:
        """Friction of each [-]."""
        return np.asarray(self.data[view.answers(self.data)[0]].transpose(self.dim).values)

    @cached_property
    def order(self) -> list[int]:
        """Numbers of what has friction, the largest first."""
        by_size = np.argsort(-self.friction, kind="stable")
        return [int(i) for i in by_size if self.friction[i] > 0.0]

    @property
    def noun(self) -> str:
        """What stands side by side."""
        if self.dim == "rubber":
            return "compound"
        return str(self.data.attrs.get(SURFACE_KIND, "surface"))

    def _of_pair(self, name: str, high: int, low: int) -> float:
        """Return what is said of one over another, such as their `friction_ratio`."""
        return float(self.data[name].transpose(self.dim, "over")[high, low])

    def _confidence(self, high: int, low: int) -> str:
        """Return how sure it is that one lies over another, in brackets; empty if unknown."""
        confidence = self._of_pair("confidence", high, low)
        if math.isnan(confidence):
            return ""
        if confidence < SIGNIFICANT:
            return f" ({percent_sure(confidence)}: no significant difference)"
        return f" ({percent_sure(confidence)} sure)"

    @property
    def lines(self) -> Sequence[str]:
        """The ranking by friction, with the confidence of each step and its causes."""
        data, steps = self.data, list(pairwise(self.order))
        if not steps:
            return ("Answer: none; no two of them have a friction to be compared.",)
        texts = {at: f"{self.names[at]} {significant(self.friction[at])}" for at in self.order}
        over = [f" over {texts[low]}{self._confidence(high, low)}" for high, low in steps]
        lines = [f"Answer: friction μ ranks {texts[self.order[0]]}{''.join(over)}."]
        area = data[view.answers(data)[1]].values
        for high, low in steps:
            ratio, *ends = (
                self._of_pair(f"friction_ratio{end}", high, low) for end in ("", "_low", "_high")
            )
            interval = f" ({' to '.join(map(significant, ends))})" if math.isfinite(ends[0]) else ""
            lines.append(
                f"  {self.names[high]} over {self.names[low]}: friction × {significant(ratio)}"
                f"{interval}, contact area × {significant(area[high] / area[low])}"
                f"{self._causes(high, low)}"
            )
        if doubts := input_doubts_of(data):
            lines.append(f"  not to be relied on: {sentences(doubts)}")
        pressure, speed = (
            display_unit_of(data.attrs, name).text(float(data.attrs[f"nominal_{name}"]))
            for name in ("pressure", "speed")
        )
        kelvin = data.attrs.get(TEMPERATURE)
        at = "" if kelvin is None else f", all at {kelvin - ZERO_CELSIUS:.4g} °C"
        return (*lines, f"  for {pressure} and {speed}{at}; {self._basis()}")

    def _causes(self, high: int, low: int) -> str:
        """Return at which wavelengths and relaxation times most of a difference arises."""
        texts = []
        for name, dim in (("octave_friction", "octave"), ("friction_by_decade", "decade")):
            if name not in self.data or (self.dim, dim) == ("surface", "decade"):
                continue
            rows = np.nan_to_num(self.data[name].values)
            differences = rows[high] - rows[low]
            at = int(np.argmax(np.abs(differences)))
            end = float(self.data[dim][at])
            where = f"waves of {significant(end / MILLI)} to {significant(2.0 * end / MILLI)} mm"
            if dim == "decade":
                power = round(math.log10(end))
                where = f"relaxation times of {power_of_ten(power)} to {power_of_ten(power + 1)} s"
            texts.append(f"{differences[at]:+.3f} by {where}")
        return f"; most of μ: {', '.join(texts)}" if texts else ""

    def _basis(self) -> str:
        """Return which model the ranking is from, and what its confidence holds."""
        data = self.data
        if not is_estimated(data, "friction"):
            return "chain of sine waves, without an interval: not all of the surfaces were measured"
        answer = "direct contact of the measured surface × its factors"
        if not np.isfinite(data["friction_ratio_low"].values).any():
            return (
                f"{answer}; no interval: a surface is too short to tell whether it stands for the "
                "whole"
            )
        if self.dim == "surface":
            return f"{answer}; the errors of the surfaces are independent"
        has_moduli = "series_change" in data and bool(data["series_change"].notnull().any())
        moduli = "measured moduli, " if has_moduli else ""
        return (
            f"{answer}; what all share of the surface and its factors cancels, what is left comes "
            f"from {moduli}pieces of the surface and grids"
        )

    def table(self) -> Table:
        """Return the answers by rank, each with its friction over that of the next."""
        order = self.order + [at for at in range(len(self.names)) if at not in self.order]
        ranked, about = self.data.isel({self.dim: order}), {"symbol": "μ over the next"}
        for name in RANKED:
            values = [*(self._of_pair(name, *pair) for pair in pairwise(order)), math.nan]
            ranked[f"{name}_over_next"] = (self.dim, values, about)
        interval = {"interval": "friction_ratio_low_over_next friction_ratio_high_over_next"}
        ranked["friction_ratio_over_next"].attrs |= interval
        names = [*view.answers(ranked), "friction_ratio_over_next"]
        columns = list(view.number_columns(ranked, names))
        sure = ranked["confidence_over_next"].values
        if np.isfinite(sure).any():
            columns.append(Column("confidence", sure, "confidence", format=percent_sure))
        caption = f"{self.noun.capitalize()}s by friction"
        table = view.table(ranked, columns, f"{self.dim}s", caption)
        return table if any(table.bad) else replace(table, columns=table.columns[:-1])

    @property
    def notes(self) -> Sequence[str]:
        """How inputs were read, and what was not measured."""
        return tuple(str(self.data.attrs.get(READING_NOTES, "")).splitlines())

    def parts(self) -> Iterator[str | Table]:
        """Yield the ranking, the texture of surfaces, and notes."""
        yield self.table()
        if "rms_height" in self.data:
            yield texture_table(self.data, self.dim, self.noun)
        yield from (f"note: {note}" for note in self.notes)

    @abstractmethod
    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength, and statistics of surfaces or moduli of compounds."""

    def figures(self) -> Iterator[tuple[str, Figure]]:
        """Yield the pictures, with their names."""
        yield from ((picture.name, picture.figure) for picture in self.pictures())

    def page_content(self) -> Page:
        """Return the friction of each by rank, tables and pictures, then the inputs."""
        data = self.data
        cards = [
            Card(
                f"μ of {self.names[high]}",
                significant(self.friction[high]),
                "" if low is None else f"over {self.names[low]}{self._confidence(high, low)}",
            )
            for high, low in zip(self.order, [*self.order[1:], None], strict=True)
        ]
        ranking = [*as_elements(self.parts()), *map(image, self.pictures())]
        return view.page(
            data,
            (
                f"{self.noun.capitalize()}s side by side: {', '.join(self.names)}",
                str(data.attrs.get("title", "")),
            ),
            self.findings,
            cards,
            [Section(f"{self.dim}s", "Ranking", ranking)],
            self.lines,
        )


class Surfaces(SideBySide):
    """Several surfaces under the rubber and the load of a case."""

    kind = "surfaces"
    dim = "surface"

    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength, and correlation and spectrum."""
        from gripscale.questions.vary.charts_side_by_side import road_pictures

        yield from road_pictures(self.data)


class Compounds(SideBySide):
    """Several compounds on the surface and under the load of a case."""

    kind = "compounds"
    dim = "rubber"

    @property
    def rubbers(self) -> dict[str, Rubber]:
        """The compounds as they were solved, at one temperature; without strain energy."""
        rubbers = rubbers_of(self.data)
        complete = len(rubbers) == len(self.names)
        return dict(zip(self.names, rubbers, strict=True)) if complete else {}

    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength and relaxation time, and the moduli."""
        from gripscale.questions.vary.charts_side_by_side import compound_pictures

        yield from compound_pictures(self.data, self.rubbers)
