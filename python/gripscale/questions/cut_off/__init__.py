"""What lies below the measurement: friction and contact area against the cut-off."""

from gripscale.questions.registry import Form, FormField

KINDS = {"cut_off": "question:CutOff"}
COMMANDS = {"cut-off": "command:cut_off_command"}
FORMS = (
    Form(
        "cut-off",
        "Cut-off",
        "Friction by the shortest wavelength that counts.",
        (FormField("--down-to", "down to", "20 um"),),
    ),
)
