"""In which cycle converters are done with each packet, if packets come back to back.

Both converters execute a step per cycle, and the bus moves a beat per cycle. Between steps and bus
is a ring of beats. So packets take as many cycles as they have beats or steps, whichever is more,
as long as the ring is large enough where one of the two is faster for a while.

``tests/gateware/test_throughput.py`` compares each packet with the circuits. Latencies are left
out: they are constants of the circuits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, inf

from firm_hdl.plan.geometry import first_step, may_end_empty, most_beats, only_ends, ring_beats
from firm_hdl.plan.interpret import Visit, decode
from firm_hdl.plan.ir import BeginRun, Plan, RunStep

__all__ = [
    "Packet",
    "cycles_between",
    "deserializer_cycles",
    "packet_of",
    "serializer_cycles",
]

FREED_AFTER = 5
"""Cycles from the deserializer's last step with a beat to the beat that takes its place."""

REPEATED_LENGTH = 2
"""Cycles from a length that the serializer takes to the next one of the same leaf, at least."""

ROOM_AFTER = 2
"""Cycles from the serializer's beat that leaves the ring to the step that can take its place."""

COMPLETE_AFTER = 2
"""Cycles from the serializer's step that completes a beat to the beat that leaves the ring."""

SETTLED_BEATS = 32
"""After so many beats, a packet that is repeated takes as many cycles each time, on average."""


