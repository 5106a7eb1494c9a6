"""Fixtures of tests with real peers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from firm_hdl.rtps.ros import Node
from tests.live.network import leave_network, why_not
from tests.tools import need


@pytest.fixture(scope="session", autouse=True)
def network() -> None:
    """A network of its own, for this process and those that it starts."""
    lacking = why_not()
    need(lacking or "", "there" if lacking is None else None)
    leave_network()


@pytest.fixture
def make_node() -> Iterator[Callable[..., Node]]:
    """Make nodes on the loopback interface, which are closed after the test."""
    made: list[Node] = []

    def make(name: str = "board", namespace: str = "/fpga", **options: Any) -> Node:
        made.append(Node(name, namespace, interface="lo", **options))
        return made[-1]

    yield make
    for node in made:
        node.close()


@pytest.fixture
def node(make_node: Callable[..., Node]) -> Node:
    """A node ``/fpga/board``."""
    return make_node()
