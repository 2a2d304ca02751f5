from .paper import save_figure as save_figure
