"""The results of tests: verdicts, records of tests, and the file that keeps the records."""

__all__ = []
