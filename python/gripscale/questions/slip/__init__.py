"""Braking force over slip: the friction of a case in a contact patch of a tread."""

from gripscale.questions.registry import Form, FormField

KINDS = {"slip": "question:SlipCurve"}
COMMANDS = {"slip": "command:slip_command"}
FORMS = (
    Form(
        "slip",
        "Slip curve",
        "Braking force over slip, of a tread as a brush; no prediction of a tyre.",
        (FormField("--speed", "speed of the road", "80 km/h"),),
    ),
)
