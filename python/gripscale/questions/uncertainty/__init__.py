"""How uncertain is the answer."""
