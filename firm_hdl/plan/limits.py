"""The legal bus widths and message sizes of converters, and what nested lengths may claim.

After an error, a deserializer completes every sequence whose length it has already transferred. If
each length were judged by itself, a packet of 60 bytes could claim `max_message_bytes` once for
each level of nesting. So a sequence and the lengths inside its elements share a budget: the bytes
of the largest packet without those of the shortest one.

No legal packet is refused. Without padding: each length claims bytes that must follow it, its count
times the bytes of the shortest item. The shortest element has 4 bytes for each length inside, and
no items of these lengths, so the items of an inner length are other bytes than those that the outer
length claimed. So the claims of a packet are disjoint parts of it, and the shortest packet, in
which every length is 0, is another part. An element without bytes counts as one byte.

With padding, a loop claims for each element what the shortest one after another shortest one has
(`LoopNode.repeated_bytes`). If `a` is the strictest alignment of the wire, the first element may
have up to a - 1 bytes less. And items that a length inside adds may save padding after them: a part
that starts later never ends earlier, and a part that starts `a` bytes later ends `a` bytes later;
so c bytes more in a part are at least c - (a - 1) bytes more in the whole. So each length claims
2 (a - 1) bytes less than its items have (`Charge.padding_credit`). If no element has padding, none
is claimed, and there is no credit.

A length that claims only a few bytes is not counted, because the check takes some cycles. So each
level of nesting can claim as much beyond the budget. A length that is not nested, and counts no
elements with lengths, is bounded by its own limit: at most one such length is pending.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from firm_hdl.plan.tree import Charge
from firm_hdl.wire import ConstantLength, Layout, LengthField, LoopNode, Node, Path, RunNode, walk

__all__ = [
    "BUS_BYTES",
    "DEFAULT_MAX_MESSAGE_BYTES",
    "charged_from",
    "charges_of",
    "check_bus_bytes",
    "check_max_message_bytes",
    "most_items",
]

BUS_BYTES = (1, 2, 4, 8, 16, 32, 64)
"""Legal widths of the packet bus."""

DEFAULT_MAX_MESSAGE_BYTES = 1 << 24


def charged_from(max_message_bytes: int) -> int:
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

    Raises `TypeError` if the size is not an integer. Raises `ValueError` if no message of the type
    has so few bytes, or the size is above 2**32 - 1.
    """
    # In Python, a bool is an integer, too.
    if not isinstance(max_message_bytes, int) or isinstance(max_message_bytes, bool):
        raise TypeError(f"Maximum message size must be an integer, not {max_message_bytes!r}")
    if layout.least_bytes >= 1 << 32:
        raise ValueError(
            f"Each message has at least {layout.least_bytes} bytes, and at most {(1 << 32) - 1} "
            "are possible"
        )
    if not layout.least_bytes <= max_message_bytes < 1 << 32:
        raise ValueError(
            f"Maximum message size must be from {layout.least_bytes} bytes, the least that a "
            f"{layout.message.name} has, to {(1 << 32) - 1}, not {max_message_bytes!r}"
        )


def most_items(layout: Layout, node: RunNode | LoopNode, max_message_bytes: int) -> int:
    """Return the largest number of items or elements that a packet has room for.

    The NUL of a string is no item. The room is counted without padding, as the shortest packet is.
    For elements, it is also counted with the padding between them. An element without bytes counts
    as one byte, because it has a transfer.
    """
    room = max_message_bytes - layout.least_bytes
    if isinstance(node, RunNode):
        return max(0, (room - node.terminated) // node.item.bytes)
    padded = (room + _credit(layout)) // max(1, node.repeated_bytes)
    return max(0, min(room // max(1, node.min_body_bytes), padded))


def charges_of(layout: Layout, max_message_bytes: int) -> dict[Path, Charge]:
    """Return what the lengths of a layout claim, by the path of the string or sequence.

    Lengths that are not counted are left out: those that cannot claim enough bytes, and those that
    do not share a budget.
    """
    credit = _credit(layout) if any(map(_claims_padding, walk(layout.nodes))) else 0
    budget = max_message_bytes - layout.least_bytes
    least_bytes = charged_from(max_message_bytes)

    def charge(node: RunNode | LoopNode) -> Charge:
        each = node.item.bytes if isinstance(node, RunNode) else max(1, node.repeated_bytes)
        return Charge(bytes=each, charged_from=-(-least_bytes // each), padding_credit=credit)

    charges: dict[Path, Charge] = {}
    for outermost in _outermost(layout.nodes):
        inner = {}
        for node in walk(outermost.body):
            if isinstance(node, RunNode | LoopNode) and isinstance(node.length, LengthField):
                bound, nul = node.length.bound, isinstance(node, RunNode) and node.terminated
                most = most_items(layout, node, max_message_bytes)
                most = nul + (most if bound is None else min(bound, most))
                if most >= charge(node).charged_from:
                    inner[node.path] = charge(node)
        if inner:
            charges[outermost.path] = replace(charge(outermost), budget=budget)
            charges |= inner
    return charges


def _claims_padding(node: Node) -> bool:
    """Tell whether a node is a sequence that claims padding between its elements."""
    if not isinstance(node, LoopNode) or isinstance(node.length, ConstantLength):
        return False
    return node.repeated_bytes > node.min_body_bytes


def _credit(layout: Layout) -> int:
    """Return how many bytes fewer than its items a length claims, if padding is claimed."""
    return 2 * (layout.rules.max_align - 1)


def _outermost(nodes: tuple[Node, ...]) -> Iterator[LoopNode]:
    """Yield the loops that a length counts, and that are in no such loop."""
    for node in nodes:
        match node:
            case LoopNode(length=ConstantLength()):
                yield from _outermost(node.body)
            case LoopNode():
                yield node
