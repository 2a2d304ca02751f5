from .differences import residuals as residuals
from .friction import MeasuredFriction as MeasuredFriction
from .friction import read_measured_friction as read_measured_friction
from .predicted import Predicted as Predicted
from .predicted import averaged as averaged
from .predicted import predictions_at as predictions_at
