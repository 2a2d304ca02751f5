"""How does the answer vary with an input."""
