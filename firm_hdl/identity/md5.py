"""The md5 sum by which ROS 1 distinguishes versions of a type.

genmsg computes the sum over the definition without comments, constants first, in which each message
type is replaced by its own sum. For a service, the texts of request and response are concatenated.
genmsg 0.6.0, ``gentools.compute_md5``, is the reference. ROS 2 has no md5 sums.
"""

from __future__ import annotations

import hashlib

from firm_hdl.model import Message, Service, closure

__all__ = ["md5sum"]


def md5sum(interface: Message | Service) -> str:
    """Compute the md5 sum of a message or a service of ROS 1.

    Actions have none; their messages do.

    Raises `ValueError` if the definition is of ROS 2.
    """
    if interface.dialect != "ros1":
        raise ValueError(f"Only types of ROS 1 have md5 sums, and {interface} is of ROS 2")
    if isinstance(interface, Service):
        parts = [interface.request, interface.response]
    else:
        parts = [interface]
    sums: dict[str, str] = {}
    for message in closure(parts):
        sums[message.name] = _digest(_text(message, sums))
    return _digest("".join(_text(message, sums) for message in parts))


def _digest(text: str) -> str:
    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()


def _text(message: Message, sums: dict[str, str]) -> str:
    lines = [f"{item.type} {item.name}={item.text}" for item in message.constants]
    for field in message.fields:
        kind = field.element_type
        # The builtin types `time` and `duration` have no package, and are written by name.
        is_nested = isinstance(kind, Message) and kind.package != ""
        lines.append(f"{sums[str(kind)] if is_nested else field.type_text} {field.name}")
    # As in genmsg. Only a string constant that was not read from a text can end in blanks.
    return "\n".join(lines).strip()
