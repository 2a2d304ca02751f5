"""Roads under one rubber and one load."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.case import Case
from gripscale.core.arrays import Array
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.solve import OnTask
from gripscale.questions.vary.inputs import READING, reading_notes, surface_of
from gripscale.questions.vary.ranking import ranked_answers, require_some
from gripscale.questions.vary.side_by_side import Roads
from gripscale.questions.vary.study import Study
from gripscale.surface import Surface, profile_spectrum
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, with_profile
from gripscale.surface.texture import textures

_PER_DECADE = 12
"""Lags and wavenumbers at which roads are drawn together."""


def compare_surfaces(
    case: Case,
    surfaces: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Roads:
    """Rank several roads under the rubber of a case by the friction of their answers.

    Parameters
    ----------
    case : Case
        Rubber, load and conditions; without measured surfaces also the solver of the chain.
    surfaces
        Two to six roads by what they are called: a `Surface`, a `SineStack`, "case", or a surface
        known by name.
    folder : path, optional
        Keeps each answer as soon as it is there: what was interrupted resumes.
    workers, on_task
        As for `gripscale.experiment.solve_all`.

    Returns
    -------
    Roads
        Over `surface` the numbers of the answer and the texture (`gripscale.surface.texture`); over
        `surface` and `over` the ratio of their frictions and so on
        (`gripscale.questions.vary.ranking.RANKED`); friction by octave of wavelength,
        `octave_friction`; `correlation` over `lag` and `spectrum` over `wavenumber`.

    Raises
    ------
    InputError
        If there are fewer than two or more than six roads, or one is not known.
    """
    require_some("surfaces", surfaces, "roads")
    roads = {
        # a synthetic road with its profile, for the direct contact
        name: with_profile(value)
        if isinstance(value, str) and value in SYNTHETIC_SURFACES
        else surface_of(value, case)
        for name, value in surfaces.items()
    }
    study = Study(case, {"surface": roads}, static=False)
    data = ranked_answers(study, folder, workers, on_task)
    waves = [f"{name} was not measured" for name, road in roads.items() if road.measured is None]
    heights = {
        name: road.measured.heights if road.measured else None for name, road in roads.items()
    }
    data = data.assign(textures(heights, "surface")).assign(_measured(roads))
    return Roads(
        data.assign_attrs(
            title="Roads under one rubber, by friction",
            **{READING: "\n".join([*reading_notes(surfaces.values()), *waves])},
        )
    )


def _measured(surfaces: Mapping[str, Surface]) -> dict[str, Any]:
    """Return height difference correlation and spectrum of the roads that were measured.

    At common places, NaN beyond the ends of each.
    """
    curves: dict[str, dict[str, tuple[Array, Array]]] = {"correlation": {}, "spectrum": {}}
    for name, surface in surfaces.items():
        if surface.correlation is not None:
            curves["correlation"][name] = (surface.correlation.lag, surface.correlation.value)
        if surface.measured is not None:
            spectrum = profile_spectrum(surface.measured.followed).averaged()
            curves["spectrum"][name] = (spectrum.wavenumber, spectrum.density)
    out: dict[str, Any] = {}
    for name, axis, unit, units, text in (
        ("correlation", "lag", "m", "m2", "height difference correlation C_z"),
        ("spectrum", "wavenumber", "rad/m", "m3", "one-sided power spectrum of lines"),
    ):
        if not curves[name]:
            continue
        low, high = (pick(float(pick(x)) for x, _ in curves[name].values()) for pick in (min, max))
        places = np.geomspace(low, high, max(2, int(_PER_DECADE * np.log10(high / low)) + 1))
        values = np.full((len(surfaces), places.size), np.nan)
        for road, (x, y) in curves[name].items():
            good = (x > 0.0) & (y > 0.0)
            logs = np.interp(np.log(places), np.log(x[good]), np.log(y[good]), np.nan, np.nan)
            values[list(surfaces).index(road)] = np.exp(logs)
        out[name] = (("surface", axis), values, variable_attributes(text, units))
        out[axis] = (axis, places, variable_attributes(axis, unit))
    return out
