"""What decides the friction of a case, by derivatives."""

from gripscale.questions.registry import Form

KINDS = {"sensitivity": "question:Sensitivity"}
COMMANDS = {"sensitivity": "command:sensitivity_command"}
FORMS = (
    Form("sensitivity", "What decides the grip", "Which inputs and frequencies, and how much."),
)
