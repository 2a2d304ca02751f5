"""Design of a compound: most friction for each rolling resistance."""

from gripscale.questions.registry import Form

KINDS = {"design": "question:CompoundDesign"}
COMMANDS = {"design": "command:design_command"}
FORMS = (Form("design", "Design of a compound", "Most friction for each rolling resistance."),)
