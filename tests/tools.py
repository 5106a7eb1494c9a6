"""External tools that tests need."""

from __future__ import annotations

import os

import pytest

__all__ = ["need"]


def need(tool: str, path: str | None) -> str:
    """Return a tool's path. Without the tool, skip the test; in CI, fail it."""
    if path is None:
        message = f"{tool} is not installed (as root: make tools)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return path
