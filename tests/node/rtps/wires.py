"""A node's link in simulation, and participants of the host around it, in one process."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

from amaranth.sim import Simulator

from firm_hdl.node.description import Description
from firm_hdl.node.links import RtpsLink
from firm_hdl.node.reading import read_description_text
from firm_hdl.rtps.core import Core
from firm_hdl.rtps.discovery import ParticipantData
from firm_hdl.rtps.spdp import Settings
from firm_hdl.rtps.wire.locators import Address

__all__ = ["BOARD", "CLOCK_HZ", "Wires", "core_of", "description_of"]

BOARD = "10.0.0.50"
GROUP = Address("239.255.0.1", 7400)
CLOCK_HZ = 60_000.0
"""A slow clock: a tick of the link has 3,000 cycles, and a second 60,000."""

TEXT = """
node: echo
namespace: /fpga
distro: kilted
bus_bytes: 1
link: {{kind: rtps, address: {address}}}
subscribe:
  /heard: {{type: std_msgs/msg/String, memory_bytes: 512{heard}}}
publish:
  /said: {{type: std_msgs/msg/String, memory_bytes: 512{said}}}
"""


def description_of(
    heard: str = "", said: str = "", clock_hz: float = CLOCK_HZ, **link: object
) -> Description:
    """Return a node with a subscription, and a publication; with further options of both."""
    text = TEXT.format(address=BOARD, heard=heard, said=said)
    description = read_description_text(text)
    link = {"memory_bytes": 4096, "peers": 2, "matches": 6, **link}
    return replace(description, clock_hz=clock_hz, link=replace(description.link, **link))


def core_of(number: int, **options: object) -> Core:
    """Return a participant at 10.0.0.NUMBER."""
    host = f"10.0.0.{number}"
    own = ParticipantData(
        prefix=b"\x01\xff" + bytes(9) + bytes([number]),
        discovery=(Address(host, 7410),),
        user=(Address(host, 7411),),
        lease=10.0,
        domain=0,
    )
    return Core(Settings(own=own, host=host, targets=(GROUP,), **options))


class Wires:
    """Run a link among participants; what they send arrives at once.

    Parameters
    ----------
    description : Description
    cores : tuple of Core
    loses : callable
        Whether a datagram is lost: ``loses(is_to_board, bytes)``.

    Attributes
    ----------
    sent : list of pairs of Address and bytes
        All that the link sent.
    received : list of tuples
        Topic, tag, and bytes of the messages that came out of the link.
    to_send : deque of tuples
        Messages for the link.
    waits : list of int
        Cycles from the last byte of a datagram to the first one of the message that it has.
    sent_at, taken_at : list of int
        Cycles in which a datagram of the link began, and in which a message for it ended.
    now : float
    """

    def __init__(self, description: Description, *cores: Core, loses=lambda *_: False):
        self.link = RtpsLink(description)
        self.cores, self.loses = cores, loses
        self.sent: list[tuple[Address, bytes]] = []
        self.received: list[tuple[int, int, bytes]] = []
        self.to_send: deque[tuple[int, int, bytes]] = deque()
        self.to_link: deque[tuple[bytes, int]] = deque()
        self.events = {core: [] for core in cores}
        self.waits: list[int] = []
        self.sent_at: list[int] = []
        self.taken_at: list[int] = []
        self.now = 0.0
        self.counters: dict[str, int] = {}

    def put(self, datagram: bytes, port: int = 7410) -> None:
        """Send a datagram to the link."""
        self.to_link.append((datagram, port))

    def run(self, script) -> None:
        """Simulate while `script`, a generator, goes on; it yields once per some cycles."""
        simulator = Simulator(self.link)
        simulator.add_clock(1e-6)

        async def bench(ctx):
            await self._bench(ctx, script)

        simulator.add_testbench(bench)
        simulator.run()

    def until(self, condition, seconds: float = 1.0):
        """Wait in a script until a condition holds."""
        end = self.now + seconds
        while not condition():
            assert self.now < end, "it takes too long"
            yield

    def pause(self, seconds: float):
        """Wait in a script."""
        end = self.now + seconds
        while self.now < end:
            yield

    async def _bench(self, ctx, script) -> None:
        link = self.link
        rx, tx = link.datagrams_in, link.datagrams_out
        received, sent = link.received, link.sent
        ctx.set(tx.ready, 1)
        ctx.set(received.ready, 1)
        ctx.set(link.nonce, 1)
        ctx.set(link.idle, 1)
        datagram, message, packet = bytearray(), bytearray(), None
        coming, at, packet_at, cycles, came_at = None, 0, 0, 0, 0
        while True:
            if cycles % 16 == 0:
                self.now = cycles / link.description.clock_hz
                self._exchange()
                for name in link.counters.shape().members:
                    self.counters[name] = ctx.get(link.counters[name])
                if next(script, self) is self:
                    return
            if coming is None and self.to_link:
                coming, at = self.to_link.popleft(), 0
                self._offer(ctx, rx, coming, at)
            if packet is None and self.to_send:
                packet, packet_at = self.to_send.popleft(), 0
                self._feed(ctx, sent, packet, packet_at)
            took, feeds, has_tx, has_message = (
                ctx.get(each) for each in (rx.ready, sent.ready, tx.valid, received.valid)
            )
            if has_tx:
                if not datagram:
                    self.sent_at.append(cycles)
                datagram.append(ctx.get(tx.payload.data))
                if ctx.get(tx.payload.last):
                    assert ctx.get(tx.payload.length) == len(datagram)
                    self._deliver(
                        ctx.get(tx.payload.ip_address),
                        ctx.get(tx.payload.dst_port),
                        bytes(datagram),
                    )
                    datagram.clear()
            if has_message:
                if not message:
                    self.waits.append(cycles - came_at)
                message.append(ctx.get(received.payload.beat.data[0]))
                if ctx.get(received.payload.beat.last):
                    assert ctx.get(received.payload.length) == len(message)
                    side = ctx.get(received.payload.topic), ctx.get(received.payload.tag)
                    self.received.append((*side, bytes(message)))
                    message.clear()
            await ctx.tick()
            cycles += 1
            if coming is not None and took:
                at += 1
                if at == len(coming[0]):
                    coming, came_at = None, cycles - 1
                    ctx.set(rx.valid, 0)
                else:
                    self._offer(ctx, rx, coming, at)
            if packet is not None and feeds:
                packet_at += 1
                if packet_at == len(packet[2]):
                    packet = None
                    self.taken_at.append(cycles - 1)
                    ctx.set(sent.valid, 0)
                else:
                    self._feed(ctx, sent, packet, packet_at)

    @staticmethod
    def _offer(ctx, rx, coming, at) -> None:
        data, port = coming
        ctx.set(rx.payload.data, data[at])
        ctx.set(rx.payload.last, at + 1 == len(data))
        if at == 0:
            ctx.set(rx.payload.length, len(data))
            ctx.set(rx.payload.dst_port, port)
            ctx.set(rx.valid, 1)

    @staticmethod
    def _feed(ctx, sent, packet, at) -> None:
        topic, tag, data = packet
        ctx.set(sent.payload.beat.data[0], data[at])
        ctx.set(sent.payload.beat.last, at + 1 == len(data))
        if at == 0:
            ctx.set(sent.payload.beat.count, 1)
            ctx.set(sent.payload.topic, topic)
            ctx.set(sent.payload.tag, tag)
            ctx.set(sent.payload.length, len(data))
            ctx.set(sent.valid, 1)

    def _deliver(self, address: int, port: int, datagram: bytes) -> None:
        """Bring a datagram of the link to the participants that it is for."""
        host = ".".join(str(address >> shift & 0xFF) for shift in (24, 16, 8, 0))
        self.sent.append((Address(host, port), datagram))
        if self.loses(False, datagram):
            return
        for core in self.cores:
            if host in (core.settings.host, GROUP.host):
                core.receive(datagram, self.now, BOARD)

    def _exchange(self) -> None:
        """Bring what participants send to the link, and to each other."""
        for core in self.cores:
            core.tick(self.now)
            while core.outbox:
                address, datagram = core.pop()
                if address.host in (BOARD, GROUP.host) and not self.loses(True, datagram):
                    self.put(datagram, address.port)
                if address.host == GROUP.host:
                    for other in self.cores:
                        if other is not core:
                            other.receive(datagram, self.now, core.settings.host)
            while (event := core.next_event()) is not None:
                self.events[core].append(event)
