"""The direct contact with the derivatives of its friction by every input.

The profiles of a surface add their friction by length. With m_k the share of profile k in it,

    d ln mu = sum_k m_k d ln mu_k,

on the grid with four points in the smallest wave (docs/sensitivity.md has its errors). Where
softening or heat change the rubber with the contact there are two derivatives: with the rubber of
every scale kept, from one adjoint solution; and with its answer to the change, of speed, pressure
and temperature, from differences of whole solutions.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import xarray as xr

from gripscale.core import ZERO_CELSIUS, checked, checks
from gripscale.experiment.design import (
    CONVERGED,
    basis_numbers,
    surface_numbers,
    variable_attributes,
)
from gripscale.experiment.task import Task
from gripscale.half_space.location import contact_trace, trace_variables, with_traces
from gripscale.half_space.model import DirectContact
from gripscale.half_space.sensitivity import TEXTS, contact_sensitivity
from gripscale.model import STATUS
from gripscale.questions.vary.friction_ratio import answer_with_contacts
from gripscale.questions.vary.inputs import conditions_of

if TYPE_CHECKING:
    from gripscale.model import Load, OnProgress
    from gripscale.rubber import Rubber
    from gripscale.surface import Surface

STORAGE, LOSS = "d_ln_friction_d_ln_storage", "d_ln_friction_d_ln_loss"
# End of the names of derivatives with the rubber's answer to the change.
FEEDBACK = "_with_feedback"
# Of the differences of whole solutions: ln v, ln p_0, and temperature [K]. The friction of a grid
# bends where an asperity comes into contact; smaller steps are single asperities.
LOG_STEP, KELVIN_STEP = 0.1, 2.0

# Derivatives with the number that they are of; none by Prony terms, which rubbers do not share.
_DERIVATIVES = {
    f"d_ln_{quantity}_d_{name}{end}": quantity
    for quantity in ("friction", "contact_fraction")
    for name in TEXTS.keys() - {"ln_modulus"}
    for end in ("", FEEDBACK)
}

# Rules of thumb of tread compounds: tan(delta) at these temperatures [K] and `RULE_FREQUENCY`.
# M.-J. Wang, Rubber Chem. Technol. 71 (1998) 520, doi:10.5254/1.3538492.
_RULES = {"wet grip": ZERO_CELSIUS, "rolling resistance": ZERO_CELSIUS + 60.0}
RULE_FREQUENCY = 10.0  # [Hz]
# Frequencies of the master curve beside the derivatives, and how far it goes beyond them.
MASTER_POINTS, _MARGIN = 200, 30.0


class FrictionSensitivity(DirectContact):
    """Direct contact whose answer holds the derivatives of its friction over `frequency`.

    The frequencies are shifted to the temperature of the rubber as it is handed over. The other
    fields are those of `DirectContact` and arguments of `contact_sensitivity`.
    """

    name: ClassVar[str] = "sensitivity"

    tolerance: float | None = None
    bands_per_decade: int = checked(checks.whole, least=1, most=100, default=4)
    contact_fraction: bool = checked(checks.flag, default=False)
    with_feedback: bool = checked(checks.flag, default=False)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer with the derivatives; without any if the contact has no result."""
        answer, contacts = answer_with_contacts(self, rubber, surface, load, on_progress)
        if answer[STATUS].item() != CONVERGED:
            return answer
        shifted_to = None if rubber.shift is None else rubber.reference_temperature
        parts = [
            contact_sensitivity(
                contact,
                bands_per_decade=self.bands_per_decade,
                contact_fraction=self.contact_fraction,
                reference_temperature=shifted_to,
            )
            for contact in contacts
        ]
        answer = answer.merge(_of_all(parts, [contact.grid.lengths[0] for contact in contacts]))
        if self.traces:
            relative = [(part.d_friction_d_height / part.friction).values for part in parts]
            pairs = zip(contacts, relative, strict=True)
            answer = with_traces(answer, [contact_trace(c, derivative=d) for c, d in pairs])
        if self.with_feedback and self.conditions is not None and self.conditions.iterated:
            answer = answer.assign(self._with_feedback(rubber, surface, load))
        return answer

    def _with_feedback(
        self, rubber: Rubber, surface: Surface, load: Load
    ) -> dict[str, xr.Variable]:
        """Return derivatives from differences of whole solutions."""
        conditions = conditions_of(self)
        kelvin = conditions.temperature_of(rubber)

        def log_friction(name: str, by: float) -> float:
            model: DirectContact = self
            changed = load
            if name == "temperature":
                assert kelvin is not None  # without it there is no difference
                model = self.with_conditions(replace(conditions, temperature=kelvin + by))
            else:
                changed = replace(load, **{name: getattr(load, name) * math.exp(by)})
            answer = DirectContact.predict(model, rubber, surface, changed)
            return math.log(float(answer["total_friction_from_dissipation"]))

        steps = {"speed": LOG_STEP, "pressure": LOG_STEP}
        if kelvin is not None and rubber.shift is not None:
            steps["temperature"] = KELVIN_STEP
        derivatives = {}
        for name, step in steps.items():
            low, high = (log_friction(name, by) for by in (-step, step))
            end, unit = (name, "1/K") if name == "temperature" else (f"ln_{name}", "1")
            about = variable_attributes(f"d ln friction by {end}, with the rubber's answer", unit)
            value = xr.Variable((), (high - low) / (2.0 * step), about)
            derivatives[f"d_ln_friction_d_{end}{FEEDBACK}"] = value
        return derivatives


