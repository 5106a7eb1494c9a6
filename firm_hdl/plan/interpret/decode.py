"""Decode a packet to transfers, as a deserializer does."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, NamedTuple, TypeAlias

from firm_hdl.plan.interpret.machine import Edge, Machine, Payload, Visit
from firm_hdl.plan.tree import Charge, Fixed, Leaf, Part, Plan, Run

__all__ = ["DecodeStatus", "Decoded", "Transfer", "decode"]

CHECK_CYCLES = 3
"""Cycles for which a deserializer holds the next step, to check what a counted length claims: the
pipeline in `firm_hdl/gateware/parse/budget.py`."""

REFUSAL_CYCLES = 2
"""Cycles in which a deserializer refuses a length that claims too much, and leaves its step: those
4 and 5 in the second wave form of `firm_hdl/gateware/parse/sequencer.py`."""

DecodeStatus: TypeAlias = Literal[
    "OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING"
]


class Transfer(NamedTuple):
    """One transfer of a leaf.

    Attributes
    ----------
    leaf : int
        Index into `Plan.leaves`.
    payload : int or (tuple of int, bool)
        For items: all lanes (lanes past the end are 0), and `last`. For other leaves a number: a
        float as its bits, a `bool` as 0 or 1, a trigger as 1.
    """

    leaf: int
    payload: Payload


@dataclass(frozen=True, slots=True, kw_only=True)
class Decoded:
    """The result of decoding a packet.

    Attributes
    ----------
    transfers : tuple of Transfer
        In wire order, the order in which leaves become valid.
    status : str
        The packet's first error, or ``OK``.
    steps : tuple of Visit
        The cycles that were run, in order.
    edges : frozenset of Edge
        The decisions that were taken.
    """

    transfers: tuple[Transfer, ...]
    status: DecodeStatus
    steps: tuple[Visit, ...]
    edges: frozenset[Edge]

    @property
    def streams(self) -> dict[int, list[Payload]]:
        """The payloads of each leaf that had any, as :func:`encode` takes them."""
        result: dict[int, list[Payload]] = {}
        for leaf, payload in self.transfers:
            result.setdefault(leaf, []).append(payload)
        return result


def decode(plan: Plan, packet: bytes) -> Decoded:
    """Decode a packet as the deserializer of a plan does."""
    reader = _Reader(plan=plan, packet=bytes(packet))
    reader.run()
    if reader.status == "OK" and len(packet) - reader.position > plan.max_trailing_bytes:
        reader.status = "TRAILING"
    return Decoded(
        transfers=tuple(reader.transfers),
        status=reader.status,
        steps=tuple(reader.visits),
        edges=frozenset(reader.edges),
    )


@dataclass(slots=True, kw_only=True)
class _Reader(Machine):
    packet: bytes
    position: int = 0
    status: DecodeStatus = "OK"
    transfers: list[Transfer] = field(default_factory=list)
    # Bytes that counted lengths may still claim.
    budget: int = 0
    # Bytes of the current transfer that earlier parts had.
    partial: bytes = b""

    @property
    def offset(self) -> int:
        return self.position

    def skip(self, count: int) -> None:
        # Missing padding is not an error: the value after it is missing, too.
        self.position += count

    def read(self, count: int) -> bytes:
        """Return the next bytes, or as many as the packet has; none after an error."""
        start = self.position
        self.position += count
        if self.status != "OK":
            return b""
        if self.position > len(self.packet):
            self.status = "TRUNCATED"
        return self.packet[start : self.position]

    def fixed(self, item: Fixed) -> None:
        for expected in item.data:
            got = self.read(1)
            if got and item.check and got[0] != expected:
                self.status = "ENCAPSULATION"

    def part(self, part: Part) -> None:
        if part.first == 0:
            self.partial = b""
        self.partial += self.read(part.bytes)
        if not part.completes:
            return
        leaf = self.plan.leaves[part.leaf]
        if leaf.kind == "trigger":
            payload: Payload = 1
        elif leaf.kind == "items":
            values = _numbers(leaf, self.partial, part.size // leaf.item_bytes)
            payload = (values, self.is_last(part))
        else:
            (payload,) = _numbers(leaf, self.partial, 1)
            if leaf.kind == "length":
                payload = self.count(part.leaf, payload)
        self.transfers.append(Transfer(part.leaf, payload))

    def count(self, leaf: int, wire: int) -> int:
        """Return the payload of a length, and store the length as it is on the wire."""
        given = self.plan.lengths[leaf]
        length = wire - 1 if given.nul and wire else wire
        if length > given.limit or not self.pay(given.charge, wire):
            # After an error, `read` returns nothing and lengths are 0. So this is the first error.
            self.status = "LENGTH"
            wire = length = 0
        self.length = wire
        return length

    def pay(self, charge: Charge | None, wire: int) -> bool:
        """Take what a legal length claims from the budget, and return whether it had enough."""
        if charge is None:
            return True
        if charge.budget is not None:
            self.budget = charge.budget
        if wire < charge.charged_from:
            return True
        self.budget -= wire * charge.bytes - charge.padding_credit
        self.held = CHECK_CYCLES + (REFUSAL_CYCLES if self.budget < 0 else 0)
        return self.budget >= 0

    def items(self, run: Run, count: int, last: bool) -> None:
        leaf = self.plan.leaves[run.leaf]
        values = _numbers(leaf, self.read(count * leaf.item_bytes), count)
        self.transfers.append(Transfer(run.leaf, (values, last)))

    def terminator(self) -> None:
        if self.read(1) not in (b"", b"\0"):
            self.status = "STRING"


def _numbers(leaf: Leaf, data: bytes, count: int) -> tuple[int, ...]:
    """Return a payload's lanes: `count` numbers, 0 for those not wholly in `data`, then 0."""
    size = leaf.item_bytes
    complete = min(count, len(data) // size)
    if leaf.type == "bool":
        values = [int(byte != 0) for byte in data[:complete]]
    elif size == 1 and not leaf.signed:
        values = list(data[:complete])
    else:
        pieces = (data[i * size : (i + 1) * size] for i in range(complete))
        values = [int.from_bytes(piece, "little", signed=leaf.signed) for piece in pieces]
    return (*values, *([0] * (leaf.lanes - complete)))
