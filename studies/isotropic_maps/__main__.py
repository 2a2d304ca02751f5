"""The command: numbers and figure of docs/isotropic-maps.md.

    python -m studies.isotropic_maps --output results/isotropic_maps

About half an hour of one core for six seeds; finished numbers are kept in the folder.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from studies.isotropic_maps import tables
from studies.isotropic_maps.draw import draw
from studies.isotropic_maps.folder import Folder
from studies.isotropic_maps.setting import CONSTRUCTIONS, LENGTH
from studies.shipped import road, tread


def main() -> None:
    """Compute, print the tables and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("results/isotropic_maps"))
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--figure", type=Path, help="file; in the output folder by default")
    asked = parser.parse_args()
    folder, rubber = Folder(asked.output, asked.seeds), tread()
    folder.fill(rubber)
    for table in (tables.contacts, tables.statistics, tables.directions):
        print("\n".join(table(folder)), end="\n\n")
    for line in tables.cut_maps(folder, rubber):
        print(line, flush=True)
    maps = {construction: folder.heights(0, construction) for construction in CONSTRUCTIONS}
    draw(road(0), maps, LENGTH, asked.figure or asked.output / "isotropic_maps.png")


if __name__ == "__main__":
    main()
