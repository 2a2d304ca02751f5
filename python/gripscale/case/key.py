"""The key of a prediction of a case: a hash of all it depends on.

The text of the case, the bytes of the files it names and the software that solves it. Equal keys
mean equal results, to the last bit.
"""

from __future__ import annotations

import hashlib
import json

from gripscale.case.read import CaseFile
from gripscale.software import software
from gripscale.textfile import read_bytes
from gripscale.versions import versions


def prediction_key(file: CaseFile, name: str) -> str:
    """Return the key of the prediction `name` ("dynamic" or "static") of a case.

    Raises `FileError` if a file it names cannot be read.
    """
    contents = [read_bytes(file.resolve(named)) for _, named in file.case.named_files()]
    inputs = {
        "software": software(),
        "versions": versions(),
        "prediction": name,
        "case": file.text,
        "files": [hashlib.sha256(content).hexdigest() for content in contents],
    }
    return hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()[:32]
