from .calibrate import calibrate as calibrate
from .held_out import HeldOut as HeldOut
from .result import Calibration as Calibration
from .result import Estimate as Estimate
