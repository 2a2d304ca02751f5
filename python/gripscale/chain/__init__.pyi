from .model import Chain as Chain
from .predict import ChainError as ChainError
from .predict import predict as predict
from .prediction import Prediction as Prediction
from .rubber_at import RubberAt as RubberAt
from .solvers import WAVE_SOLVERS as WAVE_SOLVERS
