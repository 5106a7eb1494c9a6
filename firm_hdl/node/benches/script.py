"""The frames of a bench: what the host sends to a node, and what the node has to answer.

Nothing is simulated. Packets come from a library of ROS, and a node that sends messages back has to
send the same packets. Control messages stop the clock of the node first, so that all further
answers are known, byte by byte.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from firm_hdl.model import Message
from firm_hdl.node.control import RESPONSE, ControlRequest, Operation, registers
from firm_hdl.node.description import CONTROL_TOPIC, Description, Store, Topic
from firm_hdl.node.frame import HEADER_BYTES, VERSION
from firm_hdl.node.messages import MessageSender, NodeMessage
from firm_hdl.plan import Plan

__all__ = ["FRAMES", "LinkScript", "Stimuli", "link_script"]

FRAMES = "link.txt"
"""The file with the frames."""

LOOP = "firm_hdl.node.loop:Loop"
"""The accelerator whose answers are known."""

MOST_PACKETS = 8
"""Packets of each topic."""

MOST_PACKET_BYTES = 1 << 10
"""Longer packets are left out: a simulator of VHDL takes seconds for 10,000 cycles."""

SECONDS, NANOSECONDS = 1_000_000_000, 5
"""The time at which the clock of the node stands."""

Stimuli = Callable[[Message, Plan], Sequence[bytes]]
"""Returns good packets of a type."""

ANY = "--"
"""A byte that may have any value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkScript:
    """The frames of a bench."""

    # `> HEX`: a frame to the node. `< HEX`: a frame from the node, in which `--` stands for any
    # byte. `=`: wait until all frames before this line have come.
    lines: tuple[str, ...]
    # Frames of topics may come at any time, and are not judged unless the file of a user expects
    # some of the same topic: those of control messages are.
    ignores_topics: bool
    # Subscriptions whose messages the bench connects with publications.
    loops: tuple[tuple[Topic, Topic], ...]

    @property
    def text(self) -> str:
        """The text of the file."""
        return "".join(f"{line}\n" for line in self.lines)

    @property
    def most_bytes(self) -> int:
        """The size of the longest frame, in bytes."""
        return max(len(line) // 2 - 1 for line in self.lines if line[0] in "<>")


def link_script(
    description: Description, stimuli: Stimuli | None = None, *, has_accelerator: bool
) -> LinkScript | None:
    """Choose the frames of a bench.

    * `stimuli`: with `None`, only control messages are sent.
    * `has_accelerator`: whether the node has an accelerator inside. What it does is known of a
      :class:`.Loop` only; others get no packets, because the gates drop those that are sent.

    Returns: `None` for a link that takes too long to simulate, as a bit of a UART is many cycles;
    for an Ethernet, which needs another machine; and for a participant of ROS 2, which has no
    frames.
    """
    if description.link.kind in ("uart", "rtps") or description.link.has_ethernet:
        return None
    is_loop = has_accelerator and description.accelerator == LOOP
    writer = _Writer(description, knows_topics=not has_accelerator or is_loop)
    writer.stop_clock()
    for number in range(5):
        writer.read(number)
    for topic in description.topics:
        if stimuli is not None and topic.has("in"):
            writer.packets(topic, stimuli)
    writer.counters()
    loops = () if has_accelerator else description.loops()
    return LinkScript(
        lines=tuple(writer.lines), ignores_topics=not writer.knows_topics, loops=loops
    )


class _Writer:
    """Writes lines, and knows what the node has to answer; `knows_topics`: also on topics."""

    def __init__(self, description: Description, *, knows_topics: bool) -> None:
        self.description, self.knows_topics = description, knows_topics
        most = description.link.frame_bytes
        self._host, self._node = MessageSender(most), MessageSender(most)
        self._back = {came.id: back.id for came, back in description.loops()}
        self._tag = 0x1000
        # By topic: packets that passed, and that were dropped as truncated; bytes that passed.
        self._passed: dict[int, int] = {}
        self._truncated: dict[int, int] = {}
        self._bytes: dict[int, int] = {}
        self.lines: list[str] = []

    def stop_clock(self) -> None:
        """Set the rate of the clock to 0, and then its time."""
        self.note("The clock is stopped and set, so that all answers are known.")
        self._control(ControlRequest(operation=Operation.SET_RATE, argument=0), None)
        request = ControlRequest(
            operation=Operation.SET_TIME, seconds=SECONDS, nanoseconds=NANOSECONDS
        )
        self._control(request, None)

    def note(self, text: str) -> None:
        self.lines.append(f"# {text}")

    def read(self, number: int) -> None:
        """Read one of the registers that tell what the node is."""
        description = self.description
        # Not those of `NodeCore`, on purpose: the bench judges the core.
        values = {
            "version": VERSION,
            "fingerprint_low": description.fingerprint & 0xFFFF_FFFF,
            "fingerprint_high": description.fingerprint >> 32,
            "topics": len(description.topics),
            "clock_hz": round(description.clock_hz),
        }
        register = registers(description)[number]
        self.note(f"Register {number}: {register.name}.")
        self._read(number, values[register.name])

    def counters(self) -> None:
        """Read what the gates counted."""
        # The gate of the last packet has judged it when this is answered.
        self._read(0, VERSION)
        for each in registers(self.description):
            wanted = {"passed": self._passed, "truncated": self._truncated}.get(each.name)
            if each.part == "in" and wanted is not None and each.topic in self._passed:
                self.note(f"Register {each.number}: '{each.name}' of {each.owner}.")
                self._read(each.number, wanted.get(each.topic, 0))

    def packets(self, topic: Topic, stimuli: Stimuli) -> None:
        """Send packets of a topic, and truncated ones; what comes back is known of a loop."""
        store = topic.store("in")
        self._passed[topic.id] = self._truncated[topic.id] = 0
        plan = self.description.plan(store)
        room = self._room(topic)
        most = min(room, MOST_PACKET_BYTES)
        good = [packet for packet in stimuli(store.message, plan) if len(packet) <= most]
        self.note(f"{topic.name}: {store.message.name}.")
        for group in _groups(good[:MOST_PACKETS], store, room, self.description.bus_bytes):
            for packet in group:
                if self.knows_topics:
                    self._packet(topic, packet)
                if packet:
                    # A library of ROS writes no byte behind a message, so one is missing.
                    self._truncated[topic.id] += 1
                    self._send(NodeMessage(topic=topic.id, packet=packet[:-1]))
            self.lines.append("=")
            if topic.id not in self._back:
                # Nothing comes back, so there is nothing to wait for.
                return

    def _room(self, topic: Topic) -> int:
        """Return a quarter of the smallest memory on the way of a topic's packets, in bytes."""
        description = self.description
        back = self._back.get(topic.id)
        stores = [
            store
            for each in description.topics
            for _, store in each.stores
            if each.id in (topic.id, back)
        ]
        sizes = [each.memory_bytes for each in stores]
        if description.link.kind != "stream":
            sizes.append(description.link.memory_bytes)
        return min(sizes) // 4

    def _packet(self, topic: Topic, packet: bytes) -> None:
        self._passed[topic.id] += 1
        self._send(NodeMessage(topic=topic.id, packet=packet))
        if topic.id in self._back:
            self._expect(NodeMessage(topic=self._back[topic.id], packet=packet))

    def _read(self, number: int, value: int) -> None:
        self._control(ControlRequest(operation=Operation.READ, argument=number), value)

    def _control(self, request: ControlRequest, value: int | None) -> None:
        """Send a request and wait for its answer; `value` is `None` before the clock stands."""
        self._tag += 1
        self._send(NodeMessage(topic=CONTROL_TOPIC, packet=request.encode(), tag=self._tag))
        fields = {"operation": int(request.operation), "value": value or 0}
        if value is not None:
            fields |= {"seconds": SECONDS, "nanoseconds": NANOSECONDS}
        packet = b"".join(
            fields.get(name, 0).to_bytes(size, "little") for name, size in RESPONSE.items()
        )
        unknown = range(8, 16) if value is None else range(0)
        self._expect(NodeMessage(topic=CONTROL_TOPIC, packet=packet, tag=self._tag), unknown)
        self.lines.append("=")

    def _send(self, message: NodeMessage) -> None:
        self.lines += [f"> {frame.hex()}" for frame in self._host.frames(message)]

    def _expect(self, message: NodeMessage, unknown: range = range(0)) -> None:
        """Expect a message, with bytes that may have any value."""
        frames = self._node.frames(message)
        places = {HEADER_BYTES + place for place in unknown}
        if not self.knows_topics:
            # Flags and sequence depend on what else the node has sent.
            places |= {1, 12, 13}
        for frame in frames:
            octets = [f"{octet:02x}" for octet in frame]
            text = "".join(ANY if at in places else octet for at, octet in enumerate(octets))
            self.lines.append(f"< {text}")


def _groups(
    packets: Sequence[bytes], store: Store, room: int, bus_bytes: int
) -> Iterator[Sequence[bytes]]:
    """Divide packets into groups for which there is room, each at once.

    Each packet is followed by a damaged one of the same size, and half of the memory stays free.
    """
    group: list[bytes] = []
    size = 0
    for packet in packets:
        beats = -(-max(1, len(packet)) // bus_bytes) * bus_bytes
        if group and (size + beats > room or len(group) >= store.packets // 4):
            yield group
            group, size = [], 0
        group.append(packet)
        size += beats
    if group:
        yield group
