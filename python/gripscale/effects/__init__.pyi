from .effects import effect_tasks as effect_tasks
from .effects import effects as effects
from .of_case import case_effects as case_effects
from .of_case import stored_effects as stored_effects
