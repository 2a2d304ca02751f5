"""Real contact area and friction of rubber on rough surfaces."""
