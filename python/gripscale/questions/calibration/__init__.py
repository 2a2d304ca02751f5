"""Does the answer agree with measured friction."""
