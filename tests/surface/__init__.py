"""Tests of gripscale.surface; a package so that they can share `surface_cases`."""
