"""Slip curves of a tread, beside the package: `python -m examples.slip_curve CASE.toml`."""
