"""Packets for the test benches of generated VHDL: chosen messages, written by rosbags.

Any type will do, a user's own included: rosbags gets the resolved definitions from the model.
"""

from __future__ import annotations

from typing import Any

from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from firm_hdl.model import Message
from firm_hdl.plan import Plan
from firm_hdl.verify.cases import make_cases
from firm_hdl.verify.oracle import Oracle

__all__ = ["stimuli"]

MOST_PACKETS = 16
MOST_BYTES = 1 << 15
"""Of all packets together, so that a bench takes a second; the first packet may have more."""

_BUILTIN = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}


def stimuli(message: Message, plan: Plan) -> list[bytes]:
    """Return packets of a type; none, if rosbags cannot write the type (it has no `wstring`)."""
    try:
        oracle = Oracle(_store(message), message.dialect)
        cases = make_cases(
            oracle,
            _name(message),
            wire=plan.wire,
            bus_bytes=plan.bus_bytes,
            most=MOST_PACKETS,
        )
        packets: list[bytes] = []
        for case in cases:
            if packets and sum(map(len, packets)) + len(case.packet) > MOST_BYTES:
                break
            if len(case.packet) <= plan.max_message_bytes:
                packets.append(case.packet)
    # What rosbags raises for what it does not know has no common base.
    except Exception:
        return []
    return packets


def _store(message: Message) -> Typestore:
    store = get_typestore(Stores.EMPTY)
    types: dict[str, Any] = {}
    pending, seen = [message], {message.name}
    while pending:
        kind = pending.pop()
        text = "".join(f"{item.type} {item.name}\n" for item in kind.fields)
        if kind.name in _BUILTIN:
            # To rosbags, those of ROS 1 are those of ROS 2; the bytes are the same.
            text = "int32 sec\nuint32 nanosec\n"
        types.update(get_types_from_msg(text, _name(kind)))
        for child in kind.children:
            if child.name not in seen:
                seen.add(child.name)
                pending.append(child)
    store.register(types)
    return store


def _name(message: Message) -> str:
    """Name a type as rosbags does."""
    return _BUILTIN.get(message.name, f"{message.package}/msg/{message.base_name}")
