"""Samples of models made by hand."""

import math
from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

Make = Callable[..., xr.Dataset]


@pytest.fixture
def solved():
    """Make the samples of a model: (area, friction, subject), or with values by name as a dict."""

    def make(*samples):
        rows = []
        for sample in samples:
            row = sample
            if not isinstance(sample, dict):
                area, friction, *subject = sample
                row = {"contact_fraction": area, "friction": friction, "subject": "".join(subject)}
            row = {"friction": math.nan, "contact_fraction": math.nan, "subject": ""} | row
            row = {"pressure_over_modulus": math.nan} | row
            row = {"friction_from_dissipation": 1.02 * row["friction"]} | row
            errors = {"contact_fraction_error": math.nan, "friction_error": math.nan}
            good = {"prediction_status": "converged", "prediction_status_word": "converged"}
            rows.append(good | errors | row)
        columns = {name: ("sample", [row[name] for row in rows]) for name in rows[0]}
        return xr.Dataset(columns).set_coords("subject")

    return make


@pytest.fixture
def together():
    """Put the samples of models beside each other, over `model`."""

    def make(**models):
        names = np.array(list(models), dtype=object)
        most = max(samples.sizes["sample"] for samples in models.values())
        padded = []
        for samples in models.values():
            missing = {"sample": (0, most - samples.sizes["sample"])}
            texts = {"prediction_status": "", "prediction_status_word": "", "subject": ""}
            filled = samples.reset_coords().pad(missing, constant_values={**texts})
            padded.append(filled.set_coords("subject"))
        return xr.concat(padded, "model", coords=["subject"]).assign_coords(model=names)

    return make