@dataclass(frozen=True, slots=True)
class Packet:
    """A packet without errors, as far as its cycles depend on it.

    Attributes
    ----------
    plan : Plan
    visits : tuple of Visit
        Its steps.
    bytes : int
    """

    plan: Plan
    visits: tuple[Visit, ...]
    bytes: int

    @property
    def beats(self) -> int:
        """Number of beats; an empty packet has one."""
        return max(1, -(-self.bytes // self.plan.bus_bytes))

    def aligned_items(self, index: int) -> int:
        """Return the alignment of the items that a step counts; 1 if there are none."""
        begin = self.plan.steps[self.visits[index].step].begin
        if not isinstance(begin, BeginRun):
            return 1
        following = self.visits[index + 1]
        after = self.plan.steps[following.step]
        is_some = isinstance(after, RunStep) or following.bytes > after.bytes
        return begin.align if is_some else 1

    def next_start(self, index: int) -> int:
        """Return where the step after another one starts, or the items that it counts."""
        end = self.visits[index].end
        return end + (self.plan.header_bytes - end) % self.aligned_items(index)


def packet_of(plan: Plan, packet: bytes) -> Packet:
    """Take a packet's steps from the interpreter."""
    return Packet(plan, decode(plan, packet).steps, len(packet))


def cycles_between(packet: Packet) -> int:
    """Return the cycles from one packet to the next, if it is repeated.

    These are of the converter that takes more, and the average, rounded up.
    """
    count = ceil(SETTLED_BEATS / packet.beats)
    converters: list[Callable[[Sequence[Packet]], list[int]]]
    converters = [deserializer_cycles, serializer_cycles]
    ends = [cycles([packet] * (2 * count)) for cycles in converters]
    return max(ceil((each[-1] - each[count - 1]) / count) for each in ends)


def deserializer_cycles(packets: Sequence[Packet]) -> list[int]:
    """Return the cycle in which a deserializer executes the last step of each packet.

    Cycle 0 is that of the first beat. The packet's status is valid a latency later. All that comes
    out is taken at once.
    """
    # Cycles of the beats; first beat and cycle of each step.
    beats: list[int] = []
    steps: list[tuple[int, int]] = []
    ends: list[int] = []
    past = base = 0
    for packet in packets:
        ring = ring_beats(packet.plan.bus_bytes)
        for first, last in _reads(packet):
            while len(beats) <= base + last:
                # A beat takes the place of one that no step needs any more.
                while past < len(steps) and steps[past][0] <= len(beats) - ring:
                    past += 1
                free = steps[past - 1][1] + FREED_AFTER if past else 0
                beats.append(max([free, *(cycle + 1 for cycle in beats[-1:])]))
            cycle = max([beats[base + last], *(cycle + 1 for _, cycle in steps[-1:])])
            steps.append((base + first, cycle))
        ends.append(steps[-1][1])
        base += packet.beats
    return ends


def _reads(packet: Packet) -> list[tuple[int, int]]:
    """Return the first and the last beat of each step of a deserializer."""
    bus, visits = packet.plan.bus_bytes, packet.visits
    starts = [0, *(packet.next_start(index) for index in range(len(visits) - 1))]
    beats = [
        (start // bus, max(0, -(-visit.end // bus) - 1))
        for start, visit in zip(starts, visits, strict=True)
    ]
    last = packet.beats - 1
    if packet.plan.steps[visits[-1].step].begin is None:
        # Whether bytes follow the message shows in the last beat.
        beats[-1] = (beats[-1][0], last)
    else:
        # A length of 0 ends the packet, which is known too late: the end is a step of its own.
        beats.append((visits[-1].end // bus, last))
    return beats


@dataclass(frozen=True, slots=True)
class _Write:
    """A step of a serializer, with positions in beats of the packet.

    Attributes
    ----------
    length : int or None
        The leaf of its length.
    full : int
        Beats that can be sent after it.
    next : int
        Where the next step starts; after the last step, the next packet.
    most : int
        Most beats from the step's own start to `next`, as the circuit estimates it.
    """

    length: int | None
    full: int
    next: int
    most: int


def serializer_cycles(packets: Sequence[Packet]) -> list[int]:
    """Return the cycle in which a serializer could take the last leaf of each packet.

    Cycle 0 is that in which all leaves are offered, after a pause. The packet's last beat is valid
    a latency later; it may have waited for other beats. All that comes out is taken at once.
    """
    # Cycles in which beats leave the ring; in which the last step's leaves are taken, and in which
    # its words are.
    sent: list[int] = []
    # The first packet's constants are there before its leaves.
    taken = placed = -1 - first_step(packets[0].plan) if packets else 0
    lengths: dict[int, int] = {}
    # Of the last step.
    start = end = most = base = 0
    ends: list[int] = []
    for packet in packets:
        room = ring_beats(packet.plan.bus_bytes) - most_beats(packet.plan)
        for step in _writes(packet):
            taken = max(taken + 1, placed)
            if step.length is not None:
                taken = max(taken, lengths.get(step.length, -1) + REPEATED_LENGTH)
                lengths[step.length] = taken
            now = taken + 1
            # In the cycle after a step, only an estimate of its size is known.
            if now == placed + 1 and now < _sent(sent, start + most - room) + ROOM_AFTER:
                now += 1
            if now > placed + 1:
                now = int(max(now, _sent(sent, end - room) + ROOM_AFTER))
            placed = now
            for _ in range(len(sent), base + step.full):
                sent.append(max([placed + COMPLETE_AFTER, *(cycle + 1 for cycle in sent[-1:])]))
            start, end, most = end, base + step.next, step.most
        ends.append(sent[-1] - COMPLETE_AFTER - 1)
        base += packet.beats
    return ends


def _sent(sent: Sequence[int], count: int) -> float:
    """Return the cycle in which the last one of `count` beats left the ring."""
    if count <= 0:
        return -inf
    return sent[count - 1] if count <= len(sent) else inf


def _writes(packet: Packet) -> Iterator[_Write]:
    """Yield the steps of a serializer."""
    plan, bus, visits = packet.plan, packet.plan.bus_bytes, packet.visits
    count = len(visits)
    # A last step that only takes a rest is left out where a length says that there is none.
    if count > 1 and not visits[-1].bytes and only_ends(plan.steps[visits[-1].step]):
        count -= plan.steps[visits[-2].step].begin is not None
    for index in range(count):
        begin = plan.steps[visits[index].step].begin
        is_last = index == count - 1
        end = packet.beats * bus if is_last else packet.next_start(index)
        full = end
        if visits[index].step < first_step(plan):
            # Beats wait for the first leaf.
            full = 0
        elif may_end_empty(plan) and not is_last:
            # A full beat may be the last one.
            full = max(0, end - 1)
        yield _Write(
            length=None if begin is None else begin.length,
            full=full // bus,
            next=end // bus,
            most=_most(packet, index, is_last),
        )


def _most(packet: Packet, index: int, is_last: bool) -> int:
    """Return the circuit's estimate of a step's size, in beats."""
    plan, bus = packet.plan, packet.plan.bus_bytes
    visit = packet.visits[index]
    step = plan.steps[visit.step]
    addend = step.align - 1 - plan.header_bytes % step.align if bus >= 8 else 0
    size = bus - 1 + visit.bytes + addend
    if is_last:
        size += bus - 1 if visit.end else bus
    elif bus >= 8:
        align = packet.aligned_items(index)
        size += align - 1 - plan.header_bytes % align
    return size // bus
