from .fit import calibrate as calibrate
from .fitted import Estimate as Estimate
from .held_out import HeldOut as HeldOut
from .of_case import calibrate_case as calibrate_case
from .result import Calibration as Calibration
