"""The types of arrays that all rooms hand to one another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Mask = NDArray[np.bool_]

if TYPE_CHECKING:

    class Vector:
        """Type of a checked field that is given as anything array-like and read as an array."""

        def __get__(self, instance: object, owner: type) -> Array: ...
        def __set__(self, instance: object, value: ArrayLike | None) -> None: ...
else:
    Vector = Array
