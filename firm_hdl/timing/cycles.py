"""Predict in which cycle converters finish each packet, if packets come back to back.

Both converters execute a step per cycle, and the bus moves a beat per cycle. A ring of beats lies
between the two. So packets take as many cycles as they have beats or steps, whichever is more,
unless one of the two is faster for longer than the ring can buffer.

``tests/gateware/test_throughput.py`` compares each packet with the circuits. Latencies are not
included: they are constants of the circuits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, inf

from firm_hdl.plan.interpret import Visit, decode
from firm_hdl.plan.tree import Length, Plan, Run, Step
from firm_hdl.timing.rings import (
    ends_in_tail,
    first_step,
    may_end_empty,
    most_beats,
    ring_beats,
)

__all__ = [
    "Packet",
    "cycles_between",
    "deserializer_cycles",
    "packet_of",
    "serializer_cycles",
]

FREED_AFTER = 5
"""Cycles from the deserializer's last step that reads a beat to the beat that reuses its slot."""

REPEATED_LENGTH = 2
"""Least number of cycles from a length that the serializer takes to the next one of its leaf."""

ROOM_AFTER = 2
"""Cycles from a beat that the serializer sends to the first step that can reuse its slot."""

COMPLETE_AFTER = 2
"""Cycles from the serializer's step that completes a beat to the cycle that sends the beat."""

SETTLED_BEATS = 32
"""Number of beats after which the average cycles of a repeated packet are constant."""


@dataclass(frozen=True, slots=True)
class Packet:
    """What the cycles of a packet without errors depend on.

    Attributes
    ----------
    plan : Plan
    visits : tuple of Visit
        The steps of the packet, in order.
    bytes : int
        Size of the packet.
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
        run = self.plan.begins.get(self.visits[index].step)
        if not isinstance(run, Run):
            return 1
        following = self.visits[index + 1]
        after = self.plan.steps[following.step]
        has_items = isinstance(after, Run) or following.bytes > after.bytes
        return run.align if has_items else 1

    def next_start(self, index: int) -> int:
        """Return the packet offset of the next step, or of the first item of a run."""
        end = self.visits[index].end
        return end + (self.plan.header_bytes - end) % self.aligned_items(index)


def packet_of(plan: Plan, packet: bytes) -> Packet:
    """Take a packet's steps from the interpreter."""
    return Packet(plan, decode(plan, packet).steps, len(packet))


def cycles_between(packet: Packet) -> int:
    """Return the cycles from one packet to the next, if it is repeated.

    The result is that of the slower converter: an average over packets, rounded up.
    """
    count = ceil(SETTLED_BEATS / packet.beats)
    converters: list[Callable[[Sequence[Packet]], list[int]]]
    converters = [deserializer_cycles, serializer_cycles]
    ends = [cycles([packet] * (2 * count)) for cycles in converters]
    return max(ceil((each[-1] - each[count - 1]) / count) for each in ends)


def deserializer_cycles(packets: Sequence[Packet]) -> list[int]:
    """Return the cycle in which a deserializer executes the last step of each packet.

    Cycle 0 is that of the first beat. The packet's status is valid a latency later. Consumers take
    all outputs at once.
    """
    # Cycle of each beat.
    beats: list[int] = []
    # First beat and cycle of each step.
    steps: list[tuple[int, int]] = []
    ends: list[int] = []
    # First beat of the packet; number of steps whose beats may be overwritten.
    base = finished = 0
    for packet in packets:
        ring = ring_beats(packet.plan.bus_bytes)
        for first, last, held in _reads(packet):
            while len(beats) <= base + last:
                # A beat reuses the slot of one that no step needs any more.
                while finished < len(steps) and steps[finished][0] <= len(beats) - ring:
                    finished += 1
                free = steps[finished - 1][1] + FREED_AFTER if finished else 0
                beats.append(max([free, *(cycle + 1 for cycle in beats[-1:])]))
            cycle = max([beats[base + last], *(cycle + 1 for _, cycle in steps[-1:])])
            steps.append((base + first, cycle + held))
        ends.append(steps[-1][1])
        base += packet.beats
    return ends


