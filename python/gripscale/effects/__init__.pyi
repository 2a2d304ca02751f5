from .effects import effect_tasks as effect_tasks
from .effects import effects as effects
