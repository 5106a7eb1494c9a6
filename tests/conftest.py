"""Settings and fixtures of all tests."""

from __future__ import annotations

import gc
import os
import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.depth import LIVE, THOROUGH, by_depth, not_sampled
from tests.tools import need
from tests.vhdl.ghdl import GHDL

# A circuit has hundreds of thousands of objects, most of which live as long as their test.
gc.set_threshold(100_000, 20, 20)

# A test must not fail because the machine is busy.
settings.register_profile(
    "unhurried",
    deadline=None,
    max_examples=by_depth(40, 100),
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("unhurried")

# Tests must not depend on the packages of an active ROS workspace.
for _name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
    os.environ.pop(_name, None)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect thorough tests, except in `make nightly`; live ones likewise."""
    markers = [*([] if THOROUGH else ["thorough"]), *([] if LIVE else ["live"])]
    left_out = {item for item in items if any(map(item.get_closest_marker, markers))}
    if not THOROUGH:
        left_out |= not_sampled(item for item in items if item not in left_out)
    config.hook.pytest_deselected(items=[item for item in items if item in left_out])
    items[:] = [item for item in items if item not in left_out]


def pytest_collection_finish() -> None:
    """Keep Python from searching the modules and items, which live to the end, for cycles."""
    gc.freeze()


@pytest.fixture(scope="session")
def corpus() -> Path:
    """Definitions of real ROS packages, where ``FIRM_HDL_CORPUS`` names a folder of them.

    An empty value says that there are none: they are not part of the repository.
    """
    folder = os.environ.get("FIRM_HDL_CORPUS")
    if folder:
        return Path(folder)
    if folder is None and os.environ.get("CI"):
        pytest.fail("FIRM_HDL_CORPUS is not set, and CI must not skip this")
    pytest.skip("FIRM_HDL_CORPUS names no folder")


@pytest.fixture
def ghdl() -> str:
    """GHDL's path."""
    return need("GHDL", GHDL)


@pytest.fixture
def iverilog() -> str:
    """Icarus Verilog's path."""
    return need("Icarus Verilog", shutil.which("iverilog"))


@pytest.fixture
def verilator() -> str:
    """Verilator's path."""
    return need("Verilator", shutil.which("verilator"))