def _reads(packet: Packet) -> list[tuple[int, int, int]]:
    """Return the first and last beat of each step of a deserializer, and how long it is held."""
    bus, visits = packet.plan.bus_bytes, packet.visits
    starts = [0, *(packet.next_start(index) for index in range(len(visits) - 1))]
    beats = [
        (start // bus, max(0, -(-visit.end // bus) - 1), visit.held)
        for start, visit in zip(starts, visits, strict=True)
    ]
    last = packet.beats - 1
    if visits[-1].step not in packet.plan.begins:
        # The last beat shows whether bytes follow the message.
        beats[-1] = (beats[-1][0], last, visits[-1].held)
    else:
        # The length is known too late for its step to end the packet: the end is another step.
        beats.append((visits[-1].end // bus, last, 0))
    return beats


@dataclass(frozen=True, slots=True)
class _Write:
    """A step of a serializer, with positions in beats of the packet."""

    length: int | None  # Index of the leaf of the step's length.
    full: int  # Number of beats that can be sent after the step.
    next: int  # Beat in which the next step starts; after the last step, the next packet.
    max_beats: int  # The circuit's upper bound of the beats from the start of the step to `next`.


def serializer_cycles(packets: Sequence[Packet]) -> list[int]:
    """Return the cycle in which a serializer could take the last leaf of each packet.

    Cycle 0 is that in which all leaves are offered, after a pause. The packet's last beat is valid
    a latency later; earlier beats may delay it. Consumers take all outputs at once.
    """
    # Cycle in which each beat is sent.
    sent: list[int] = []
    # Cycles in which the collector takes the last step's leaves, and the packer its words. Steps of
    # constants are done before the leaves of the first packet are offered.
    taken = placed = -1 - first_step(packets[0].plan) if packets else 0
    lengths: dict[int, int] = {}
    # Positions of the last step, in beats, and its `max_beats`; first beat of the packet.
    start = end = max_beats = base = 0
    ends: list[int] = []
    for packet in packets:
        room = ring_beats(packet.plan.bus_bytes) - most_beats(packet.plan)
        for step in _writes(packet):
            taken = max(taken + 1, placed)
            if step.length is not None:
                taken = max(taken, lengths.get(step.length, -1) + REPEATED_LENGTH)
                lengths[step.length] = taken
            cycle = taken + 1
            # The packer sees the exact size of a step a cycle later.
            if cycle == placed + 1 and cycle < _sent(sent, start + max_beats - room) + ROOM_AFTER:
                cycle += 1
            if cycle > placed + 1:
                cycle = int(max(cycle, _sent(sent, end - room) + ROOM_AFTER))
            placed = cycle
            for _ in range(len(sent), base + step.full):
                sent.append(max([placed + COMPLETE_AFTER, *(before + 1 for before in sent[-1:])]))
            start, end, max_beats = end, base + step.next, step.max_beats
        ends.append(sent[-1] - COMPLETE_AFTER - 1)
        base += packet.beats
    return ends


def _sent(sent: Sequence[int], count: int) -> float:
    """Return the cycle in which the last of the first `count` beats was sent."""
    if count <= 0:
        return -inf
    return sent[count - 1] if count <= len(sent) else inf


def _writes(packet: Packet) -> Iterator[_Write]:
    """Yield the steps of a serializer."""
    plan, bus, visits = packet.plan, packet.plan.bus_bytes, packet.visits
    count = len(visits)
    # A last step that only takes a rest is skipped if a length says that there is no rest.
    is_tail = visits[-1].step == len(plan.steps) - 1 and ends_in_tail(plan)
    if count > 1 and not visits[-1].bytes and is_tail:
        count -= visits[-2].step in plan.begins
    first, may_be_last = first_step(plan), may_end_empty(plan)
    for index in range(count):
        begin = plan.begins.get(visits[index].step)
        is_last = index == count - 1
        end = packet.beats * bus if is_last else packet.next_start(index)
        full = end
        if visits[index].step < first:
            # Beats wait for the first leaf.
            full = 0
        elif may_be_last and not is_last:
            # A full beat may be the last one.
            full = max(0, end - 1)
        yield _Write(
            length=begin.count.leaf if begin and isinstance(begin.count, Length) else None,
            full=full // bus,
            next=end // bus,
            max_beats=_max_beats(packet, index, is_last),
        )


def _max_beats(packet: Packet, index: int, is_last: bool) -> int:
    """Return the circuit's upper bound of a step's size, in beats."""
    plan, bus = packet.plan, packet.plan.bus_bytes
    visit = packet.visits[index]
    step = plan.steps[visit.step]
    # The step before a run that a length counts has aligned its items.
    aligns = bus >= 8 and (isinstance(step, Step) or not step.counted)
    addend = step.align - 1 - plan.header_bytes % step.align if aligns else 0
    size = bus - 1 + visit.bytes + addend
    if is_last:
        size += bus - 1 if visit.end else bus
    elif bus >= 8:
        align = packet.aligned_items(index)
        size += align - 1 - plan.header_bytes % align
    return size // bus
