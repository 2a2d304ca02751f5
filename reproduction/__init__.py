"""The figures of Lind & Wangenheim 2014 (IMECE2014-37998) with real and named inputs."""

from gripscale.reproduce.run import FIGURES, reproduce
from gripscale.reproduce.statement import Statement

__all__ = ["FIGURES", "Statement", "reproduce"]
