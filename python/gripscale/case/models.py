"""What a case file may say: its tables together; the large ones have files of their own."""

from __future__ import annotations

from pydantic import Field, model_validator

from gripscale.case.conditions_table import ConditionsTable
from gripscale.case.load_table import Load
from gripscale.case.quantity import Length
from gripscale.case.rubber_table import RubberSource
from gripscale.case.solver_table import ChainOptions, Solver
from gripscale.case.surface_table import Surface
from gripscale.case.table import Table
from gripscale.case.uncertainty_table import UncertaintyTable
from gripscale.rubber.strain_energy import NeoHookean


class Output(Table):
    """Where the results go."""

    folder: str = "results"
    """Folder of the results, from the case file."""


class MeasuredTable(Table):
    """Friction measured elsewhere: a table of speed and friction, drawn over what is predicted."""

    friction: str | None = None
    """A table of speed and friction, drawn over what is predicted."""


class Compare(Table):
    """What `gripscale compare` puts beside the models: fits of a theory."""

    layer_ratio: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    """Thickness of the strained layer over penetration depth, in Klueppel and Heinrich's theory."""
    penetration_depth: Length | None = None
    """Mean penetration depth in that theory."""

    @model_validator(mode="after")
    def _both_or_none(self) -> Compare:
        if (self.layer_ratio is None) != (self.penetration_depth is None):
            raise ValueError(
                "expected layer_ratio and penetration_depth together: Klueppel and Heinrich's "
                "theory needs both"
            )
        return self


class Case(Table):
    """A whole case file."""

    surface: Surface
    """What is slid on."""
    rubber: RubberSource
    """What slides."""
    load: Load
    """How it is pressed and slid."""
    solver: Solver = Solver()
    """What solves one wave."""
    chain: ChainOptions = ChainOptions()
    """What goes on from wave to wave."""
    conditions: ConditionsTable = ConditionsTable()
    """Effects beside the rubber as measured."""
    measured: MeasuredTable = MeasuredTable()
    """Friction measured elsewhere."""
    output: Output = Output()
    """Where results go."""
    compare: Compare = Compare()
    """Further inputs of a comparison."""
    uncertainty: UncertaintyTable = UncertaintyTable()
    """What is not known of all that."""

    @model_validator(mode="after")
    def _energy_of_the_model(self) -> Case:
        if self.solver.model == "half_plane" and self.rubber.strain_energy != NeoHookean():
            raise ValueError(
                "strain_energy of [rubber] has no effect at small strain; expected "
                'model = "finite_strain" with it'
            )
        return self

    def named_files(self) -> list[tuple[str, str]]:
        """Return role and name of every file it names."""
        friction = [self.measured.friction] if self.measured.friction is not None else []
        roles = (
            ("surface", self.surface.measured_files),
            ("rubber", self.rubber.files),
            ("conditions", self.conditions.files),
            ("measured", friction),
        )
        return [(role, name) for role, names in roles for name in names]
