"""The models a study can be made of by name, as a case asks for them."""

from __future__ import annotations

from gripscale import checks
from gripscale.case.chain import case_chain
from gripscale.case.read import CaseFile
from gripscale.chain.model import Chain
from gripscale.model import Model
from gripscale.rough.model import DirectContact

NAMED_MODELS = (Chain.name, DirectContact.name)


def model_of(model: Model | str, file: CaseFile) -> Model:
    """Return a model, or the one of this name with the conditions of the case.

    Raises `InputError` if the name is another.
    """
    if not isinstance(model, str):
        return model
    chain = case_chain(file)
    if checks.one_of("model", model, NAMED_MODELS) == Chain.name:
        return chain
    return DirectContact(conditions=chain.conditions)
