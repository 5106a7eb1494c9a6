"""What interfaces and their messages are called.

A service or an action has several messages, and each has a name of its own: that of the interface
and a suffix. The suffixes are those of genmsg and of ``genaction.py`` (ROS 1), and of
``rosidl_parser.definition`` (ROS 2).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from firm_hdl.model import Dialect

__all__ = ["KINDS", "Kind", "TypeName", "owners"]

Kind: TypeAlias = Literal["msg", "srv", "action"]
"""What a definition declares; in ROS 2 also the namespace of its messages."""

KINDS: tuple[Kind, ...] = ("msg", "srv", "action")
"""All kinds, in the order in which a name without one is looked up."""


@dataclass(frozen=True, slots=True, order=True)
class TypeName:
    """The name of a message, a service or an action; `str` writes it as the dialect does.

    The kind of a message that is made from a service or an action is that of its origin.
    """

    package: str
    kind: Kind
    name: str
    dialect: Dialect

    def __str__(self) -> str:
        middle = f"/{self.kind}/" if self.dialect == "ros2" else "/"
        return f"{self.package}{middle}{self.name}"


# What the names of messages end in, longer suffixes first.
_SUFFIXES: dict[Dialect, dict[Kind, tuple[str, ...]]] = {
    "ros1": {
        "msg": (),
        "srv": ("Request", "Response"),
        "action": (
            *("ActionGoal", "ActionResult", "ActionFeedback", "Action"),
            *("Goal", "Result", "Feedback"),
        ),
    },
    "ros2": {
        "msg": (),
        "srv": ("_Request", "_Response", "_Event"),
        "action": (
            *(f"_SendGoal_{part}" for part in ("Request", "Response", "Event")),
            *(f"_GetResult_{part}" for part in ("Request", "Response", "Event")),
            *("_FeedbackMessage", "_Goal", "_Result", "_Feedback"),
        ),
    },
}


def owners(name: TypeName) -> Iterator[TypeName]:
    """List the interfaces that may have a message of this name, the likeliest first."""
    for suffix in _SUFFIXES[name.dialect][name.kind]:
        base = name.name.removesuffix(suffix)
        if base and base != name.name:
            yield replace(name, name=base)
