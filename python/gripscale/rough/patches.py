"""Contact patches of a periodic line or map."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from gripscale.rough.grid import Mask


def patch_points(active: Mask) -> NDArray[np.int64]:
    """Return the number of points of each patch, largest first.

    Points belong together if they are neighbours along x or y, across the period too.
    """
    labels, count = ndimage.label(active)
    first, second = [], []
    for axis in range(active.ndim):
        ends = np.take(labels, 0, axis=axis), np.take(labels, -1, axis=axis)
        touching = (ends[0] > 0) & (ends[1] > 0)
        first.append(ends[0][touching])
        second.append(ends[1][touching])
    rows, columns = np.concatenate(first) - 1, np.concatenate(second) - 1
    joined = sparse.coo_array((np.ones(rows.size), (rows, columns)), shape=(count, count))
    number, patch = csgraph.connected_components(joined, directed=False)
    sizes = np.bincount(labels.reshape(-1), minlength=count + 1)[1:]
    return np.sort(np.bincount(patch, weights=sizes, minlength=number).astype(np.int64))[::-1]
