"""Colours, sizes and units that print and page share; nothing here needs a drawing library.

Colours are from Okabe & Ito, "Color universal design" (2008).
"""

from __future__ import annotations

BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
SKY, PURPLE, YELLOW = "#56B4E9", "#CC79A7", "#E69F00"
INK, GREY, FAINT = "#222222", "#7F7F7F", "#D9D9D9"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, YELLOW, SKY)

WIDE, NARROW = 7.0, 4.6
"""Widths of a figure over two columns and a little over one [inch]."""

MILLI, MEGA, SQUARE_MM = 1e-3, 1e6, 1e-6
"""What SI values are divided by to be read in mm, MPa and mm^2."""
