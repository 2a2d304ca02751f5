"""What is doubtful about a rubber from a master curve, a sentence each."""

from __future__ import annotations

from collections.abc import Iterator

from gripscale.rubber.compressibility import too_compressible
from gripscale.rubber.material import Rubber
from gripscale.rubber.misfit import END_ROWS, Misfit
from gripscale.rubber.plateau import BEYOND, fast_end, slow_end


def findings(
    rubber: Rubber,
    inconsistencies: tuple[Misfit, ...],
    ends: tuple[Misfit | None, Misfit | None],
) -> tuple[str, ...]:
    """Return what a reader must know before the rubber is used."""
    return (*_consistency(inconsistencies), *_ends(ends), *_slow(rubber), *_fast(rubber))


def _consistency(inconsistencies: tuple[Misfit, ...]) -> Iterator[str]:
    if inconsistencies:
        places = "; ".join(str(one) for one in inconsistencies)
        yield (
            "E' and E'' break the Kramers-Kronig relation (no linear solid has both) where the "
            f"best series misses them by more than their scatter, at most by: {places}"
        )


def _ends(ends: tuple[Misfit | None, Misfit | None]) -> Iterator[str]:
    for name, misfit in zip(("slowest", "fastest"), ends, strict=True):
        if misfit is not None:
            yield (
                f"the series misses the {END_ROWS} {name} rows by more than the scatter, in the "
                f"mean by: {misfit}"
            )


def _slow(rubber: Rubber) -> Iterator[str]:
    end = slow_end(rubber)
    assert rubber.valid_band is not None
    if _flows(rubber, rubber.valid_band[0]):
        yield (
            f"no equilibrium modulus: {_mega(end.modulus)} MPa are left at the slow end and fall "
            f"with the frequency, {_mega(rubber.equilibrium_modulus)} MPa in the end; the data are "
            "those of a melt, which carries no load at rest"
        )
    elif not end.plateau:
        yield (
            "no plateau at the slow end: the equilibrium modulus, "
            f"{_mega(rubber.equilibrium_modulus)} MPa, is an extrapolation; two decades slower E' "
            f"may be {_span(rubber, False)} MPa"
        )


def _flows(rubber: Rubber, omega: float) -> bool:
    """Return whether E'' exceeds E' and E' falls faster than the frequency: w^2 in a melt."""
    here, twice = (complex(rubber.complex_modulus(factor * omega)) for factor in (1.0, 2.0))
    return here.imag > here.real and twice.real > 2.0 * here.real


def _fast(rubber: Rubber) -> Iterator[str]:
    end = fast_end(rubber)
    if not end.plateau:
        yield (
            f"no plateau at the fast end: E' is still {_mega(end.modulus)} MPa there; two decades "
            f"faster it may be {_span(rubber, True)} MPa"
        )
    assert rubber.valid_band is not None
    omega = rubber.valid_band[1]
    modulus = abs(complex(rubber.complex_modulus(omega)))
    told = too_compressible(rubber.bulk_modulus, modulus, f"at {omega:.3g} rad/s")
    if told:
        yield told


def _span(rubber: Rubber, fast: bool) -> str:
    assert rubber.valid_band is not None
    omega = rubber.valid_band[1] * BEYOND if fast else rubber.valid_band[0] / BEYOND
    low, high = rubber.complex_modulus_band(omega)
    return f"{_mega(float(low.real))} to {_mega(float(high.real))}"


def _mega(modulus: float) -> str:
    return f"{modulus / 1e6:.4g}"
