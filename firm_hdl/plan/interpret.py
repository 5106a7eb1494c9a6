"""A plan run in plain Python: the golden model of the gateware.

Both directions follow the plan's steps (slices, starts, runs, exits, dynamic alignment) and never
look at the layout, so a plan that is wrong gives wrong results here. What happens is exact to
the primitive and does not depend on the bus width: a packet's first error is the first one in wire
order, whatever cycle the hardware sees it in (docs/interface.md, "Status").
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, TypeAlias

from firm_hdl.plan.ir import (
    RUN_COUNTER,
    BeginArray,
    BeginLoop,
    CountedBegin,
    Exits,
    Fixed,
    Jump,
    Leaf,
    MapStep,
    Pad,
    Part,
    Plan,
    Run,
    RunStep,
    Take,
)

__all__ = [
    "DecodeStatus",
    "Decoded",
    "Edge",
    "EncodeStatus",
    "Payload",
    "Transfer",
    "Visit",
    "decode",
    "encode",
]

Payload: TypeAlias = "int | tuple[tuple[int, ...], bool]"
"""What one transfer carries: a number, or for items all lanes and `last`."""

DecodeStatus: TypeAlias = Literal[
    "OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING"
]
EncodeStatus: TypeAlias = Literal["OK", "LENGTH", "ITEMS"]


class Transfer(NamedTuple):
    """One transfer of a leaf.

    Attributes
    ----------
    leaf : int
        Index into `Plan.leaves`.
    payload : int or (tuple of int, bool)
        For items: all lanes (those past the end 0), and `last`. For the others a number: floats as
        their bits, a `bool` as 0 or 1, a trigger as 1.
    """

    leaf: int
    payload: Payload


class Visit(NamedTuple):
    """One cycle of a plan: the step, and the bytes it takes, padding in front of it left out."""

    step: int
    bytes: int


class Edge(NamedTuple):
    """A decision that a plan leaves to the packet.

    Attributes
    ----------
    step : int
    way : str
        ``padding N``: the step was aligned by skipping N bytes. ``again``: the body of a run was
        repeated. ``body``: what the step starts goes on elsewhere. ``loop N again`` and ``next``:
        the exit that was taken.
    """

    step: int
    way: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Decoded:
    """What a packet decodes to.

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
    reader.go()
    if reader.status == "OK" and len(packet) - reader.position > plan.slack_bytes:
        reader.status = "TRAILING"
    return Decoded(
        transfers=tuple(reader.transfers),
        status=reader.status,
        steps=tuple(reader.visits),
        edges=frozenset(reader.edges),
    )


def encode(
    plan: Plan, streams: Mapping[int, Iterable[Payload]], *, bare_strings: bool = False
) -> tuple[bytes, EncodeStatus]:
    """Encode a message as the serializer of a plan does.

    Parameters
    ----------
    plan : Plan
    streams : mapping of int to iterable
        Payloads by index of the leaf. Iterators are advanced by what one message takes, so that
        calls with the same iterators give one packet each.
    bare_strings : bool
        Whether to write an empty CDR string as the length 0, without its NUL. Serializers never
        do, but ROS 2 and the deserializer read it.

    Returns
    -------
    packet : bytes
        What the lengths promise, even if the status is not ``OK``.
    status : str
        ``OK``, or the first error in wire order.

    Raises
    ------
    ValueError
        If a leaf has fewer transfers than its length promises, or a payload does not fit its leaf.
    """
    iterators = {leaf: iter(given) for leaf, given in streams.items()}
    writer = _Writer(plan=plan, streams=iterators, bare_strings=bare_strings)
    writer.go()
    return bytes(writer.packet), writer.status


