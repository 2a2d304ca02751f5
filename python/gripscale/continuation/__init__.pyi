from .curve import ContactByCutOff as ContactByCutOff
from .curve import ContinuedContact as ContinuedContact
from .curve import contact_by_cut_off as contact_by_cut_off
from .roughness import FinerMeasurement as FinerMeasurement
from .roughness import HurstExponent as HurstExponent
from .roughness import OwnFaces as OwnFaces
