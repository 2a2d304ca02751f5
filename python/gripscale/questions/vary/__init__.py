"""How the answer varies: over inputs, from surface to surface, from compound to compound."""

from gripscale.questions.registry import Form, FormField

KINDS = {
    "study": "question:Variation",
    "compounds": "ranking:Compounds",
    "surfaces": "ranking:Surfaces",
}
COMMANDS = {
    "study": "command:study_command",
    "compare-rubbers": "command:compare_rubbers",
    "compare-surfaces": "command:compare_surfaces_command",
}
FORMS = (
    Form(
        "study",
        "Sweep of speed, or of speed and temperature",
        "Friction and contact area by speed; with temperatures, such as 0 C:60 C:lin4, by both.",
        (
            FormField("--vary", "speeds", "0.003:30:log9", "speed="),
            FormField("--vary", "temperatures", "", "temperature="),
        ),
    ),
    Form(
        "compare-rubbers",
        "Compounds on this surface",
        "The rubber of the case beside others, on its surface and under its load.",
        others="compounds",
    ),
    Form(
        "compare-surfaces",
        "Surfaces under this rubber",
        "The surface of the case beside others, under its rubber and its load.",
        others="surfaces",
    ),
)
