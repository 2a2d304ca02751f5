import gripscale.continuation

from .grid_sequence import GridRecord as GridRecord
from .location import contact_trace as contact_trace
from .model import BlockOnProfile as BlockOnProfile
from .model import DirectContact as DirectContact
from .result import RoughContact as RoughContact
from .result import TrappedWater as TrappedWater
from .result import shares_by_slope as shares_by_slope
from .sensitivity import contact_sensitivity as contact_sensitivity
from .solve import solve_rough_contact as solve_rough_contact
from .windows import WindowContacts as WindowContacts
from .windows import one_period as one_period
from .windows import random_phases as random_phases
from .windows import solve_windows as solve_windows
from .windows import spread_windows as spread_windows
from .windows import surface_of_sines as surface_of_sines
from .windows import windows as windows

ContactByCutOff = gripscale.continuation.ContactByCutOff
ContinuedContact = gripscale.continuation.ContinuedContact
FinerMeasurement = gripscale.continuation.FinerMeasurement
HurstExponent = gripscale.continuation.HurstExponent
OwnFaces = gripscale.continuation.OwnFaces
contact_by_cut_off = gripscale.continuation.contact_by_cut_off
