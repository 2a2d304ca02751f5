"""What lies below the measurement: friction and contact area against the cut-off."""

from gripscale.questions.registry import Field, Form

KINDS = {"cut_off": "question:CutOff"}
COMMANDS = {"cut-off": "command:cut_off"}
FORMS = (
    Form(
        "cut-off",
        "Cut-off",
        "Friction by the shortest wavelength that counts.",
        (Field("--down-to", "down to", "20 um"),),
    ),
)
