from .fit import calibrate as calibrate
from .held_out import HeldOut as HeldOut
from .of_case import calibrate_case as calibrate_case
from .result import Calibration as Calibration
from .result import Estimate as Estimate
