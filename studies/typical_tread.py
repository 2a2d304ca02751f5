"""The typical tread: mean softening of the treads whose strain sweeps are published.

    python -m studies.typical_tread

Compounds are S100, S120, S140 (sweeps at four temperatures each) and R60 (one sweep, as ratios).
R00 is S100 again. Its ratios are those of S100 at 30 C within 6 % rms, so the ratios of R60 are
taken at 30 C. At each strain

    ln f = (mean of offsets) + (offset of the compound) + slope (T - 25 C)

by least squares over the 13 sweeps, and so for g. The scatter is that of a further compound: its
90 % interval by Student's t, over that of a normal deviate, 1.645. A second.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import stats

from gripscale.core import ZERO_CELSIUS, Array
from gripscale.rubber.softening import STRAIN, SWEPT
from studies.treads import SERIES_S, sweeps, table

RATIOS_AT = 30.0
"""Temperature at which the published ratios are taken [C]."""
RATIOS_TO = 0.15
"""Strain beyond which those of R60 rise again, so that they do not count [-]."""


class Spread(NamedTuple):
    """Logarithms of f and g at each strain; shape (..., 2, strains)."""

    mean: Array
    """At the temperatures of the law; shape (temperatures, 2, strains)."""
    scatter: Array
    """Standard deviation of a compound that is none of these."""
    offsets: Array
    """Of each compound, NaN where it has no sweep; shape (compounds, 2, strains)."""
    compounds: tuple[str, ...]

    @property
    def correlation(self) -> Array:
        """Between ln f and ln g of compounds, at each strain but the ends."""
        f, g = self.offsets[:, 0, 1:-1], self.offsets[:, 1, 1:-1]
        return np.array([np.corrcoef(a, b)[0, 1] for a, b in zip(f.T, g.T, strict=True)])


def ratios(strain: Array, moduli: Array) -> Array:
    """Return ln of moduli, shape (2, rows), over those at the first strain of the law."""
    logs = np.array([np.interp(np.log(STRAIN), np.log(strain), np.log(m)) for m in moduli])
    return np.asarray(logs - logs[:, :1])


def measured() -> list[tuple[str, float, Array]]:
    """Return compound, temperature [C] and logarithms of f and g of each sweep, NaN without."""
    rows = [
        (name, at, ratios(sweep.strain, np.array([sweep.storage, sweep.loss])))
        for name in SERIES_S
        for at, sweep in sweeps(name).items()
    ]
    strain, f, g = table("R60_softening_factors").T
    logs = ratios(strain, np.array([f, g]))
    logs[:, np.array(STRAIN) > RATIOS_TO] = np.nan
    return [*rows, ("R60", RATIOS_AT, logs)]


def spread(without: str = "") -> Spread:
    """Return mean and scatter of the compounds, but one if asked for."""
    rows = [row for row in measured() if row[0] != without]
    names = tuple(dict.fromkeys(name for name, *_ in rows))
    celsius = np.array([at for _, at, _ in rows])
    of_compound = np.array([[float(name == each) for each in names] for name, *_ in rows])
    system = np.column_stack([of_compound, celsius - 25.0])
    values = np.array([logs for *_, logs in rows])
    mean, scatter = (
        np.zeros((len(SWEPT), *values.shape[1:])),
        np.zeros(values.shape[1:]),
    )
    offsets = np.full((len(names), *values.shape[1:]), np.nan)
    for at in np.ndindex(scatter.shape):
        there = np.isfinite(values[:, *at])
        members = of_compound[there].any(axis=0)
        columns = system[there][:, np.append(members, True)]
        *each, slope = np.linalg.lstsq(columns, values[there, *at], rcond=None)[0]
        count = len(each)
        wider = np.sqrt(1.0 + 1.0 / count) * stats.t.ppf(0.95, count - 1) / stats.norm.ppf(0.95)
        mean[:, *at] = np.mean(each) + slope * (np.array(SWEPT) - ZERO_CELSIUS - 25.0)
        scatter[at] = wider * np.std(each, ddof=1)
        offsets[members, *at] = each - np.mean(each)
    return Spread(mean, scatter, offsets, names)


def main() -> None:
    """Print the constants of the module and what they rest on."""
    np.set_printoptions(precision=3, suppress=True, linewidth=100)
    whole = spread()
    for number, name in enumerate(("MEAN_STORAGE", "MEAN_LOSS")):
        rows = [", ".join(f"{np.exp(v):.3f}" for v in at[number]) for at in whole.mean]
        print(f"{name} = (({rows[0]}), ({rows[1]}))")
        print(f"SCATTER of it: {', '.join(f'{v:.3f}' for v in whole.scatter[number])}")
    print("correlation of ln f and ln g", whole.correlation)
    for at, name in enumerate(whole.compounds):
        print(name, "offsets of ln f", whole.offsets[at, 0], "of ln g", whole.offsets[at, 1])
        rest = spread(name)
        away = (whole.mean[0] + whole.offsets[at] - rest.mean[0])[:, 1:] / rest.scatter[:, 1:]
        print("  from the others, over their scatter", away)


if __name__ == "__main__":
    main()
