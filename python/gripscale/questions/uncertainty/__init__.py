"""How uncertain is the answer: the errors of the inputs, and the most important of them."""

from gripscale.questions.registry import Form, FormField

KINDS = {"uncertainty": "question:SampledAnswer"}
COMMANDS = {"uncertainty": "command:uncertainty_command"}
FORMS = (
    Form(
        "uncertainty",
        "Uncertainty",
        "The answer with the errors of its inputs, and the most important of them.",
        (FormField("--samples", "samples", "200"),),
    ),
)
