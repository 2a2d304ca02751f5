from .chain import WAVE_SOLVERS as WAVE_SOLVERS
from .chain import Chain as Chain
from .chain import solve_chain as solve_chain
from .prediction import ChainError as ChainError
from .prediction import ChainResult as ChainResult
from .prediction import RubberAt as RubberAt
