"""Compounds on one road, or roads under one rubber, ranked by the friction of the answer.

Every pair has the ratio of their frictions with its interval, and the confidence that one lies over
the other (`gripscale.questions.vary.friction_ratio`). Where a surface was not measured all answers
are those of the chain, whose errors nobody knows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.charts.draw import Picture
from gripscale.charts.style import power_of_ten
from gripscale.core import Array, InputError, celsius
from gripscale.core.finding import sentences
from gripscale.core.units import MILLI, ZERO_CELSIUS
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Column, Table, significant
from gripscale.model import input_doubts, input_doubts_of
from gripscale.questions import view
from gripscale.questions.answer.variables import believed, is_estimated
from gripscale.questions.inputs.charts_of_rubber import compound_moduli_figure
from gripscale.questions.inputs.page import rubbers_of, texture_table
from gripscale.questions.vary import inputs
from gripscale.questions.vary.charts import ranking_figure, roads_statistics_figure
from gripscale.questions.vary.friction_ratio import RANKED, FrictionRatio, answer_ratio
from gripscale.questions.vary.question import Variation
from gripscale.questions.vary.study import Study, study_numbers
from gripscale.report.elements import Card
from gripscale.rubber import Rubber, temperature_doubts
from gripscale.surface import Surface, profile_spectrum
from gripscale.surface.surface import SURFACE_KIND
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, with_profile
from gripscale.surface.texture import textures

TEMPERATURE = "temperature_K"  # attribute of compounds: the temperature all of them hold for [K]
READING_NOTES = "reading_notes"  # attribute: how inputs were read, a line each
_SAME = 0.5  # temperatures that differ by less are one [K]: 20 °C and 293 K
_PER_DECADE = 12  # lags and wavenumbers at which roads are drawn together
_RANKING = (
    "Friction over that of the first, with the 90 % interval of the ratio, and μ below it; "
    "friction of all waves down to each wavelength"
)
# Confidence from which one lies over another, as outside of a two-sided 90 % interval.
SIGNIFICANT = 0.95


def percent_sure(confidence: float) -> str:
    """Return a confidence in per cent."""
    return "> 99 %" if confidence > 0.995 else f"{100.0 * confidence:.0f} %"


class SideBySide(Variation):
    """Answers of several surfaces or compounds, read by the rank of their friction."""

    dim: ClassVar[str]  # dimension of what stands side by side

    @property
    def names(self) -> list[str]:
        return [str(name) for name in self.data[self.dim].values]

    @cached_property
    def friction(self) -> dict[str, float]:
        """Friction of each that has any [-], the largest first."""
        values = self.data[view.answers(self.data)[0]].transpose(self.dim).values
        each = {name: float(mu) for name, mu in zip(self.names, values, strict=True) if mu > 0.0}
        return dict(sorted(each.items(), key=lambda item: -item[1]))

    @property
    def title(self) -> str:
        return f"{self.noun.capitalize()}s side by side: {', '.join(self.names)}"

    def _of_pair(self, name: str, high: str, low: str) -> float:
        return float(self.data[name].sel({self.dim: high, "over": low}))

    def _over(self, high: str, low: str) -> str:
        confidence = self._of_pair("confidence", high, low)
        sure = "" if math.isnan(confidence) else f" ({percent_sure(confidence)} sure)"
        if confidence < SIGNIFICANT:
            sure = f" ({percent_sure(confidence)}: no significant difference)"
        return f"over {low} {significant(self.friction[low])}{sure}"

    @property
    def lines(self) -> Sequence[str]:
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

    def parts(self) -> Iterator[str | Table]:
        yield self.table()
        if "rms_height" in self.data:
            yield texture_table(self.data, self.dim, self.noun)
        notes = str(self.data.attrs.get(READING_NOTES, "")).splitlines()
        yield from (f"note: {note}" for note in notes)


class Surfaces(SideBySide):
    """Several surfaces under the rubber and the load of a case."""

    kind = "surfaces"
    dim = "surface"

    @property
    def noun(self) -> str:
        return str(self.data.attrs.get(SURFACE_KIND, "surface"))

    def pictures(self) -> Iterator[Picture]:
        yield Picture(
            "roads_friction",
            ranking_figure(self.data, self.dim),
            f"{_RANKING}.",
            "A point with an interval and a curve for each surface, rising towards short waves.",
        )
        if {"correlation", "spectrum"} <= {*self.data}:
            yield Picture(
                "roads_statistics",
                roads_statistics_figure(self.data),
                "Height difference correlation and spectrum of each surface.",
                "Two panels of curves, one for each surface.",
            )


class Compounds(SideBySide):
    """Several compounds on the surface and under the load of a case."""

    kind = "compounds"
    dim = "rubber"
    noun = "compound"

    @property
    def rubbers(self) -> dict[str, Rubber]:
        """The compounds as they were solved, at one temperature; without strain energy."""
        return dict(zip(self.names, rubbers_of(self.data), strict=False))

    def pictures(self) -> Iterator[Picture]:
        yield Picture(
            "compound_friction",
            ranking_figure(self.data, self.dim),
            f"{_RANKING}; and up to each relaxation time, split as at small strain.",
            "A point with an interval and two curves for each compound, rising towards short waves "
            "and long times.",
        )
        yield Picture(
            "compound_moduli",
            compound_moduli_figure(self.rubbers),
            "Storage modulus and loss factor of each compound, dashed beyond the measurement.",
            "Two panels of curves over the frequency, one curve for each compound.",
        )


def compare_compounds(
    case: Case,
    rubbers: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    temperature: float | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Compounds:
    """Rank several compounds on the road of a case by the friction of their answers.

    Returns over `rubber` the numbers of the answer; over `rubber` and `over` the ratio of their
    frictions and so on (`gripscale.questions.vary.friction_ratio.RANKED`); friction by octave of
    wavelength, `octave_friction`, and by decade of relaxation time, `friction_by_decade`.

    Raises `InputError` if there are fewer than two or more than six compounds, or they cannot be
    brought to one temperature.

    Parameters
    ----------
    case : Case
        Surface, load and conditions; without a measured surface also the solver of the chain.
    rubbers
        The compounds by what they are called: a `Rubber`, a `MeasuredRubber`, "case", or a rubber
        known by name.
    folder : path, optional
        Keeps each answer as soon as it is there: what was interrupted resumes.
    temperature : float, optional
        Where they are compared [K]; by default the temperature of the case's conditions, or one
        all of them have or can be shifted to.
    workers, on_task
        As for `gripscale.experiment.Bench`.
    """
    require_some("rubbers", rubbers, "compounds")
    measured = {name: inputs.measured_rubber_of(value, case) for name, value in rubbers.items()}
    if temperature is None and case.conditions is not None:
        temperature = case.conditions.temperature
    compounds = {name: each.rubber for name, each in measured.items()}
    together, notes = at_one_temperature(compounds, temperature)
    model = inputs.model_of(inputs.default_model(case), case)
    if isinstance(model, inputs.AnswerModel):
        model = replace(model, compared=True)
    study = Study(case, {"rubber": together}, model=model)
    data = ranked_answers(study, folder, workers, on_task)
    loads = [point.task.load for point in study.points]
    kelvins = [rubber.reference_temperature for rubber in together.values()]
    data = data.assign_attrs(
        input_doubts(
            [*study.surfaces, *measured.values()], loads, case.units, case.softening_doubts
        ),
        title="Compounds on one surface, by friction",
        **{READING_NOTES: "\n".join([*inputs.reading_notes(rubbers.values()), *notes])},
        **({TEMPERATURE: kelvins[0]} if None not in kelvins and len({*kelvins}) == 1 else {}),
    )
    return Compounds(data)


def compare_surfaces(
    case: Case,
    surfaces: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Surfaces:
    """Rank several surfaces under the rubber of a case by the friction of their answers.

    Returns over `surface` the numbers of the answer and the texture (`gripscale.surface.texture`);
    ratios of friction and `octave_friction` as `compare_compounds`; `correlation` over `lag` and
    `spectrum` over `wavenumber`.

    Raises `InputError` if there are fewer than two or more than six surfaces, or one is not known.

    Parameters
    ----------
    case : Case
        Rubber, load and conditions; without measured surfaces also the solver of the chain.
    surfaces
        The surfaces by what they are called: a `Surface`, a `SineStack`, "case", or one known by
        name.
    folder, workers, on_task
        As for `compare_compounds`.
    """
    require_some("surfaces", surfaces, "surfaces")
    roads = {
        # a synthetic road with its profile, for the direct contact
        name: with_profile(value)
        if isinstance(value, str) and value in SYNTHETIC_SURFACES
        else inputs.surface_of(value, case)
        for name, value in surfaces.items()
    }
    data = ranked_answers(Study(case, {"surface": roads}), folder, workers, on_task)
    waves = [f"{name} was not measured" for name, road in roads.items() if road.measured is None]
    heights = {
        name: road.measured.heights if road.measured else None for name, road in roads.items()
    }
    data = data.assign(textures(heights, "surface")).assign(_statistics(roads))
    notes = "\n".join([*inputs.reading_notes(surfaces.values()), *waves])
    title = "Surfaces under one rubber, by friction"
    return Surfaces(data.assign_attrs(title=title, **{READING_NOTES: notes}))


def at_one_temperature(
    rubbers: Mapping[str, Rubber], temperature: float | None = None
) -> tuple[dict[str, Rubber], tuple[str, ...]]:
    """Return rubbers that hold for one temperature, and what is to be said of that.

    Without a `temperature` it is that of the rubbers which cannot be shifted, or else of the first
    that states one [K]. A rubber whose temperature is not known stays as it is, which is said.

    Returns the rubbers, and a sentence for each that was shifted and for what is doubtful
    (`gripscale.rubber.temperature_doubts`). Raises `InputError` if a rubber would have to be
    shifted and has no shift.
    """
    temperatures = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    if temperature is None:
        fixed = [kelvin for name, kelvin in temperatures.items() if rubbers[name].shift is None]
        temperature = next(iter([*fixed, *temperatures.values()]), math.nan)
    together, shifted = dict(rubbers), []
    for name, kelvin in temperatures.items():
        if abs(kelvin - temperature) <= _SAME:
            continue
        before, target = celsius(kelvin, ".1f"), celsius(temperature, ".1f")
        if rubbers[name].shift is None:
            raise InputError(
                f"{name} holds for {before} and cannot be brought to {target}: give it a shift, or "
                "leave it out"
            )
        together[name] = rubbers[name].at(temperature)
        shifted.append(f"{name} shifted from {before} to {target}")
    return together, (*shifted, *temperature_doubts(together))


def require_some(name: str, mapping: Mapping[str, Any], what: str) -> None:
    """Raise `InputError` unless there are two to six things to be compared."""
    if len(mapping) not in range(2, 7):
        raise InputError(f"{name} must be 2 to 6 {what} to be compared; got {len(mapping)}")


def ranked_answers(
    study: Study, folder: str | Path | None, workers: int | None, on_task: OnTask | None
) -> xr.Dataset:
    """Return the answers of a study over `rubber` or `surface`, with `RANKED` of each pair."""
    with bench_in(folder, workers, None, on_task) as bench:
        data = study.assemble(bench.solve(study.design.tasks, study_numbers))
    (dim,) = study.design.sizes
    names = data[dim].values
    friction = believed(data, "friction")
    numbers = data[friction].transpose(dim).values
    values = np.full((len(RANKED), names.size, names.size), np.nan)
    for i, j in np.ndindex(names.size, names.size):
        if numbers[i] > 0.0 and numbers[j] > 0.0:
            over, under = data.isel({dim: i}), data.isel({dim: j})
            ratio = FrictionRatio(0.0, 0.0) if i == j else answer_ratio(over, under, friction)
            values[:, i, j] = math.exp(ratio.log_ratio), *ratio.interval, ratio.confidence
    columns = {
        name: ((dim, "over"), part, variable_attributes(text))
        for (name, text), part in zip(RANKED.items(), values, strict=True)
    }
    return data.assign_coords(over=("over", names)).assign(columns)


def _statistics(surfaces: Mapping[str, Surface]) -> dict[str, Any]:
    """Return height difference correlation and spectrum of the roads that were measured.

    At common places, NaN beyond the ends of each.
    """
    correlations, spectra = dict[int, tuple[Array, Array]](), dict[int, tuple[Array, Array]]()
    for at, surface in enumerate(surfaces.values()):
        if surface.correlation is not None:
            correlations[at] = surface.correlation.lag, surface.correlation.value
        if surface.measured is not None:
            spectrum = profile_spectrum(surface.measured.followed).averaged()
            spectra[at] = spectrum.wavenumber, spectrum.density
    out: dict[str, Any] = {}
    for name, curves, axis, unit, units, text in (
        ("correlation", correlations, "lag", "m", "m2", "height difference correlation C_z"),
        ("spectrum", spectra, "wavenumber", "rad/m", "m3", "one-sided power spectrum of lines"),
    ):
        if not curves:
            continue
        low, high = (pick(float(pick(x)) for x, _ in curves.values()) for pick in (min, max))
        places = np.geomspace(low, high, max(2, int(_PER_DECADE * np.log10(high / low)) + 1))
        values = np.full((len(surfaces), places.size), np.nan)
        for at, (x, y) in curves.items():
            good = (x > 0.0) & (y > 0.0)
            logs = np.interp(np.log(places), np.log(x[good]), np.log(y[good]), np.nan, np.nan)
            values[at] = np.exp(logs)
        out[name] = (("surface", axis), values, variable_attributes(text, units))
        out[axis] = (axis, places, variable_attributes(axis, unit))
    return out