def _of_all(parts: list[xr.Dataset], lengths: list[float]) -> xr.Dataset:
    """Return the derivatives that profiles of these lengths [m] have together."""
    names = [str(name) for name in parts[0] if name in _DERIVATIVES]
    every = xr.concat([part[names] for part in parts], "profile", join="outer", fill_value=0.0)
    out = {}
    for name in names:
        amounts = np.array(lengths) * [float(part[_DERIVATIVES[name]]) for part in parts]
        weight = xr.DataArray(amounts / amounts.sum(), dims="profile")
        mean = (weight * every[name]).sum("profile", skipna=False)
        out[name] = mean.assign_attrs(parts[0][name].attrs)
    return xr.Dataset(out)


def derivatives_of_answer(answer: xr.Dataset, task: Task) -> xr.Dataset:
    """Return the numbers of the whole surface, and the derivatives."""
    kept = [*(name for name in answer if name in _DERIVATIVES), *trace_variables(answer)]
    numbers = surface_numbers(answer, task).assign(basis_numbers(answer))
    return numbers.assign(answer[kept].variables)


def with_rules_of_thumb(data: xr.Dataset, rubber: Rubber) -> xr.Dataset:
    """Return the Dataset with the master curve of its rubber, and the rules of thumb on it."""
    shift, reference = rubber.shift, rubber.reference_temperature
    names, at = list[str](), np.empty(0)
    if shift is not None and reference is not None:  # the rules within the shift
        low, high = shift.limits
        names = [name for name, kelvin in _RULES.items() if low <= kelvin <= high]
        kelvins = np.array([_RULES[name] for name in names])
        at = 2.0 * np.pi * RULE_FREQUENCY * shift.a(kelvins, reference)
    drawn = np.array([*data.frequency.values, *at])
    omega = np.geomspace(drawn.min() / _MARGIN, drawn.max() * _MARGIN, MASTER_POINTS)
    modulus = rubber.complex_modulus(omega)
    about = variable_attributes("angular frequency of the master curve", "rad/s")
    data = data.assign_coords(modulus_frequency=("modulus_frequency", omega, about)).assign(
        storage_modulus=("modulus_frequency", modulus.real, variable_attributes("E'", "Pa")),
        loss_modulus=("modulus_frequency", modulus.imag, variable_attributes("E''", "Pa")),
    )
    if not at.size:
        return data
    effect, distance = data[LOSS], np.abs(np.log10(data.frequency.values[:, None] / at))
    near = xr.DataArray(distance <= 0.5, dims=("frequency", "rule"))
    share = (effect * near).sum("frequency") / effect.sum("frequency")
    text = f"angular frequency of tan(delta) at {RULE_FREQUENCY:g} Hz, shifted"
    return data.assign_coords(rule=("rule", names)).assign(
        rule_frequency=("rule", at, variable_attributes(text, "rad/s")),
        rule_share=share.assign_attrs(
            variable_attributes("share of the effect of E'' within half a decade")
        ),
    )
