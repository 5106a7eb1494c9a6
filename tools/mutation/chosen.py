"""A plugin of pytest: run only the tests of a list, in the order of the list.

Use it by ``-p tools.mutation.chosen``, with the name of the list's file in the environment. The
name of the running test is written to another file, for the process that may stop the run.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

__all__ = ["CHOSEN", "RUNNING", "remove_time_limits"]

CHOSEN = "FIRM_HDL_MUTATION_CHOSEN"
RUNNING = "FIRM_HDL_MUTATION_RUNNING"


def remove_time_limits() -> None:
    """Remove time limits of random tests: a failure on a slow machine would seem to be a kill."""
    calm = settings.get_profile("default")
    settings.register_profile(
        "mutation", calm, deadline=None, suppress_health_check=list(HealthCheck)
    )
    settings.load_profile("mutation")


def pytest_configure() -> None:
    """Remove time limits before tests run."""
    remove_time_limits()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Drop tests that are not on the list; ignore tests that are missing because of a fault."""
    order = {name: at for at, name in enumerate(json.loads(Path(os.environ[CHOSEN]).read_text()))}
    kept = [item for item in items if item.nodeid in order]
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid not in order])
    items[:] = sorted(kept, key=lambda item: order[item.nodeid])


def pytest_runtest_logstart(nodeid: str) -> None:
    """Write the name of the running test to the file."""
    Path(os.environ[RUNNING]).write_text(nodeid)
