"""Settings and fixtures of the laboratory's tests: those of the product's tests."""

from __future__ import annotations

import pytest

from tests.bench.conftest import ecp5
from tests.conftest import corpus, verilator
from tests.depth import THOROUGH

__all__ = ["corpus", "ecp5", "verilator"]


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect thorough tests, except in `make nightly`."""
    left_out = [item for item in items if item.get_closest_marker("thorough") and not THOROUGH]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]
