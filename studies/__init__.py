"""Numerical experiments behind pages of the documentation, on public names of gripscale."""
