"""How do the models compare."""
