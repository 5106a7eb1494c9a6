"""What a bridge needs of a graph: serialized messages out, and a callback for those that come."""

from __future__ import annotations

import os
import re
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from typing import TypeAlias

from firm_hdl.errors import UserError
from firm_hdl.node.description import Topic
from firm_hdl.terminal import printable

__all__ = ["FutureGraph", "Graph", "GraphError", "OnMessage", "domain_of"]

MAX_DOMAIN = 232
"""The ports of a higher one would be above 65,535 (DDSI-RTPS, 9.6.1.1)."""

OnMessage: TypeAlias = Callable[[Topic, bytes, object], None]
"""Takes a message of a subscription, or a request of a service: topic, packet and, of a request,
its caller, which :meth:`Graph.respond` gets back. Called in any thread; it does not block."""

_MOST_TOLD = 100
"""Most lines about peers. A peer may have any number of endpoints."""


class GraphError(Exception):
    """A graph cannot be joined, or is gone; the text says why. Joining it again may help."""


def domain_of(domain: int | None) -> int:
    """Return a domain of ROS 2; `None` is the environment's ``ROS_DOMAIN_ID``, or 0.

    Raises `UserError` if it is no number from 0 to 232.
    """
    name = "the domain" if domain is not None else "ROS_DOMAIN_ID"
    text = os.environ.get("ROS_DOMAIN_ID") or "0" if domain is None else str(domain)
    if not re.fullmatch("[0-9]{1,9}", text) or int(text) > MAX_DOMAIN:
        raise UserError(f"{name} is '{text}', and should be a number from 0 to {MAX_DOMAIN}")
    return int(text)


class Graph(ABC):
    """A way to other nodes, under the name of the node that the board is.

    A packet is a serialized message as a converter has it, with the encapsulation header of CDR.
    """

    def __init__(self, name: str) -> None:
        self.name = name  # For people.
        self.counters: Counter[str] = Counter()  # What the way itself lost, by cause.
        # Lines for people, and whether each has been said.
        self._told: dict[str, bool] = {}

    def tell(self, line: str) -> None:
        """Let people know a line, once, however often it is told. Called in any thread."""
        if len(self._told) >= _MOST_TOLD:
            line = "more peers do not fit, which are not named"
        self._told.setdefault(printable(line).replace("\n", "\\n"), False)

    def news(self) -> list[str]:
        """Return the lines that are new."""
        found = [line for line, is_said in list(self._told.items()) if not is_said]
        self._told.update(dict.fromkeys(found, True))
        return found

    @abstractmethod
    def open(self, on_message: OnMessage) -> None:
        """Join the graph with all topics and services of the node.

        Raises
        ------
        GraphError
            If there is none now.
        UserError
            If it will never be possible, such as without a package of messages.
        """

    @abstractmethod
    def publish(self, topic: Topic, packet: bytes) -> bool:
        """Publish a message; return whether the graph has taken it.

        Raises `GraphError` if the graph is gone.
        """

    @abstractmethod
    def respond(self, topic: Topic, caller: object, packet: bytes) -> bool:
        """Answer a request; as :meth:`publish`."""

    def abandon(self, topic: Topic, caller: object) -> None:
        """Forget a request that will not be answered. Its caller may wait for longer."""
        return

    def check(self) -> None:
        """Look whether the graph is still there; called about once a second.

        Raises
        ------
        GraphError
            If it is gone.
        """
        return

    ends = False
    """Whether its messages end some day. Such a graph is not left to wait for a board for ever."""

    @property
    def has_ended(self) -> bool:
        """Whether nothing will come any more, and the bridge may end."""
        return False

    @abstractmethod
    def close(self) -> None:
        """Leave the graph. May be called at any time, and again."""


class FutureGraph(Graph):
    """A graph in which the caller of a request is a `Future`, which gets the response's packet.

    A future is cancelled if its request will not be answered.
    """

    def respond(self, topic: Topic, caller: object, packet: bytes) -> bool:
        assert isinstance(caller, Future)
        with suppress(InvalidStateError):
            caller.set_result(packet)
            return True
        return False

    def abandon(self, topic: Topic, caller: object) -> None:
        assert isinstance(caller, Future)
        caller.cancel()
