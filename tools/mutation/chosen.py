"""A plugin of pytest: only the tests of a list, in its order.

``-p tools.mutation.chosen``, with the name of a file in the environment. Which test runs at the
moment is written to another file, for whoever has to stop it.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

__all__ = ["CHOSEN", "RUNNING", "take_time"]

CHOSEN = "FIRM_HDL_MUTATION_CHOSEN"
RUNNING = "FIRM_HDL_MUTATION_RUNNING"


def take_time() -> None:
    """Let no random test fail because the machine is slow: it would count as one that notices."""
    calm = settings.get_profile("default")
    settings.register_profile(
        "mutation", calm, deadline=None, suppress_health_check=list(HealthCheck)
    )
    settings.load_profile("mutation")


def pytest_configure() -> None:
    """Begin."""
    take_time()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Drop what is not on the list. A fault may take tests away; what is left judges."""
    order = {name: at for at, name in enumerate(json.loads(Path(os.environ[CHOSEN]).read_text()))}
    kept = [item for item in items if item.nodeid in order]
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid not in order])
    items[:] = sorted(kept, key=lambda item: order[item.nodeid])


def pytest_runtest_logstart(nodeid: str) -> None:
    """Say which test runs."""
    Path(os.environ[RUNNING]).write_text(nodeid)
