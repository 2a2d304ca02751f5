"""Which compound is better."""
