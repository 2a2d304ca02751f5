from .compare import Roads as Roads
from .compare import compare_surfaces as compare_surfaces
