"""Synthetic isotropic maps against the measured lines they are made from."""
