"""The outline of a layout: what a parser has to know of a message, without its values.

Only lengths decide how a packet continues and whether it is good. The fields between two lengths
have a fixed size. In the outline, they are an array of bytes. A plan of the outline has one or two
steps for this array instead of one per bus word. Lengths, their bounds, alignment
and the size of the smallest message are those of the layout, so that both plans give every packet
the same status.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count

from firm_hdl.model import PRIMITIVES
from firm_hdl.wire import (
    ConstantLength,
    Gap,
    Layout,
    LoopNode,
    Node,
    Path,
    RunNode,
    Scalar,
    Trigger,
)
from firm_hdl.wire.alignment import OCTET

__all__ = ["outline"]

NO_GAP = Gap(align=1, bytes=0)


def outline(layout: Layout, bus_bytes: int) -> Layout:
    """Return a layout with the same lengths, and with bytes in place of all else.

    * `bus_bytes`: bytes are cut so that a plan for a bus of this width has few steps.
    """
    numbers = count()
    nodes = tuple(_outline(layout.nodes, bus_bytes, numbers))
    # A plan has at least one step.
    return replace(layout, nodes=nodes or (Trigger(path=_path(numbers)),))


@dataclass(slots=True)
class _Stretch:
    """Bytes in a row: the padding before them, and their number."""

    gap: Gap
    bytes: int


def _outline(nodes: tuple[Node, ...], bus_bytes: int, numbers: Iterator[int]) -> Iterator[Node]:
    pending: _Stretch | None = None
    for node in nodes:
        fixed = _fixed(node)
        if fixed is not None and pending is not None and fixed.gap.bytes is not None:
            pending.bytes += fixed.gap.bytes + fixed.bytes
            continue
        if pending is not None:
            yield from _bytes(pending, bus_bytes, numbers)
        pending = fixed
        if isinstance(node, LoopNode) and fixed is None:
            body = tuple(_outline(node.body, bus_bytes, numbers))
            # An element without bytes becomes a trigger: the number of elements is still checked.
            yield replace(node, body=body or (Trigger(path=_path(numbers)),))
        elif fixed is None:
            yield node
    if pending is not None:
        yield from _bytes(pending, bus_bytes, numbers)


def _bytes(stretch: _Stretch, bus_bytes: int, numbers: Iterator[int]) -> Iterator[Node]:
    """Yield a stretch as arrays of bytes.

    An array of many bytes is a run: one step for any number of bus words, but no other bytes can be
    in this step. So the first bytes are an array of their own, which shares a step with others.
    """
    gap, remaining = stretch.gap, stretch.bytes
    if gap.bytes != 0:
        # Padding stands only before a value that needs the alignment. The first field of the
        # stretch is such a value, so the stretch has at least `align` bytes.
        number = PRIMITIVES["ros2"][f"uint{8 * gap.align}"]
        yield Scalar(path=_path(numbers), gap=gap, type=number)
        gap, remaining = NO_GAP, remaining - gap.align
    if remaining > 4 * bus_bytes:
        sizes = [bus_bytes, remaining - bus_bytes]
    else:
        sizes = [min(bus_bytes, remaining - at) for at in range(0, remaining, bus_bytes)]
    for size in sizes:
        yield _array(size, gap, numbers)
        gap = NO_GAP


def _array(size: int, gap: Gap, numbers: Iterator[int]) -> RunNode:
    return RunNode(
        path=_path(numbers),
        length=ConstantLength(count=size),
        item_gap=gap,
        item=OCTET,
        terminated=False,
    )


def _path(numbers: Iterator[int]) -> Path:
    # No field of a message has such a name.
    return (f"bytes {next(numbers)}",)


def _fixed(node: Node) -> _Stretch | None:
    """Return a node as a stretch if its size, and any padding inside, is always the same."""
    match node:
        case Scalar():
            return _Stretch(node.gap, node.type.bytes)
        case Trigger():
            return _Stretch(NO_GAP, 0)
        case RunNode(length=ConstantLength(count=size)):
            return _Stretch(node.item_gap, size * node.item.bytes)
        case LoopNode(length=ConstantLength(count=size)):
            return _fixed_loop(node, size)
        case _:
            return None


def _fixed_loop(node: LoopNode, times: int) -> _Stretch | None:
    """Return a loop as a stretch if the padding in and between its elements is always the same."""
    found: _Stretch | None = None
    for part in node.body:
        fixed = _fixed(part)
        if fixed is None or (found is not None and fixed.gap.bytes is None):
            return None
        if found is None:
            found = fixed
        else:
            assert fixed.gap.bytes is not None
            found.bytes += fixed.gap.bytes + fixed.bytes
    assert found is not None
    # A gap of the layout holds for every element. So the gap before the first value of the body is
    # also the one between two elements.
    between = 0 if times == 1 else found.gap.bytes
    if between is None:
        return None
    return replace(found, bytes=times * found.bytes + (times - 1) * between)
