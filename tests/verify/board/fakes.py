"""A node in Python that loops messages, with the counters of the frame; and faults of it."""

from __future__ import annotations

from collections import Counter

from firm_hdl.node import read_description_text
from firm_hdl.node.control import registers
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from firm_hdl.plan import decode, encode
from firm_hdl.verify.board.description import loop_text
from firm_hdl.verify.board.system import Boards
from firm_hdl.verify.systems.options import Request
from tests.node.bridge.fakes import FakeBoard

__all__ = ["BOTH", "STRING", "LoopNode", "described", "verdicts"]

STRING, BOOL = "std_msgs/msg/String", "std_msgs/msg/Bool"
BOTH = (BOOL, STRING)


def described(*names, paths=(), board="udp://a", **changes):
    """Return the description that `--write-node` writes, with other lines in place of some."""
    lines = loop_text(names, "lyrical", paths=paths, board=board).splitlines()
    lines = [line for line in lines if line.partition(":")[0] not in changes]
    lines += [f"{key}: {value}" for key, value in changes.items()]
    return read_description_text("\n".join(lines))


class LoopNode:
    """A node of a description whose loops are right. Subclasses have a fault each."""

    def __init__(self, description):
        self.description = description
        self.receiver, self.sender = MessageReceiver(), MessageSender(272)
        self.fingerprint = description.fingerprint
        self.counters, self.seconds = Counter(), 0
        self.loops = {came.id: back.id for came, back in description.loops()}
        self.plans = {
            came.id: description.plan(came.store("in")) for came, _ in description.loops()
        }
        self.heard = 0

    def take(self, frame):
        """Take a frame; return the frames of the answers."""
        message = self.receiver.take(frame)
        if message is None:
            return []
        if message.topic == 0:
            return self.control(message)
        self.heard += 1
        status = self.status(message)
        self.count(message.topic, "passed" if status == "OK" else status.lower())
        packets = []
        if status == "OK":
            self.count(message.topic, "bytes_low", len(message.packet))
            plan = self.plans[message.topic]
            packet, _ = encode(plan, decode(plan, message.packet).streams)
            packets = list(self.answers(packet))
        topic = self.loops[message.topic]
        for packet in packets:
            self.count(topic, "passed")
            self.count(topic, "bytes_low", len(packet))
        return [frame for packet in packets for frame in self.send(topic, packet)]

    def status(self, message):
        return decode(self.plans[message.topic], message.packet).status

    def answers(self, packet):
        """Yield the packets that come back for a good one."""
        yield packet

    def count(self, topic, name, by=1):
        self.counters[topic, name] += by

    def send(self, topic, packet, tag=0):
        return self.sender.frames(NodeMessage(topic=topic, packet=packet, tag=tag))

    def control(self, message):
        return self.send(0, self.response(message.packet), message.tag)

    def response(self, packet):
        operation, number = packet[0], int.from_bytes(packet[4:8], "little")
        halves = {1: self.fingerprint & 0xFFFF_FFFF, 2: self.fingerprint >> 32}
        value, seconds = halves.get(number, 0), self.seconds
        if operation == 2:
            self.seconds = int.from_bytes(packet[8:12], "little")
        elif operation == 1 and number >= 16:
            (found,) = (each for each in registers(self.description) if each.number == number)
            value = self.counters[found.topic, found.name]
        numbers = value.to_bytes(4, "little") + seconds.to_bytes(4, "little") + bytes(4)
        return bytes([operation, 0, 0, 0]) + numbers


def verdicts(loop_node, description=None, names=(), loses=lambda frame: False, **options):
    """Send types through a board with a node; return the verdict of each."""
    description = description or loop_node.description
    given = {"most_cases": 6, "references": (), **options}
    request = Request(types=tuple(names), board="fake", **given)
    board = FakeBoard(loop_node, loses)
    # A request is repeated before a board counts as silent.
    board.repeat_seconds = 0.05
    with Boards(description, request, board) as system:
        return {each.test.type: each.verdict for each in system.run(None)}
