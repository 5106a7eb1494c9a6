"""Count, split and join the transfers of messages.

Each length determines the number of transfers of the leaves directly below it. A table, made from
the layout, has these relations. It gives the transfers that a message still requires, in whatever
order its leaves transfer.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan
from firm_hdl.wire import (
    ConstantLength,
    LengthField,
    LoopNode,
    Node,
    Path,
    RunNode,
    Scalar,
    Trigger,
    lay_out,
)

__all__ = [
    "PendingTransfers",
    "TransferTable",
    "checked_transfers",
    "join_transfers",
    "split_transfers",
    "transfer_table",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class TransferTable:
    """The transfers that a message requires, and those that each length in it adds."""

    start: tuple[tuple[int, int], ...]  # Transfers that every message has.
    # For the leaf of a length: the transfers for each element that the length counts.
    below: dict[int, tuple[tuple[int, int], ...]]
    # For the leaf of a length: the leaf of the items that it counts, and the items per transfer.
    items: dict[int, tuple[int, int]]


@dataclass(slots=True)
class PendingTransfers:
    """The transfers that one message still requires."""

    table: TransferTable
    # Transfers known to follow, by leaf; leaves without any are absent.
    counts: dict[int, int] = field(init=False)

    def __post_init__(self) -> None:
        self.counts = {}
        self.add(self.table.start)

    def add(self, counts: Iterable[tuple[int, int]], factor: int = 1) -> None:
        """Require more transfers: `factor` times the counts."""
        for leaf, count in counts:
            if count * factor:
                self.counts[leaf] = self.counts.get(leaf, 0) + count * factor

    def take(self, leaf: int, payload: Payload) -> None:
        """Note a transfer, which must have been required."""
        left = self.counts[leaf] - 1
        if left:
            self.counts[leaf] = left
        else:
            del self.counts[leaf]
        if leaf in self.table.below:
            assert isinstance(payload, int)
            self.add(self.table.below[leaf], payload)
        elif leaf in self.table.items:
            assert isinstance(payload, int)
            items, lanes = self.table.items[leaf]
            self.add([(items, -(-payload // lanes))])


def transfer_table(plan: Plan, message: Message) -> TransferTable:
    """Return the transfers that messages of a type require, with the leaves of a plan."""
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
                case RunNode(length=LengthField()):
                    number = leaf(node.path, "items")
                    items[leaf(node.path, "length")] = (number, plan.leaves[number].lanes)
                    yield leaf(node.path, "length"), 1
                case RunNode(length=ConstantLength(count=count)):
                    number = leaf(node.path, "items")
                    yield number, -(-count // plan.leaves[number].lanes)
                case LoopNode(length=LengthField()):
                    below[leaf(node.path, "length")] = tuple(visit(node.body))
                    yield leaf(node.path, "length"), 1
                case LoopNode(length=ConstantLength(count=count)):
                    yield from ((inner, each * count) for inner, each in visit(node.body))

    start = tuple(visit(lay_out(message, plan.wire).nodes))
    return TransferTable(start=start, below=below, items=items)


def checked_transfers(
    plan: Plan, message: Mapping[int, Sequence[Payload]]
) -> Mapping[int, Sequence[Payload]]:
    """Return a user's transfers of a message, with checked types; values may be wrong on purpose.

    Raises `TypeError` or `ValueError`.
    """
    if not isinstance(message, Mapping):
        raise TypeError(f"Transfers must be a dict of lists by leaf, not {message!r}")
    for number, payloads in message.items():
        if number not in range(len(plan.leaves)):
            last = len(plan.leaves) - 1
            raise ValueError(f"{plan.message} has the leaves 0 to {last}, not {number!r}")
        leaf = plan.leaves[number]
        kind = tuple if leaf.kind == "items" else int
        if not isinstance(payloads, Iterable) or not all(isinstance(p, kind) for p in payloads):
            what = "tuples of lanes and `last`" if kind is tuple else "integers"
            raise TypeError(f"{leaf} takes a list of {what}, not {payloads!r}")
    return message


def split_transfers(
    table: TransferTable, transfers: Mapping[int, Iterable[Payload]]
) -> tuple[list[dict[int, list[Payload]]], PendingTransfers]:
    """Split the transfers of several messages, given by leaf, into those of each message.

    Returns
    -------
    messages : list of dict
        Transfers of the messages that are complete; leaves without any are absent.
    pending : PendingTransfers
        The transfers that the next message still requires.
    """
    rest = {leaf: list(reversed(list(given))) for leaf, given in transfers.items()}
    messages: list[dict[int, list[Payload]]] = []
    while True:
        pending = PendingTransfers(table)
        message: dict[int, list[Payload]] = {}
        while ready := [leaf for leaf in pending.counts if rest.get(leaf)]:
            for leaf in ready:
                for _ in range(min(pending.counts[leaf], len(rest[leaf]))):
                    payload = rest[leaf].pop()
                    pending.take(leaf, payload)
                    message.setdefault(leaf, []).append(payload)
        if pending.counts:
            return messages, pending
        messages.append(message)


def join_transfers(messages: Iterable[Mapping[int, Sequence[Payload]]]) -> dict[int, list[Payload]]:
    """Return the transfers of several messages, in the order of the messages."""
    joined: dict[int, list[Payload]] = {}
    for message in messages:
        for leaf, payloads in message.items():
            joined.setdefault(leaf, []).extend(payloads)
    return joined
