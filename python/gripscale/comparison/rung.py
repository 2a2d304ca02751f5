"""What a rung of the ladder is: a model, what it changes, and the surfaces it is tried on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from gripscale.conditions.conditions import Conditions
from gripscale.model import Model, NominalLoad
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Measured, PreparedSurface, Profile
from gripscale.theory.models import KlueppelHeinrich
from gripscale.wave.solver import WaveSolver


@dataclass(frozen=True, eq=False)
class Subject:
    """What the models are compared over, and how finely.

    Parameters
    ----------
    rubber, surface, load
        What slides on what, how hard and how fast.
    solver : WaveSolver
        What solves one wave of the chain, as the case says.
    seeds : int
        Random phases drawn of each surface.
    tolerance : float
        Estimated relative error of each direct contact.
    klueppel_heinrich : KlueppelHeinrich, optional
        That theory with its fitted parameters; without them it says nothing.
    pressure_classes : int
        In how many classes of equal load the chain hands its pressure down, as the case says.
    conditions : Conditions, optional
        What changes the rubber. Chain and direct contact know all of it, every other model only the
        temperature.
    """

    rubber: Rubber
    surface: PreparedSurface
    load: NominalLoad
    solver: WaveSolver
    seeds: int = 3
    tolerance: float = 0.05
    klueppel_heinrich: KlueppelHeinrich | None = None
    pressure_classes: int = 1
    conditions: Conditions | None = None

    @property
    def rubber_before(self) -> Rubber:
        """The rubber at the temperature before the contact, for models that know no more."""
        return self.rubber if self.conditions is None else self.conditions.before(self.rubber)

    def rubber_for(self, model: Model) -> Rubber:
        """Return the rubber as measured for a model with conditions, else `rubber_before`."""
        knows = getattr(model, "conditions", None) is not None
        return self.rubber if knows else self.rubber_before


class Draw(NamedTuple):
    """One sample of a rung: a model to ask, and on which surface."""

    model: Model
    surface: PreparedSurface
    of: str = ""
    """What it is a sample of, such as a profile; samples of the same are compared in pairs."""


@dataclass(frozen=True)
class Rung:
    """One model of the ladder.

    Parameters
    ----------
    name : str
        Word for it in result files.
    label : str
        In words, for tables and figures.
    group : str
        Which rungs it belongs with, so that they can be asked for together.
    change : str
        What changes from the rung it follows, in words; empty where there is none.
    follows : str
        Name of the rung it is compared with; empty for none.
    draws : callable
        From a `Subject` to its samples; none where the model has nothing to say of it.
    """

    name: str
    label: str
    group: str
    change: str
    follows: str
    draws: Callable[[Subject], Sequence[Draw]] = field(repr=False)


def only(surface: PreparedSurface, measured: Profile | HeightMap) -> PreparedSurface:
    """Return the waves of `surface` with nothing else measured."""
    whole = measured if isinstance(measured, HeightMap) else [measured]
    return PreparedSurface(surface.sines, measured.name, measured=Measured.of(whole))
