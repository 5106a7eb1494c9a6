"""What tests find out: verdicts, records of tests, and the file that keeps them."""

from __future__ import annotations

__all__ = []
