"""Third-octave texture levels of profiles, as road engineers state their spectra.

    L = 10 log10( <z^2> in the band / a^2 ),    a = 1 um

(ISO 13473-4:2024). The bands are those of the spatial frequency, ten a decade: from 10^(-1/20) to
10^(1/20) times the middle one. The spectrum is that of whole profiles, each about its straight line
behind a Hann window, and mean over the profiles. Bands go from the shortest wavelength that the
measurement resolves to a twelfth of its length.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gripscale.core import InputError, in_mm
from gripscale.surface.profile import HeightMap, Profile, profile_list
from gripscale.surface.spectrum import profile_spectrum

if TYPE_CHECKING:
    import xarray as xr

_REFERENCE = 1e-6  # root mean square height of the level zero [m]
_LENGTHS = 12.0  # length of a profile over the longest wavelength of its bands
_HALF_BAND = 10.0**0.05  # edge of a band over its middle

# Numbers by which the middles of the bands are called (ISO 3, R10).
_PREFERRED = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def texture_levels(surface: Profile | Sequence[Profile] | HeightMap) -> xr.Dataset:
    """Return the third-octave texture levels of profiles, or of the lines of a map along x.

    The result has `level` [dB re 1 um] over `wavelength` [m], the middles of the bands, longest
    first. `surface` are cleaned heights; missing ones are interpolated, and several profiles must
    have the same step. Raises `InputError` if they are too short for a band that they resolve.
    """
    import xarray as xr  # slow to import: not for reading a surface

    lines = surface.lines() if isinstance(surface, HeightMap) else profile_list(surface)
    length = min(line.length for line in lines)
    shortest = max(line.resolution_limit for line in lines)
    # numbers of the bands: wavelength 10^(number / 10)
    first = int(np.ceil(10.0 * np.log10(shortest * _HALF_BAND) - 1e-9))
    last = int(np.floor(10.0 * np.log10(length / _LENGTHS) + 1e-9))
    if last < first:
        raise InputError(
            f"profile must be longer than {in_mm(_LENGTHS * shortest * _HALF_BAND, 3)} for a level "
            f"at wavelengths that it resolves; got {in_mm(length, 3)}"
        )
    bands = np.arange(last, first - 1, -1)
    middle = 2.0 * np.pi / 10.0 ** (bands / 10.0)
    spectrum = profile_spectrum(surface, window=length, steepest=np.inf)
    edges = spectrum.wavenumber[:1] - 0.5 * spectrum.width[:1]
    edges = np.concatenate([edges, spectrum.wavenumber + 0.5 * spectrum.width])
    # variance of all shorter waves, of which the least are summed first
    shorter = np.append(np.cumsum((spectrum.density * spectrum.width)[::-1])[::-1], 0.0)
    ends = middle[:, None] * [1.0 / _HALF_BAND, _HALF_BAND]
    variance = -np.diff(np.interp(ends, edges, shorter), axis=1)[:, 0]
    nominal = np.array([_PREFERRED[n % 10] * 10.0 ** (n // 10) for n in bands])
    with np.errstate(divide="ignore"):  # a flat line
        level = 10.0 * np.log10(variance / _REFERENCE**2)
    about = {"units": "dB", "long_name": "third-octave texture level re 1 um, ISO 13473-4"}
    lengths = {"units": "m", "long_name": "texture wavelength"}
    return xr.Dataset(
        {"level": ("wavelength", level, about)},
        {"wavelength": ("wavelength", nominal, lengths)},
    )
