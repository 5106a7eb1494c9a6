"""What tests find out: verdicts, records of tests, and the file that keeps them."""

__all__ = []
