"""Time and memory, with accuracy beside them: `python -m benchmarks [SUBJECT ...]`."""