@dataclass(slots=True, kw_only=True)
class _Machine(ABC):
    """The control flow of a plan, common to both directions."""

    plan: Plan
    counters: dict[int | str, int] = field(default_factory=dict)
    # The value of the latest length: items on the wire, a NUL included.
    length: int = 0
    visits: list[Visit] = field(default_factory=list)
    edges: set[Edge] = field(default_factory=set)
    # What each length counts; its first bytes may be some steps before that starts.
    begins: dict[int, CountedBegin] = field(init=False)

    def __post_init__(self) -> None:
        self.begins = self.plan.counted

    @property
    @abstractmethod
    def offset(self) -> int:
        """Bytes of the packet in front of here."""

    @abstractmethod
    def skip(self, count: int) -> None:
        """Pass over padding."""

    @abstractmethod
    def fixed(self, item: Fixed) -> None:
        """Pass bytes that are the same in every packet."""

    @abstractmethod
    def part(self, part: Part) -> None:
        """Pass a part of a transfer."""

    @abstractmethod
    def items(self, run: Run, count: int, last: bool) -> None:
        """Pass one transfer of a run, of `count` items."""

    @abstractmethod
    def terminator(self) -> None:
        """Pass a string's NUL."""

    def go(self) -> None:
        """Run the plan from start to end."""
        now = self.enter(self.plan.start)
        while now is not None:
            now = self.step(now)

    def enter(self, jump: Jump) -> int | None:
        self.counters.update(jump.enter)
        return jump.step

    def step(self, index: int) -> int | None:
        """Run one step, all repetitions of a run's body included, and return the next one."""
        step = self.plan.steps[index]
        if step.align != 1:
            padding = (self.plan.header_bytes - self.offset) % step.align
            self.edges.add(Edge(index, f"padding {padding}"))
            self.skip(padding)
        start = self.offset
        for item in step.slices:
            match item:
                case Pad():
                    self.skip(item.bytes)
                case Fixed():
                    self.fixed(item)
                case Part():
                    self.part(item)
        if isinstance(step, RunStep):
            while self.counters[RUN_COUNTER]:
                start = self.offset
                self.take(step.take)
                self.visits.append(Visit(index, self.offset - start))
                if self.counters[RUN_COUNTER]:
                    self.edges.add(Edge(index, "again"))
            return self.leave(index, step.exits)
        body = self.begin(step)
        self.visits.append(Visit(index, self.offset - start))
        if body is None:
            return self.leave(index, step.exits)
        self.edges.add(Edge(index, "body"))
        return self.enter(body)

    def leave(self, index: int, exits: Exits) -> int | None:
        for level, jump in exits.repeats:
            if self.counters[level] > 1:
                self.counters[level] -= 1
                self.edges.add(Edge(index, f"loop {level} again"))
                return self.enter(jump)
        self.edges.add(Edge(index, "next"))
        return self.enter(exits.default)

    def begin(self, step: MapStep) -> Jump | None:
        """Start what a count counts, and return where it goes on, if it does."""
        begin = step.begin
        if begin is None:
            return None
        count = begin.count if isinstance(begin, BeginArray) else self.length
        if not count:
            return None
        if isinstance(begin, BeginLoop):
            self.counters[begin.level] = count
            return begin.body
        self.counters[RUN_COUNTER] = count
        self.skip(begin.gap)
        if step.take is not None:
            self.take(step.take)
        if not self.counters[RUN_COUNTER]:
            return None
        if begin.body is None:
            raise ValueError("The plan starts a run that needs a body but has none")
        return begin.body

    def take(self, take: Take) -> None:
        """Do one cycle of a run: its rest if that fits in the head, else all lanes."""
        run = self.plan.runs[take.run]
        leaf = self.plan.leaves[run.items]
        left = self.counters[RUN_COUNTER]
        finish = left * leaf.item_bytes <= take.head
        count = left if finish else leaf.lanes
        after = left - count
        self.counters[RUN_COUNTER] = after
        nul = 1 if run.terminated else 0
        real = count - (nul if finish else 0)
        if real:
            self.items(run, real, run.last and after <= nul)
        if finish and nul:
            self.terminator()

    def is_last(self, part: Part) -> bool:
        """Return whether a transfer of items is the last of its leaf."""
        return part.last or (part.last_level is not None and self.counters[part.last_level] == 1)


