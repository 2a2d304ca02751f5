"""The errors gripscale raises on purpose, each saying what was given and what was expected."""

from __future__ import annotations


class GripscaleError(Exception):
    """Base of every error gripscale raises on purpose."""


class InputError(GripscaleError, ValueError):
    """A value that cannot be used; the message names it, its place and what was expected."""


class ExtrapolationError(InputError):
    """A wave excites the rubber beyond what was measured, and extrapolation was to be refused."""


class FileError(GripscaleError, OSError):
    """A file that cannot be found, read, understood or written; the message names the path."""


class ConvergenceError(GripscaleError):
    """A wave has no trustworthy solution, so nothing after it may use its result."""


class RubberWarning(UserWarning):
    """A rubber made by hand that no rubber is like."""
