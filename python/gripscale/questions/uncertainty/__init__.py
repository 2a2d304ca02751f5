"""How uncertain is the answer: the errors of the inputs, and the most important of them."""

from gripscale.questions.registry import Field, Form

KINDS = {"uncertainty": "question:SampledAnswer"}
COMMANDS = {"uncertainty": "command:uncertainty"}
FORMS = (
    Form(
        "uncertainty",
        "Uncertainty",
        "The answer with the errors of its inputs, and the most important of them.",
        (Field("--samples", "samples", "200"),),
    ),
)
