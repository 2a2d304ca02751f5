from .blocks import block_figure as block_figure
from .blocks import blocks_figure as blocks_figure
from .contact import contact_figure as contact_figure
from .correlation import correlation_figure as correlation_figure
from .finite_strain import finite_strain_figure as finite_strain_figure
from .master_curve import master_curve_figure as master_curve_figure
from .profile import profile_figure as profile_figure
from .style import save_figure as save_figure
