"""Interactive figures, as Bokeh models."""
