"""Which strain softens the rubber on a scale, and how well it follows blocks of softening rubber.

A harmonic u_q of the surface's displacement strains an incompressible half-space at depth y by

    e = |q|^2 y exp(-|q| y) u_q,    e_zz = e,  e_ij = -e q_i q_j/|q|^2,  e_iz = i e q_i/|q|

(K. L. Johnson, "Contact Mechanics" (1985), section 13.2, of a wave without friction), most at
y = 1/|q|. The strain of a scale is that of all harmonics at this depth: the equivalent uniaxial
amplitude sqrt(2/3 e:e), its mean over the contact times `DEPTH_FACTOR`. A chain has one wave at a
time and takes `SLOPE_FACTOR` times the rms slope in its contact.

Measured by studies/strain_rule: docs/strain-rule.md.
"""

from __future__ import annotations

DEPTH_FACTOR = 0.85
"""Strain of a scale over the mean strain at its depth under the contact [-]."""
LOG_AREA, LOG_FRICTION = 0.10, 0.05
"""Scatter of ln area and ln friction of a direct contact, the filler healing or not [-]."""
SLOPE_FACTOR = 0.4
"""Strain of a wave of a chain over the rms slope in its contact [-]."""
