"""What does the chain of waves say, for comparison."""
