"""The area term that agrees with measured friction."""

from gripscale.questions.registry import Form, FormField

_MODELS = (("best for the surface", ""), ("direct contact", "direct"), ("chain", "chain"))
_SHEAR_STRESSES = (
    ("gaussian in log speed", "gaussian"),
    ("constant", "constant"),
    ("Le Gal and Klüppel", "le_gal_klueppel"),
)
_HELD_OUT = (("none", ""), ("each temperature", "temperature"), ("each decade of speed", "speed"))

KINDS = {"calibration": "question:Calibration"}
COMMANDS = {"calibrate": "command:calibrate_command"}
FORMS = (
    Form(
        "calibrate",
        "Area term",
        "Fitted to the measured friction of the case; drop it in the tab of the load.",
        (
            FormField("--model", "model", "", choices=_MODELS),
            FormField("--law", "shear stress", "gaussian", choices=_SHEAR_STRESSES),
            FormField("--hold-out", "held out in turn", "", choices=_HELD_OUT),
        ),
    ),
)
