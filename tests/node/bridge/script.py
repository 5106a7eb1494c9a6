"""A session whose board is a script: each request is seen, and each answer written down."""

from __future__ import annotations

import struct

from firm_hdl.node.bridge.session import Session
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from tests.node.bridge.fakes import ECHO

__all__ = ["EPOCH", "READ", "SET_RATE", "SET_TIME", "Script"]

READ, SET_TIME, SET_RATE = 1, 2, 3
REQUESTS = 26
"""The register that counts requests."""
EPOCH = 1_800_000_000
"""Seconds since 1970 when a script begins."""


class Script:
    """A session with a board that does as it is told; `now` is the time of the host."""

    def __init__(self, frame_bytes=None, is_known=True):
        self.now = 100.0
        self.session = Session(ECHO, frame_bytes, self.now)
        self.receiver, self.sender = MessageReceiver(), MessageSender()
        self.requests = 0
        if is_known:
            self.know()

    @property
    def wall(self):
        return EPOCH * 10**9 + round((self.now - 100) * 1e9)

    def ask(self):
        """Let the session ask; return operation, argument, seconds, nanoseconds and tag."""
        taken = map(self.receiver.take, self.session.due(self.now, self.wall))
        found = [each for each in taken if each is not None]
        if not found:
            return None
        (message,) = found
        assert message.topic == 0
        self.requests += 1
        return (*struct.unpack("<B3xIII", message.packet), message.tag)

    def answer(self, asked, value=0, *, time=None, result=0, after=0.0):
        """Let the board answer `asked`, by default at a time that is the host's."""
        self.now += after
        value = self.requests if asked[1] == REQUESTS else value
        seconds, nanoseconds = divmod(self.wall if time is None else time, 10**9)
        packet = struct.pack("<BBxxIII", asked[0], result, value, seconds, nanoseconds)
        return self.come(NodeMessage(topic=0, packet=packet, tag=asked[-1]))

    def come(self, message):
        """Let a message of the board come; return those that are set free."""
        return [
            each
            for frame in self.sender.frames(message)
            for each in self.session.take(frame, self.now, self.wall)
        ]

    def publish(self, packet=b"x"):
        return [each.packet for each in self.come(NodeMessage(topic=2, packet=packet))]

    def start_again(self, packet=b"x"):
        """Let the board start again, which its first message says, and an answer shows."""
        self.sender = MessageSender()
        found = self.publish(packet)
        self.answer(self.ask())
        return found

    def know(self):
        """Let the board show its fingerprint; return the messages that this sets free."""
        found = []
        halves = (1, ECHO.fingerprint & 0xFFFF_FFFF), (2, ECHO.fingerprint >> 32)
        for number, half in (*halves, (REQUESTS, 0)):
            asked = self.ask()
            assert asked[:2] == (READ, number) and not self.session.is_ready
            found += self.answer(asked, half)
        assert self.session.is_ready
        return [each.packet for each in found]

    def asked(self, *arguments):
        """Let the board answer requests, which have to read these registers in turn."""
        for argument in arguments:
            asked = self.ask()
            assert asked[:2] == (READ, argument)
            self.answer(asked)
