"""CITATION.cff states what the format requires and the version of the package."""

import tomllib

import yaml

from tests.samples import ROOT


def test_citation_has_the_required_keys_and_the_version_of_the_package():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["cff-version"] == "1.2.0"
    assert {"message", "title", "authors", "references"} <= set(citation)
    assert citation["authors"] == [{"name": "The gripscale developers"}]
    for reference in citation["references"]:
        assert {"type", "title", "authors"} <= set(reference)
    package = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation["version"] == package["version"]
    assert citation["license"] == package["license"]
