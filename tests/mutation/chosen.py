"""A plugin of pytest: only the tests of a list, in its order.

``-p tests.mutation.chosen``, with the name of a file in the environment. Which test runs at the
moment is written to another file, for whoever has to stop it.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

__all__ = ["CHOSEN", "RUNNING"]

CHOSEN = "FIRM_HDL_MUTATION_CHOSEN"
RUNNING = "FIRM_HDL_MUTATION_RUNNING"


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
