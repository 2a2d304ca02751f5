from .solve import Progress as Progress
from .solve import solve_all as solve_all
from .study import Study as Study
from .task import Store as Store
from .task import Task as Task