@dataclass(slots=True, kw_only=True)
class _Reader(_Machine):
    packet: bytes
    position: int = 0
    status: DecodeStatus = "OK"
    transfers: list[Transfer] = field(default_factory=list)
    # What was read of the transfer under way.
    partial: bytes = b""

    @property
    def offset(self) -> int:
        return self.position

    def skip(self, count: int) -> None:
        # Missing padding is no error by itself; what it is in front of will be missing, too.
        self.position += count

    def read(self, count: int) -> bytes:
        """Return the next bytes, or those that are there; none after an error."""
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
            if part.leaf in self.begins:
                payload = self.count(self.begins[part.leaf], payload)
        self.transfers.append(Transfer(part.leaf, payload))

    def count(self, begin: CountedBegin, wire: int) -> int:
        """Return what a length transfers as, and remember what it means on the wire."""
        length = wire - 1 if self.plan.has_nul(begin) and wire else wire
        if length > begin.limit:
            # A length is read whole or is 0, so there was no error before.
            self.status = "LENGTH"
            wire = length = 0
        self.length = wire
        return length

    def items(self, run: Run, count: int, last: bool) -> None:
        leaf = self.plan.leaves[run.items]
        values = _numbers(leaf, self.read(count * leaf.item_bytes), count)
        self.transfers.append(Transfer(run.items, (values, last)))

    def terminator(self) -> None:
        if self.read(1) not in (b"", b"\0"):
            self.status = "STRING"


@dataclass(slots=True, kw_only=True)
class _Writer(_Machine):
    streams: Mapping[int, Iterator[Payload]]
    bare_strings: bool
    status: EncodeStatus = "OK"
    packet: bytearray = field(default_factory=bytearray)
    # All bytes of the transfer under way.
    whole: bytes = b""

    @property
    def offset(self) -> int:
        return len(self.packet)

    def skip(self, count: int) -> None:
        self.packet += bytes(count)

    def fixed(self, item: Fixed) -> None:
        self.packet += item.data

    def fail(self, status: EncodeStatus) -> None:
        if self.status == "OK":
            self.status = status

    def receive(self, index: int) -> Payload:
        for payload in self.streams.get(index, iter(())):
            return payload
        raise ValueError(f"Leaf {self.plan.leaves[index]} has fewer transfers than are needed")

    def part(self, part: Part) -> None:
        leaf = self.plan.leaves[part.leaf]
        if part.first == 0:
            if leaf.kind == "items":
                count = part.size // leaf.item_bytes
                self.whole = self.lanes(part.leaf, count, self.is_last(part))
            else:
                self.whole = self.number(part.leaf)
        self.packet += self.whole[part.first : part.first + part.bytes]

    def number(self, index: int) -> bytes:
        leaf = self.plan.leaves[index]
        payload = self.receive(index)
        if not isinstance(payload, int):
            raise ValueError(f"Leaf {leaf} takes a number, not {payload!r}")
        if index in self.begins:
            begin = self.begins[index]
            if payload > begin.limit:
                self.fail("LENGTH")
            has_nul = self.plan.has_nul(begin) and (payload or not self.bare_strings)
            payload += 1 if has_nul else 0
            self.length = payload
        return _bytes(leaf, payload)

    def lanes(self, index: int, count: int, last: bool) -> bytes:
        leaf = self.plan.leaves[index]
        payload = self.receive(index)
        if isinstance(payload, int) or len(payload[0]) < count:
            raise ValueError(f"Leaf {leaf} takes at least {count} lanes and last, not {payload!r}")
        values, given = payload
        if given != last:
            self.fail("ITEMS")
        return b"".join(_bytes(leaf, value) for value in values[:count])

    def items(self, run: Run, count: int, last: bool) -> None:
        self.packet += self.lanes(run.items, count, last)

    def terminator(self) -> None:
        self.packet.append(0)


def _numbers(leaf: Leaf, data: bytes, count: int) -> tuple[int, ...]:
    """Return a payload's lanes: `count` numbers, 0 for those not wholly in `data`, then 0."""
    size = leaf.item_bytes
    there = min(count, len(data) // size)
    if leaf.type == "bool":
        values = [int(byte != 0) for byte in data[:there]]
    elif size == 1 and not leaf.signed:
        values = list(data[:there])
    else:
        pieces = (data[i * size : (i + 1) * size] for i in range(there))
        values = [int.from_bytes(piece, "little", signed=leaf.signed) for piece in pieces]
    return (*values, *([0] * (leaf.lanes - there)))


def _bytes(leaf: Leaf, value: int) -> bytes:
    """Return a number as it stands on the wire, cut to the width of its leaf."""
    bits = min(1 if leaf.type == "bool" else 64, 8 * leaf.item_bytes)
    return (value & ((1 << bits) - 1)).to_bytes(leaf.item_bytes, "little")
