"""A board and a graph in Python: a node that echoes, and peers that are lists."""

from __future__ import annotations

import socket
import time
from contextlib import suppress

from firm_hdl.node.boards import Board, BoardError
from firm_hdl.node.bridge import Bridge
from firm_hdl.node.control import CONTROL_BYTES
from firm_hdl.node.graphs import Graph, GraphError
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from tests.node.accelerators import echo_text
from tests.node.samples import read

__all__ = ["ECHO", "LINE", "FakeBoard", "FakeGraph", "FakeNode", "bridge_of", "run_until"]

_TEXT = echo_text().replace("memory_bytes: 256", "memory_bytes: 1024", 1)
ECHO = read(_TEXT, link="udp")
LINE = read(_TEXT, link="uart")
"""The same node on a stream of bytes."""
HEARD, SAID, STAMP, CAL = ECHO.topics


class FakeNode:
    """A node of `ECHO`: it publishes each string on topic 2, and answers requests with themselves.

    `values` are those of its registers that are not 0; `holds` lets it keep strings. Its control
    messages are written down here after docs/reference/frame.md.
    """

    def __init__(self, fingerprint=ECHO.fingerprint, seconds=0):
        self.receiver, self.sender = MessageReceiver(), MessageSender()
        self.fingerprint, self.seconds, self.rate = fingerprint, seconds, None
        self.is_mute = self.answers_no_calls = self.holds = False
        self.values = {17: 7}
        self.requests, self.held = 0, []
        self.read, self.set_ns = [], []

    def take(self, frame):
        """Take a frame; return the frames of the answer."""
        message = self.receiver.take(frame)
        if message is None or self.is_mute:
            return []
        if message.topic == 0:
            packet = self._control(message.packet)
            return self.sender.frames(NodeMessage(topic=0, packet=packet, tag=message.tag))
        if message.topic == 1 and self.holds:
            # It is still in the accelerator.
            self.held.append(message)
            return []
        if message.topic == 1:
            return self.sender.frames(NodeMessage(topic=2, packet=message.packet))
        if message.topic == 4 and not self.answers_no_calls:
            return self.sender.frames(message)
        return []

    def _control(self, packet):
        assert len(packet) == CONTROL_BYTES
        operation, argument = packet[0], int.from_bytes(packet[4:8], "little")
        self.requests += 1
        before, value = self.seconds, 0
        if operation == 1:
            self.read.append(argument)
            halves = {1: self.fingerprint & 0xFFFF_FFFF, 2: self.fingerprint >> 32}
            value = halves.get(argument, self.values.get(argument, 0))
            # What its link has lost, and the requests that it has taken, are counted.
            value += {17: self.receiver.counters.lost, 26: self.requests}.get(argument, 0)
        elif operation == 2:
            self.seconds = int.from_bytes(packet[8:12], "little")
            nanoseconds = int.from_bytes(packet[12:], "little")
            self.set_ns.append(self.seconds * 10**9 + nanoseconds)
        else:
            self.rate = argument
        numbers = b"".join(n.to_bytes(4, "little") for n in (value, before, 0))
        return bytes([operation, 0, 0, 0]) + numbers


class FakeBoard(Board):
    """A board with a `FakeNode`; `loses` says which frames do not come, in either direction.

    Without a file to write to, nothing tells a bridge when there is room again. The clock stands.
    """

    has_room = True
    has_real_time = False

    def __init__(self, node=None, loses=lambda frame: False):
        super().__init__("fake", 272)
        self.node, self.loses = node or FakeNode(), loses
        self.opened = 0
        self.is_dead = False
        self.coming = []
        self._pair = None

    def open(self):
        self.close()
        if self.is_dead:
            raise BoardError("it is dead")
        self._pair = socket.socketpair()
        for each in self._pair:
            each.setblocking(False)
        self.opened += 1

    def fileno(self):
        return self._pair[0].fileno()

    def send(self, frames):
        if self.is_dead:
            raise BoardError("it is dead")
        for frame in frames:
            if not self.loses(frame):
                self.come(self.node.take(frame))
        return True

    def come(self, frames):
        """Let frames come from the node."""
        self.coming += [frame for frame in frames if not self.loses(frame)]
        with suppress(BlockingIOError):
            self._pair[1].send(b"x")

    def receive(self):
        if self.is_dead:
            raise BoardError("it is dead")
        with suppress(BlockingIOError):
            self._pair[0].recv(1 << 16)
        found, self.coming = self.coming, []
        return found

    def close(self):
        for each in self._pair or ():
            each.close()
        self._pair = None


class FakeGraph(Graph):
    """Peers that keep what they get. `closed` counts how often they were left."""

    has_ended = False

    def __init__(self):
        super().__init__("fake")
        self.on_message = None
        self.opened = self.closed = self.checked = 0
        self.is_dead = self.is_full = False
        self.got, self.answers, self.abandoned = [], [], []

    def open(self, on_message):
        if self.is_dead:
            raise GraphError("it is dead")
        self.on_message = on_message
        self.opened += 1

    def say(self, topic, *packets):
        for packet in packets:
            self.on_message(topic, packet, None)

    def publish(self, topic, packet):
        if self.is_dead:
            raise GraphError("it is dead")
        if not self.is_full:
            self.got.append((topic.name, packet))
        return not self.is_full

    def respond(self, topic, caller, packet):
        self.answers.append((caller, packet))
        return True

    def abandon(self, topic, caller):
        self.abandoned.append(caller)

    def check(self):
        self.checked += 1
        if self.is_dead:
            raise GraphError("it is dead")

    def close(self):
        self.closed += 1


def bridge_of(board=None, graph=None, description=ECHO):
    """Return a bridge, and the lines that it reports."""
    said = []
    made = Bridge(
        description,
        board or FakeBoard(),
        graph or FakeGraph(),
        report=lambda line: said.append(line),
    )
    return made, said


def run_until(bridge, condition, seconds=60.0):
    """Run a bridge until a condition holds; whether it does."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        bridge.step(time.monotonic() + 0.05)
    return True
