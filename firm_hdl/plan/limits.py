"""The legal bus widths and message sizes of converters, and what nested lengths may claim.

After an error, a deserializer completes every sequence whose length it has already transferred. If
each length were judged by itself, a packet of 60 bytes could claim `max_message_bytes` once for
each level of nesting. So a sequence and the lengths inside its elements share a budget: the bytes
of the largest packet without those of the shortest one.

No legal packet is refused. Each length claims bytes that must follow it: its count times the bytes
of the shortest item. The shortest element has 4 bytes for each length inside, and no items of these
lengths, so the items of an inner length are other bytes than those that the outer length claimed.
So the claims of a packet are disjoint parts of it, and the shortest packet, in which every length
is 0, is another part. Padding only adds to the packet. An element without bytes counts as one byte,
as in the limit of each length.

A length that claims only a few bytes is not counted, because the check takes some cycles. So each
level of nesting can claim as much beyond the budget. A length that is not nested, and counts no
elements with lengths, is bounded by its own limit: at most one such length is pending.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.plan.ir import Claim
from firm_hdl.wire import ConstantLength, Layout, LengthField, LoopNode, Node, Path, RunNode

__all__ = [
    "BUS_BYTES",
    "DEFAULT_MAX_MESSAGE_BYTES",
    "check_bus_bytes",
    "check_max_message_bytes",
    "claims_of",
    "counted_from",
]

BUS_BYTES = (1, 2, 4, 8, 16, 32, 64)
"""Legal widths of the packet bus."""

DEFAULT_MAX_MESSAGE_BYTES = 1 << 24


def counted_from(max_message_bytes: int) -> int:
    """Return the least bytes that a nested length must claim to be counted in the budget.

    A counted length costs a deserializer some cycles, which are few compared with 4,096 bytes: 512
    cycles on a bus of 8 bytes. What is not counted must be little compared with the largest packet.
    So the number is a 16th of that packet, but at least 256 and at most 4,096.
    """
    return min(4096, max(256, max_message_bytes // 16))


def check_bus_bytes(bus_bytes: int) -> None:
    """Check the width of the packet bus.

    Raises
    ------
    TypeError
        If the width is not an integer.
    ValueError
        If the width is not one of `BUS_BYTES`.
    """
    if not isinstance(bus_bytes, int) or isinstance(bus_bytes, bool):
        raise TypeError(f"Bus width must be an integer, not {bus_bytes!r}")
    if bus_bytes not in BUS_BYTES:
        raise ValueError(
            f"Bus width must be one of {', '.join(map(str, BUS_BYTES))} bytes, not {bus_bytes!r}"
        )


def check_max_message_bytes(layout: Layout, max_message_bytes: int) -> None:
    """Check the size of the longest packet that the converters of a layout take.

    Raises
    ------
    TypeError
        If the size is not an integer.
    ValueError
        If no message of the type has so few bytes, or the size is above 2**32 - 1.
    """
    # In Python, a bool is an integer, too.
    if not isinstance(max_message_bytes, int) or isinstance(max_message_bytes, bool):
        raise TypeError(f"Maximum message size must be an integer, not {max_message_bytes!r}")
    if layout.min_bytes >= 1 << 32:
        raise ValueError(
            f"Each message has at least {layout.min_bytes} bytes, and at most {(1 << 32) - 1} are "
            "possible"
        )
    if not layout.min_bytes <= max_message_bytes < 1 << 32:
        raise ValueError(
            f"Maximum message size must be from {layout.min_bytes} bytes, the least that a "
            f"{layout.message.name} has, to {(1 << 32) - 1}, not {max_message_bytes!r}"
        )


def claims_of(layout: Layout, max_message_bytes: int) -> dict[Path, Claim]:
    """Return what the lengths of a layout claim, by the path of the string or sequence.

    Lengths that are not counted are left out: those that cannot claim enough bytes, and those that
    do not share a budget.
    """
    total = max_message_bytes - layout.min_bytes
    least_bytes = counted_from(max_message_bytes)
    return dict(_outermost(layout.nodes, total, least_bytes))


def _outermost(
    nodes: tuple[Node, ...], total: int, least_bytes: int
) -> Iterator[tuple[Path, Claim]]:
    """Yield the claims of nodes that are in no sequence."""
    for node in nodes:
        match node:
            case LoopNode(length=ConstantLength()):
                yield from _outermost(node.body, total, least_bytes)
            case LoopNode():
                inner = list(_inside(node.body, total, least_bytes))
                if inner:
                    each = max(1, node.min_body_bytes)
                    yield node.path, Claim(bytes=each, least=-(-least_bytes // each), total=total)
                    yield from inner


def _inside(nodes: tuple[Node, ...], total: int, least_bytes: int) -> Iterator[tuple[Path, Claim]]:
    """Yield the claims of the nodes of an element of a sequence."""
    for node in nodes:
        match node:
            case RunNode(length=LengthField(bound=bound)):
                each, nul = node.item.bytes, int(node.terminated)
            case LoopNode(length=LengthField(bound=bound)):
                each, nul = max(1, node.min_body_bytes), 0
            case _:
                bound, each, nul = 0, 1, 0
        least = -(-least_bytes // each)
        most = total // each
        if least <= (most if bound is None else min(bound + nul, most)):
            yield node.path, Claim(bytes=each, least=least)
        if isinstance(node, LoopNode):
            yield from _inside(node.body, total, least_bytes)
