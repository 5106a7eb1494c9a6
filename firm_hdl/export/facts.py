"""What an engineer has to know of the converters of a type, for the datasheet and the readme."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from firm_hdl.model import Message, closure
from firm_hdl.plan import Constant, Loop, Plan, Run
from firm_hdl.plan.tree import walk

__all__ = ["contract", "definitions_of", "lengths", "port_groups", "statuses"]

_STATUSES = {
    "OK": ("both", "The packet is a message; the message was written."),
    "TRUNCATED": ("deserializer", "The packet ends before the message does."),
    "TRAILING": ("deserializer", "Bytes follow the message."),
    "LENGTH": ("both", "A length is over its limit."),
    "ENCAPSULATION": ("deserializer", "The packet starts with other bytes than 00 01."),
    "STRING": ("deserializer", "The last byte of a string is not NUL."),
    "ITEMS": ("serializer", "last is set in another transfer than the length implies."),
}


def statuses(plan: Plan, codes: Mapping[str, int]) -> Iterator[tuple[str, ...]]:
    """Yield code, name, converter and meaning of each status that a type can have."""
    has = {
        "LENGTH": bool(plan.lengths),
        "ENCAPSULATION": plan.header_bytes > 0,
        "STRING": any(length.nul for length in plan.lengths.values()),
        "ITEMS": any(leaf.kind == "items" for leaf in plan.leaves),
    }
    for name, code in codes.items():
        if has.get(name, True):
            converter, meaning = _STATUSES[name]
            if name == "TRAILING" and plan.wire == "cdr":
                meaning = "More than three bytes follow the message."
            yield str(code), name, converter, meaning


def lengths(plan: Plan) -> Iterator[tuple[str, ...]]:
    """Yield each length, what it counts, and its limit."""
    for item in walk(plan.items):
        if isinstance(item, Run | Loop) and not isinstance(item.count, Constant):
            what = "elements" if isinstance(item, Loop) else plan.leaves[item.leaf].type
            text = f"{what}, and a NUL" if item.count.nul else what
            yield str(plan.leaves[item.count.leaf]), text, f"{item.count.limit:,}"


def contract(plan: Plan, recovery: Mapping[str, int]) -> Iterator[str]:
    """Yield the rules that a design around the converters has to know, a sentence or two each.

    * `recovery`: as the manifest has it.
    """
    if plan.wire == "cdr":
        yield (
            "The encapsulation header must say CDR, little-endian: 00 01. Its two bytes of options "
            "are not checked. The serializer writes 00 01 00 00."
        )
        yield "Up to three bytes after a message are dropped, and the status is OK."
        yield "Padding may have any value in a packet that comes in. The serializer writes zeros."
    else:
        yield "All numbers are little-endian, and no byte may follow a message."
    if any(length.nul for length in plan.lengths.values()):
        yield "A string whose length on the wire is 0 is taken for the empty string."
    yield (
        "A deserializer gives the fields as their bytes arrive, before it knows the status. So "
        "keep what you do with them until the status is OK, and discard it otherwise."
    )
    yield (
        "Take every field and every status: what is not taken holds later transfers, and at last "
        "the packets. A serializer needs all fields, in the order of the definition."
    )
    yield (
        "All bytes of a beat count, unless tlast is high: then the ones of tkeep from bit 0 up to "
        "the first zero."
    )
    if plan.lengths:
        yield (
            f"max_message_bytes, {plan.max_message_bytes:,}, limits each length. It does not limit "
            "the size of a packet."
        )
    yield (
        f"After a damaged packet, a deserializer completes the message with zeros: in at most "
        f"{recovery['most_cycles']:,} cycles. The longest legal packet takes "
        f"{recovery['longest_packet_cycles']:,}."
    )
    yield (
        "One clock. aresetn is synchronous and active low: one cycle of it discards all packets "
        "and messages inside."
    )


def definitions_of(messages: list[Message]) -> list[tuple[str, str]]:
    """Return names and texts of messages, and of all types in them."""
    names = {message.name for message in messages}
    others = (each for each in closure(messages) if each.package and each.name not in names)
    return [(each.name, each.text) for each in [*messages, *sorted(others, key=str)]]


def port_groups(manifest: Mapping[str, Any]) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Yield the ports of both converters, those of a leaf together, by the path of the leaf."""
    ways = ("deserializer", "serializer")
    found: dict[str, dict[str, Any]] = {}
    for way in ways:
        for port in manifest["converters"][way]["ports"]:
            entry = found.setdefault(port["name"], {**port, **dict.fromkeys(ways, "")})
            entry[way] = port["direction"]
    groups: dict[str, list[dict[str, Any]]] = {}
    for port in sorted(found.values(), key=_place):
        groups.setdefault(port.get("leaf", port["name"]), []).append(port)
    yield from groups.items()


def _place(port: Mapping[str, Any]) -> int:
    """Return the order of ports: clock, reset and packets; leaves; status."""
    return 1 if "leaf" in port else 2 * port["name"].startswith("m_axis_status")
