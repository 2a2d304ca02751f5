"""Arguments that are one profile or several of the same surface."""

from __future__ import annotations

from collections.abc import Sequence

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.profile import Profile

SAME_STEP = 1e-3
"""Relative difference of steps up to which they are the same."""


def one_or_several(profile: Profile | Sequence[Profile]) -> list[Profile]:
    """Return one profile or several as a list; raise `InputError` if it is neither."""
    given: object = [profile] if isinstance(profile, Profile) else profile
    profiles = list(given) if isinstance(given, Sequence) else []
    if not profiles or not all(isinstance(one, Profile) for one in profiles):
        raise InputError(
            f"profile must be a Profile or a list of them; got {checks.shown(profile)}"
        )
    return profiles


def of_one_step(profile: Profile | Sequence[Profile], what: str) -> list[Profile]:
    """Return one profile or several, to be pooled or averaged as `what` says, as a list.

    Raises `InputError` if it is neither, or their steps differ.
    """
    profiles = one_or_several(profile)
    step = profiles[0].step
    for at, one in enumerate(profiles):
        if abs(one.step - step) > SAME_STEP * step:
            raise InputError(
                f"profiles must have the same step to be {what}; got {step:g} m at index 0 and "
                f"{one.step:g} m at index {at}"
            )
    return profiles
