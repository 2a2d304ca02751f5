"""The case of three small waves that experiments are tested with."""

from tests.experiment.conftest import case, same_bytes

__all__ = ["case", "same_bytes"]
