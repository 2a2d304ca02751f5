from .choice import Uncertainty as Uncertainty
from .profile_blocks import ProfileBlocks as ProfileBlocks
from .propagate import propagate as propagate
from .quantiles import summary as summary
from .range import Range as Range
from .series import SeriesScatter as SeriesScatter
from .shares import Shares as Shares
from .shares import shares as shares
