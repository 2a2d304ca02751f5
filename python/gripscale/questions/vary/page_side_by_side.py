"""Roads or compounds side by side, by rank."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gripscale.charts.draw import Picture
from gripscale.charts.style import power_of_ten
from gripscale.core.finding import sentences
from gripscale.core.units import MILLI, ZERO_CELSIUS
from gripscale.io.table import Column, Table, significant
from gripscale.model import input_doubts_of
from gripscale.questions import view
from gripscale.questions.answer.variables import is_estimated
from gripscale.questions.inputs.page import rubbers_of, texture_table
from gripscale.questions.vary.friction_ratio import RANKED
from gripscale.questions.vary.inputs import READING_NOTES, TEMPERATURE
from gripscale.questions.vary.question import Variation
from gripscale.report.elements import Card
from gripscale.surface.surface import SURFACE_KIND

if TYPE_CHECKING:
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

    @property
    def names(self) -> list[str]:
        """What stands side by side is called."""
        return [str(name) for name in self.data[self.dim].values]

    @cached_property
    def friction(self) -> dict[str, float]:
        """Friction of each that has any [-], the largest first."""
        values = self.data[view.answers(self.data)[0]].transpose(self.dim).values
        each = {name: float(mu) for name, mu in zip(self.names, values, strict=True) if mu > 0.0}
        return dict(sorted(each.items(), key=lambda item: -item[1]))

    @property
    def noun(self) -> str:
        """What stands side by side."""
        if self.dim == "rubber":
            return "compound"
        return str(self.data.attrs.get(SURFACE_KIND, "surface"))

    @property
    def title(self) -> str:
        """What stands side by side."""
        return f"{self.noun.capitalize()}s side by side: {', '.join(self.names)}"

    def _of_pair(self, name: str, high: str, low: str) -> float:
        """Return what is said of one over another, such as their `friction_ratio`."""
        return float(self.data[name].sel({self.dim: high, "over": low}))

    def _over(self, high: str, low: str) -> str:
        """Return that one lies over another, and how surely."""
        confidence = self._of_pair("confidence", high, low)
        sure = "" if math.isnan(confidence) else f" ({percent_sure(confidence)} sure)"
        if confidence < SIGNIFICANT:
            sure = f" ({percent_sure(confidence)}: no significant difference)"
        return f"over {low} {significant(self.friction[low])}{sure}"

    @property
    def lines(self) -> Sequence[str]:
        """The ranking by friction, with the confidence of each step and its causes."""
        steps = list(pairwise(self.friction))
        if not steps:
            return ("Answer: none; no two of them have a friction to be compared.",)
        first, mu = next(iter(self.friction.items()))
        over = " ".join(self._over(*step) for step in steps)
        lines = [f"Answer: friction μ ranks {first} {significant(mu)} {over}."]
        area = self.data[view.answers(self.data)[1]]
        for high, low in steps:
            ratio, *ends = (
                self._of_pair(f"friction_ratio{end}", high, low) for end in ("", "_low", "_high")
            )
            interval = f" ({' to '.join(map(significant, ends))})" if math.isfinite(ends[0]) else ""
            areas = float(area.sel({self.dim: high}) / area.sel({self.dim: low}))
            lines.append(
                f"  {high} over {low}: friction × {significant(ratio)}{interval}, contact area × "
                f"{significant(areas)}{self._causes(high, low)}"
            )
        if doubts := input_doubts_of(self.data):
            lines.append(f"  not to be relied on: {sentences(doubts)}")
        kelvin = self.data.attrs.get(TEMPERATURE)
        at = "" if kelvin is None else f", all at {kelvin - ZERO_CELSIUS:.4g} °C"
        load = " and ".join(view.load_in_words(self.data))
        return (*lines, f"  for {load}{at}; {self._basis()}")

    def _causes(self, high: str, low: str) -> str:
        """Return at which wavelengths and relaxation times most of a difference arises."""
        texts = []
        for name, dim in (("octave_friction", "octave"), ("friction_by_decade", "decade")):
            if name not in self.data or (self.dim, dim) == ("surface", "decade"):
                continue
            parts = self.data[name].fillna(0.0)
            apart = parts.sel({self.dim: high}) - parts.sel({self.dim: low})
            most = apart[int(np.abs(apart.values).argmax())]
            end = float(most[dim])
            where = f"waves of {significant(end / MILLI)} to {significant(2.0 * end / MILLI)} mm"
            if dim == "decade":
                power = round(math.log10(end))
                where = f"relaxation times of {power_of_ten(power)} to {power_of_ten(power + 1)} s"
            texts.append(f"{float(most):+.3f} by {where}")
        return f"; most of μ: {', '.join(texts)}" if texts else ""

    def _basis(self) -> str:
        """Return which model the ranking is from, and what its confidence holds."""
        if not is_estimated(self.data, "friction"):
            return "chain of sine waves, without an interval: not all of the surfaces were measured"
        answer = "direct contact of the measured surface × its factors"
        if not np.isfinite(self.data["friction_ratio_low"].values).any():
            return f"{answer}; no interval: a surface is too short to stand for the whole"
        if self.dim == "surface":
            return f"{answer}; the errors of the surfaces are independent"
        return f"{answer}; errors that all have in common cancel"

    def cards(self) -> Iterator[Card]:
        """Yield the friction of each by rank."""
        details = [*(self._over(*step) for step in pairwise(self.friction)), ""]
        for (name, mu), detail in zip(self.friction.items(), details, strict=True):
            yield Card(f"μ of {name}", significant(mu), detail)

    def table(self) -> Table:
        """Return the answers by rank, each with its friction over that of the next."""
        order = [*self.friction, *(name for name in self.names if name not in self.friction)]
        ranked, about = self.data.sel({self.dim: order}), {"symbol": "μ over the next"}
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


class Surfaces(SideBySide):
    """Several surfaces under the rubber and the load of a case."""

    kind = "surfaces"
    dim = "surface"

    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength, and correlation and spectrum."""
        from gripscale.questions.vary.charts import road_pictures

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
        from gripscale.questions.vary.charts import compound_pictures

        yield from compound_pictures(self.data, self.rubbers)
