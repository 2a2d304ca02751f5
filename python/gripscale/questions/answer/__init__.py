"""What is the answer: friction and contact area with their intervals."""
