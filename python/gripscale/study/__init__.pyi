from .store import Store as Store
from .study import Study as Study
from .task import Task as Task
from .threads import Progress as Progress
from .threads import solve_all as solve_all
