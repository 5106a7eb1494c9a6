"""The names of interfaces and of their messages.

A service or an action has several messages. The name of each message is the name of the interface
and a suffix. The suffixes are those of genmsg and of ``genaction.py`` (ROS 1), and of
``rosidl_parser.definition`` (ROS 2).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from firm_hdl.model import Dialect

__all__ = [
    "ACTION_SERVICES",
    "ACTION_WRAPPERS",
    "EVENT",
    "KINDS",
    "PARTS",
    "Kind",
    "TypeName",
    "owners",
]

Kind: TypeAlias = Literal["msg", "srv", "action"]
"""The kind of interface that a definition declares; in ROS 2 also its messages' namespace."""

KINDS: tuple[Kind, ...] = ("msg", "srv", "action")
"""All kinds, in the order in which a name without one is looked up."""


@dataclass(frozen=True, slots=True, order=True)
class TypeName:
    """The name of a message, a service or an action; `str` writes it as the dialect does.

    A message that is derived from a service or an action has the kind of that interface.
    """

    package: str
    kind: Kind
    name: str
    dialect: Dialect

    def __str__(self) -> str:
        middle = f"/{self.kind}/" if self.dialect == "ros2" else "/"
        return f"{self.package}{middle}{self.name}"


PARTS: dict[tuple[Dialect, Kind], tuple[str, ...]] = {
    ("ros1", "msg"): ("",),
    ("ros2", "msg"): ("",),
    ("ros1", "srv"): ("Request", "Response"),
    ("ros2", "srv"): ("_Request", "_Response"),
    ("ros1", "action"): ("Goal", "Result", "Feedback"),
    ("ros2", "action"): ("_Goal", "_Result", "_Feedback"),
}
"""Suffixes of the messages that a definition declares itself, in the order of its text."""

EVENT = "_Event"
"""Suffix of the message that ROS 2 derives from a service, since iron."""

ACTION_SERVICES = ("_SendGoal", "_GetResult")
"""Suffixes of the services that ROS 2 derives from an action."""

ACTION_WRAPPERS: dict[Dialect, tuple[str, ...]] = {
    "ros1": ("ActionGoal", "ActionResult", "ActionFeedback", "Action"),
    "ros2": ("_FeedbackMessage",),
}
"""Suffixes of the messages in which ROS wraps the messages of an action."""


def _suffixes(dialect: Dialect, kind: Kind) -> tuple[str, ...]:
    """List the suffixes of an interface's messages, longer ones first."""
    if kind == "msg":
        return ()
    if kind == "action":
        return (*_derived_from_action(dialect), *PARTS[dialect, kind])
    return (*PARTS[dialect, kind], *((EVENT,) if dialect == "ros2" else ()))


def _derived_from_action(dialect: Dialect) -> Iterator[str]:
    if dialect == "ros2":
        for service in ACTION_SERVICES:
            yield from (service + suffix for suffix in _suffixes(dialect, "srv"))
    yield from ACTION_WRAPPERS[dialect]


def owners(name: TypeName) -> Iterator[TypeName]:
    """List the interfaces that may have a message of this name, the likeliest first."""
    for suffix in _suffixes(name.dialect, name.kind):
        base = name.name.removesuffix(suffix)
        if base and base != name.name:
            yield replace(name, name=base)
