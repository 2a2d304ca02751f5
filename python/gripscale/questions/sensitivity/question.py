"""What decides the friction: which part of the master curve, and which other input.

result = gs.sensitivity(case, vary={"speed": [0.003, 0.3, 30.0]})
result.data.d_ln_friction_d_ln_loss.sum("frequency")
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import xarray as xr

from gripscale.case import Case
from gripscale.core import checks, provenance
from gripscale.core.errors import InputError
from gripscale.core.finding import Finding, Topic, doubt
from gripscale.experiment.design import solve_design
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sensitivity import contact_sensitivity
from gripscale.io.table import Table
from gripscale.questions.answer.findings import case_notices
from gripscale.questions.inputs import record
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.result import Result
from gripscale.questions.sensitivity import page
from gripscale.questions.sensitivity.friction_sensitivity import (
    CARRIED,
    LOSS,
    STORAGE,
    FrictionSensitivity,
    derivatives_of_answer,
    with_rules_of_thumb,
)
from gripscale.questions.uncertainty.first_order import CARRIED_QUANTITIES, first_order
from gripscale.questions.uncertainty.sampling import stated_options
from gripscale.questions.vary.axis import axes_of
from gripscale.questions.vary.inputs import reading_notes
from gripscale.questions.vary.study import Study, coordinates
from gripscale.report.elements import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DERIVED_OVER = ("speed", "pressure", "temperature", "smallest_wavelength", "rubber", "surface")
"""What may be varied: derivatives are taken at each value."""


class Sensitivity(Result):
    """The derivatives of the friction of a case by all of its inputs."""

    kind = "sensitivity"

    @property
    def lines(self) -> Sequence[str]:
        """What more loss and less stiffness give, and where on the master curve that is."""
        return tuple(page.sensitivity_lines(self.data))

    @property
    def findings(self) -> Sequence[Finding]:
        """What may change the derivatives, the most important first."""
        return tuple(case_notices(None, InputRecord(self.inputs)))

    @property
    def failure(self) -> str:
        """Which points have no solution; empty if all have one."""
        return page.failure_sentence(self.data)

    def parts(self) -> Iterator[str | Table]:
        """Yield the sums, what each decade is worth, errors of inputs, and rules of thumb."""
        yield from page.sensitivity_parts(self.data)

    def table(self) -> Table:
        """Return the derivatives by each input, the moduli summed over frequency."""
        return page.sums_table(self.data)

    def figures(self) -> Iterator[tuple[str, Figure]]:
        """Yield the derivatives over the master curve, then by heights of each profile."""
        from gripscale.questions.sensitivity.charts import height_pictures, sensitivity_figure

        if STORAGE in self.data:
            yield "sensitivity", sensitivity_figure(self.data)
            for picture in height_pictures(self.data, self.inputs):
                yield picture.name, picture.figure

    def page_content(self) -> Page:
        """Return the derivatives by each input, over the master curve and by heights."""
        return page.sensitivity_page(self.data, self.inputs, self.findings)


@overload
def sensitivity(
    subject: RoughContact,
    *,
    bands_per_decade: int | None = ...,
    contact_fraction: bool = ...,
    reference_temperature: float | None = ...,
) -> xr.Dataset: ...


@overload
def sensitivity(
    subject: Case,
    *,
    vary: Mapping[str, Any] | None = ...,
    bands_per_decade: int | None = ...,
    contact_fraction: bool = ...,
    with_feedback: bool = ...,
    folder: str | Path | None = ...,
    workers: int | None = ...,
    on_task: OnTask | None = ...,
) -> Sensitivity: ...


def sensitivity(
    subject: Case | RoughContact,
    *,
    vary: Mapping[str, Any] | None = None,
    bands_per_decade: int | None = None,
    contact_fraction: bool = False,
    with_feedback: bool = False,
    reference_temperature: float | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Sensitivity | xr.Dataset:
    """Return the derivatives of the friction of a case, or of one direct contact.

    Parameters
    ----------
    subject : Case or RoughContact
        A case in motion with a measured surface, or a contact of `gripscale.solve_rough_contact`.
        A contact takes `bands_per_decade`, `contact_fraction` and `reference_temperature` only.
    vary : mapping, optional
        One or two of `DERIVED_OVER`, as for a `Study`: the derivatives at each value.
    bands_per_decade : int, optional
        Bands of frequency in a decade; 4 of a case, 2 of a contact by default.
    contact_fraction : bool
        Also the derivatives of the contact fraction, from four further contacts a band.
    with_feedback : bool
        With softening or heat, also derivatives by speed, pressure and temperature with the answer
        of the rubber: six further solutions.
    reference_temperature : float, optional
        Temperature that the frequencies of a contact are shifted to [K].
    folder : path, optional
        Keeps each solution as soon as it is there: what was interrupted resumes.
    workers, on_task
        As for `gripscale.experiment.Bench`.

    Returns
    -------
    Sensitivity
        Over what is varied: the variables of `gripscale.half_space.contact_sensitivity` but for the
        heights, over `frequency` at the temperature of the master curve. Those with the end
        `_with_feedback` hold the answer of softening and heat. `storage_modulus` and
        `loss_modulus` [Pa] of the master curve over `modulus_frequency` [rad/s]; with a shift, over
        `rule`, the frequency that each rule of thumb stands for, and the share of the effect of E''
        within half a decade of it. Where nothing is varied, `source_friction_error` and
        `source_contact_fraction_error` over `source`: the relative standard errors that unknown
        inputs carry to friction and contact area (`first_order`), and the derivatives by height in
        the traces of the profiles (`gripscale.half_space.location.traces_of`).
    xarray.Dataset
        Of a contact, see `gripscale.half_space.contact_sensitivity`.

    Raises
    ------
    InputError, FileError
        For what cannot be used; if the case is at rest, or has no measured surface.
    """
    if not isinstance(subject, Case):
        return contact_sensitivity(
            subject,
            bands_per_decade=2 if bands_per_decade is None else bands_per_decade,
            contact_fraction=contact_fraction,
            reference_temperature=reference_temperature,
        )
    case = subject
    bands = 4 if bands_per_decade is None else bands_per_decade
    axes = {"speed": [case.load.speed]} if vary is None else dict(vary)
    for axis in axes_of(axes):
        checks.one_of("vary", axis.name, DERIVED_OVER)
        if axis.name == "speed" and min(axis.values) <= 0.0:
            raise InputError("speed must be above zero for derivatives of friction; got 0 m/s")
    conditions = case.chain.conditions
    model = FrictionSensitivity(
        conditions=conditions,
        bands_per_decade=bands,
        contact_fraction=contact_fraction,
        with_feedback=with_feedback,
        traces=vary is None,
    )
    study = Study(case, axes, static=False, model=model)
    with bench_in(folder, workers, None, on_task) as bench:
        data = solve_design(study.design, bench, derivatives_of_answer)
    data = data.assign_coords(coordinates(study.axes, case.units))
    if STORAGE in data:
        if vary is None:
            errors = first_order(case, seed=stated_options(case).seed)
            named = {f"{name}_error": CARRIED.format(name) for name in CARRIED_QUANTITIES}
            data = data.assign(errors.rename(named).variables)
        data = with_rules_of_thumb(data.fillna({STORAGE: 0.0, LOSS: 0.0}), study.rubbers[0])
    attrs = {
        "title": "What decides the friction of a case",
        "case_file": case.origin.name,
        "model": "direct",
        "bands_per_decade": bands,
        "iterated": int(conditions is not None and conditions.iterated),
        **provenance.version_attributes(),
    }
    loads = [point.task.load for point in study.points]
    notes = [doubt(text, topic=Topic.RUBBER) for text in reading_notes(study.measured_rubbers)]
    inputs = record.inputs(case, study.surfaces, loads, notes)
    return Sensitivity(data.assign_attrs(case.attributes, **attrs), inputs)
