"""How much of the error of a contact area two loads share: pieces of the shipped road.

    python -m studies.shared_error

The deviation e of ln A of each piece from the mean over the pieces is the error of a short
measurement. Of two loads, var(e_1 - e_2) over the mean of both variances is the share that does not
cancel; `gripscale.questions.answer.calibrated` bounds it by |ln(A_1/A_2)|/ln 5.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

import gripscale as gs
from gripscale.questions.answer.calibrated import AREA_FACTOR
from studies.shipped import road, tread

PIECES = 10  # of each station
LOADS = [(1e5, 0.3), (3e5, 0.3), (1e6, 0.3), (3e5, 0.03), (3e5, 3.0), (3e5, 30.0)]  # [Pa], [m/s]


def areas() -> np.ndarray:
    """Return the contact fraction of every piece under every load, shape (pieces, loads)."""
    rubber, rows = tread(), []
    for station in (0, 1):
        line = road(station)
        for index in np.array_split(np.arange(line.x.size), PIECES):
            piece = gs.Profile(line.x[index], line.z[index])
            rows.append(
                [
                    gs.solve_rough_contact(
                        rubber, piece, pressure=pressure, speed=speed, smallest_wavelength=4e-4
                    ).contact_fraction
                    for pressure, speed in LOADS
                ]
            )
    return np.array(rows)


def main() -> None:
    """Print for each pair of loads the share that does not cancel, and its bound."""
    area = areas()
    error, mean = np.log(area), area.mean(axis=0)
    error -= error.mean(axis=0)
    for one, other in combinations(range(len(LOADS)), 2):
        both = 0.5 * (error[:, one].var() + error[:, other].var())
        left = (error[:, one] - error[:, other]).var() / both
        bound = abs(np.log(mean[one] / mean[other])) / np.log(AREA_FACTOR)
        texts = [f"{pressure / 1e5:g} bar {speed:g} m/s" for pressure, speed in LOADS]
        print(f"{texts[one]:>15}, {texts[other]:<15} left {left:.2f}, bound {bound:.2f}")


if __name__ == "__main__":
    main()
