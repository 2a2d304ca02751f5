"""Master curves as CSV files that `read_master_curve` reads again."""

from __future__ import annotations

from pathlib import Path

from gripscale import checks
from gripscale.netcdf import write_whole
from gripscale.rubber.master_curve import MasterCurve
from gripscale.textfile import file_path


def write_master_curve(path: str | Path, master: MasterCurve) -> Path:
    """Write a master curve as CSV in Hz and Pa; return the path.

    The reference temperature stands in a comment, for people: whoever reads the file states it.

    Raises `FileError` if the file cannot be written.
    """
    checks.instance("master", master, MasterCurve)
    lines = [f"# {' '.join(text.split())}" for text in (master.name, master.source) if text]
    if master.reference_temperature is not None:
        lines.append(f"# reference temperature (K): {master.reference_temperature:g}")
    lines.append("frequency (Hz),storage modulus E' (Pa),loss modulus E'' (Pa)")
    rows = zip(master.frequency, master.storage, master.loss, strict=True)
    lines += [",".join(repr(float(value)) for value in row) for row in rows]
    text = "\n".join(lines) + "\n"
    return write_whole(file_path(path), lambda part: _write(part, text))


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
