"""How the models compare: the answer beside the chain and the theories."""

from gripscale.questions.registry import Form, FormField

KINDS = {"comparison": "question:Comparison"}
COMMANDS = {"compare": "command:compare_command"}
FORMS = (
    Form(
        "compare",
        "Comparison of models",
        "What each assumption of the chain costs, against the direct contact.",
        (FormField("--models", "models", "waves,measured,theory"),),
    ),
)
