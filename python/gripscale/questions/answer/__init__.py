"""What is the answer: friction and contact area of a case, with their intervals."""

KINDS = {"answer": "answer:Answer"}
