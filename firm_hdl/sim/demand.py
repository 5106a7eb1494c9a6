"""How many transfers of each leaf a message has, told by its lengths as they come.

Each length says how many transfers of the leaves right below it follow; so one table, made from the
layout, is enough to know at any time what is still to come, in whatever order the leaves move.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan
from firm_hdl.wire import LoopNode, Node, Path, RunNode, Scalar, Trigger, lay_out

__all__ = ["Demand", "DemandTable", "demand_table", "split_transfers"]


@dataclass(frozen=True, slots=True, kw_only=True)
class DemandTable:
    """What a message, and each length in it, calls for.

    Attributes
    ----------
    start : tuple of (leaf, count)
        Transfers that every message has.
    below : dict of int to tuple of (leaf, count)
        By the leaf of a length: transfers for each of the elements that it counts.
    items : dict of int to (leaf, lanes)
        By the leaf of a length: the items that it counts, so many a transfer.
    """

    start: tuple[tuple[int, int], ...]
    below: dict[int, tuple[tuple[int, int], ...]]
    items: dict[int, tuple[int, int]]


@dataclass(slots=True)
class Demand:
    """What one message still calls for.

    Attributes
    ----------
    table : DemandTable
    left : dict of int to int
        Transfers known to follow, by leaf; leaves without any are left out.
    """

    table: DemandTable
    left: dict[int, int] = field(init=False)

    def __post_init__(self) -> None:
        self.left = {}
        self.add(self.table.start)

    def add(self, counts: Iterable[tuple[int, int]], factor: int = 1) -> None:
        """Call for transfers."""
        for leaf, count in counts:
            if count * factor:
                self.left[leaf] = self.left.get(leaf, 0) + count * factor

    def take(self, leaf: int, payload: Payload) -> None:
        """Note a transfer, which must have been called for."""
        left = self.left[leaf] - 1
        if left:
            self.left[leaf] = left
        else:
            del self.left[leaf]
        if leaf in self.table.below:
            assert isinstance(payload, int)
            self.add(self.table.below[leaf], payload)
        elif leaf in self.table.items:
            assert isinstance(payload, int)
            items, lanes = self.table.items[leaf]
            self.add([(items, -(-payload // lanes))])


def demand_table(plan: Plan, message: Message) -> DemandTable:
    """Return what messages of a type call for, with the leaves of a plan."""
    leaves = {leaf.path: number for number, leaf in enumerate(plan.leaves)}
    below: dict[int, tuple[tuple[int, int], ...]] = {}
    items: dict[int, tuple[int, int]] = {}

    def leaf(path: Path, *kind: str) -> int:
        return leaves[path + kind]

    def visit(nodes: Iterable[Node]) -> Iterator[tuple[int, int]]:
        for node in nodes:
            match node:
                case Scalar():
                    yield leaf(node.path), 1
                case Trigger():
                    yield leaf(node.path, "trigger"), 1
                case RunNode(count=None):
                    number = leaf(node.path, "items")
                    items[leaf(node.path, "length")] = (number, plan.leaves[number].lanes)
                    yield leaf(node.path, "length"), 1
                case RunNode(count=int(count)):
                    number = leaf(node.path, "items")
                    yield number, -(-count // plan.leaves[number].lanes)
                case LoopNode(count=None):
                    below[leaf(node.path, "length")] = tuple(visit(node.body))
                    yield leaf(node.path, "length"), 1
                case LoopNode(count=int(count)):
                    yield from ((inner, each * count) for inner, each in visit(node.body))

    start = tuple(visit(lay_out(message, plan.wire).nodes))
    return DemandTable(start=start, below=below, items=items)


def split_transfers(
    table: DemandTable, transfers: Mapping[int, Iterable[Payload]]
) -> tuple[list[dict[int, list[Payload]]], Demand]:
    """Cut the transfers of a number of messages, given by leaf, into those of each message.

    Returns
    -------
    messages : list of dict
        Transfers of the messages that are complete; leaves without any are left out.
    demand : Demand
        What the message after those still calls for.
    """
    rest = {leaf: list(reversed(list(given))) for leaf, given in transfers.items()}
    messages: list[dict[int, list[Payload]]] = []
    while True:
        demand = Demand(table)
        message: dict[int, list[Payload]] = {}
        while ready := [leaf for leaf in demand.left if rest.get(leaf)]:
            for leaf in ready:
                for _ in range(min(demand.left[leaf], len(rest[leaf]))):
                    payload = rest[leaf].pop()
                    demand.take(leaf, payload)
                    message.setdefault(leaf, []).append(payload)
        if demand.left:
            return messages, demand
        messages.append(message)
