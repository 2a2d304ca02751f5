"""Shear stress of a dry road."""

from gripscale.conditions.area_term import GaussianStress

DRY_TREAD = GaussianStress(2.9e6, 0.1, 1.0)
STRESS_SCATTER = 0.2
