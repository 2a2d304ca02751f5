from .compare import Compounds as Compounds
from .compare import compare_compounds as compare_compounds
from .one_temperature import at_one_temperature as at_one_temperature
