from .chain import WAVE_SOLVERS as WAVE_SOLVERS
from .chain import Chain as Chain
from .chain import predict as predict
from .prediction import ChainError as ChainError
from .prediction import Prediction as Prediction
from .prediction import RubberAt as RubberAt
