"""How a Prony series came about, how well it fits, and what is doubtful about it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber.findings import findings
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import Rubber
from gripscale.rubber.maxwell_fit import Curve
from gripscale.rubber.misfit import Misfit, end_misfits, local_misfits
from gripscale.rubber.outliers import Screening
from gripscale.rubber.term_choice import Candidate

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PronyFit:
    """How a Prony series came about and how well it fits the rows kept."""

    terms: int
    """Maxwell elements with a modulus above zero."""
    candidates: tuple[Candidate, ...] = field(repr=False)
    """Numbers of terms tried and their cross-validation error; empty if the number was given."""
    outlier_frequency: Array
    """Frequencies of the rows left out [Hz]."""
    outlier_storage_deviation: Array = field(repr=False)
    """Their log deviation in E' from the local trend [-]."""
    outlier_loss_deviation: Array = field(repr=False)
    """The same in E''."""
    rms_storage: float
    """Root mean square of E'_fit/E' - 1 [-]."""
    rms_loss: float
    """Root mean square of E''_fit/E'' - 1 [-]."""
    rms_loss_factor: float
    """Root mean square relative error of E''/E' [-]."""
    mean_loss_factor_error: float
    """Mean relative error of E''/E', negative where the fit is less lossy than measured [-]."""
    storage_scatter: float
    """Robust relative scatter of the measured E' about its local trend [-]."""
    loss_scatter: float
    """The same of E''."""
    measured_band: tuple[float, float]
    """Lowest and highest measured angular frequency among the rows kept [rad/s]."""
    inconsistencies: tuple[Misfit, ...] = ()
    """Where E' and E'' break the Kramers-Kronig relation: even the best series misses them."""
    slow_end: Misfit | None = None
    """How the series misses the five slowest rows; None within their scatter."""
    fast_end: Misfit | None = None
    """The same of the five fastest."""
    findings: tuple[str, ...] = ()
    """What is doubtful, a sentence each."""

    @property
    def consistent(self) -> bool:
        """Whether one linear solid has both E' and E'' within about their scatter, everywhere."""
        return not self.inconsistencies

    def summary(self) -> str:
        """Return the report as a few lines of text."""
        low, high = self.measured_band
        lines = [
            f"{self.terms} Maxwell elements for {low:.3g} to {high:.3g} rad/s",
            f"rms relative error: E' {self.rms_storage:.1%}, E'' {self.rms_loss:.1%}, "
            f"loss factor {self.rms_loss_factor:.1%} (mean {self.mean_loss_factor_error:+.1%})",
            f"scatter of the data: E' {self.storage_scatter:.1%}, E'' {self.loss_scatter:.1%}",
        ]
        if self.outlier_frequency.size:
            left_out = ", ".join(f"{frequency:.3g}" for frequency in self.outlier_frequency)
            lines.append(f"left out as outliers [Hz]: {left_out}")
        return "\n".join([*lines, *self.findings])


def report(
    master: MasterCurve,
    rows: Curve,
    screening: Screening,
    candidates: tuple[Candidate, ...],
    rubber: Rubber,
) -> PronyFit:
    """Return the report on `rubber`, fitted to the `rows` of `master` that the screening kept."""
    kept = screening.kept
    modulus = rubber.complex_modulus(rows.omega)
    loss_factor_error = modulus.imag / modulus.real / (rows.loss / rows.storage) - 1.0
    scatter = screening.believed_scatter
    assert rubber.admissible is not None
    best = rubber.admissible.complex_moduli(rows.omega)[0]
    inconsistencies = local_misfits(rows, best, scatter)
    slow, fast = end_misfits(rows, modulus, scatter)
    return PronyFit(
        terms=len(rubber.moduli),
        candidates=candidates,
        outlier_frequency=master.frequency[~kept],
        outlier_storage_deviation=screening.storage_deviation[~kept],
        outlier_loss_deviation=screening.loss_deviation[~kept],
        rms_storage=_rms(modulus.real / rows.storage - 1.0),
        rms_loss=_rms(modulus.imag / rows.loss - 1.0),
        rms_loss_factor=_rms(loss_factor_error),
        mean_loss_factor_error=float(loss_factor_error.mean()),
        storage_scatter=screening.storage_scatter,
        loss_scatter=screening.loss_scatter,
        measured_band=(float(rows.omega[0]), float(rows.omega[-1])),
        inconsistencies=inconsistencies,
        slow_end=slow,
        fast_end=fast,
        findings=findings(rubber, inconsistencies, (slow, fast)),
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
