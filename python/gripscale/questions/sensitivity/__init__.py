"""What decides the answer."""
