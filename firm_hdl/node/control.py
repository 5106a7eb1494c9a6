"""Control messages: the host reads registers of the node, and sets its clock.

A request and its response have 16 bytes each, and travel with topic 0 and a tag, as those of a
service do. Each response has the time of the node, so any request also measures the distance of the
clocks. Formats, operations and registers are data here, from which host and gateware are made.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Literal

from firm_hdl.ethernet.drops import DROPS
from firm_hdl.node.description import Description, Link

__all__ = [
    "CONTROL_BYTES",
    "COUNTERS_FROM",
    "ETHERNET_COUNTERS",
    "FIFO_COUNTERS",
    "GATE_COUNTERS",
    "IDENTITY",
    "LINK_COUNTERS",
    "RATE_FRACTION_BITS",
    "REQUEST",
    "RESPONSE",
    "ControlRequest",
    "ControlResponse",
    "Operation",
    "Register",
    "Result",
    "counter_path",
    "ethernet_counter",
    "is_loss",
    "link_counters",
    "nominal_rate",
    "registers",
]

CONTROL_BYTES = 16

RATE_FRACTION_BITS = 22
"""The rate of the clock is nanoseconds per cycle, with so many bits after the point: steps of
0.24 fs, or 24 parts per billion at 100 MHz."""


class Operation(IntEnum):
    """What a request asks for.

    Members
    -------
    READ
        The value of the register with the number `argument`.
    SET_TIME
        The clock continues from `seconds` and `nanoseconds`.
    SET_RATE
        In each cycle, the clock advances by `argument` in steps of ``2**-22`` ns.
    """

    READ = 1
    SET_TIME = 2
    SET_RATE = 3


class Result(IntEnum):
    """What became of a request.

    Members
    -------
    OK
        It was done.
    OPERATION
        There is no such operation, or the request has not 16 bytes.
    ARGUMENT
        There is no such register, or the nanoseconds are not below a second.
    """

    OK = 0
    OPERATION = 1
    ARGUMENT = 2


REQUEST = {"operation": 1, "reserved": 3, "argument": 4, "seconds": 4, "nanoseconds": 4}
"""The fields of a request and their bytes; fields follow without gaps."""

RESPONSE = {
    "operation": 1,
    "result": 1,
    "reserved": 2,
    "value": 4,
    "seconds": 4,
    "nanoseconds": 4,
}
"""The fields of a response. `value` is that of the register, else 0; the time is the node's, in the
cycle in which the request was done, and before a `SET_TIME`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlRequest:
    """A request. See `Operation` for the meaning of the numbers."""

    operation: int
    argument: int = 0
    seconds: int = 0
    nanoseconds: int = 0

    def encode(self) -> bytes:
        """Write the request; a number that does not fit raises an `OverflowError`."""
        return b"".join(
            getattr(self, name, 0).to_bytes(size, "little") for name, size in REQUEST.items()
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlResponse:
    """A response."""

    operation: int  # That of the request.
    result: Result
    value: int
    # Time of the node.
    seconds: int
    nanoseconds: int

    @classmethod
    def decode(cls, data: bytes) -> ControlResponse:
        """Read a response.

        Raises
        ------
        ValueError
            If the bytes are none.
        """
        if len(data) != CONTROL_BYTES:
            raise ValueError(f"a response has {CONTROL_BYTES} bytes, not {len(data)}")
        values: dict[str, Any] = {}
        at = 0
        for name, size in RESPONSE.items():
            values[name] = int.from_bytes(data[at : at + size], "little")
            at += size
        del values["reserved"]
        return cls(**values | {"result": Result(values["result"])})


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """A register that a host can read: 32 bits."""

    number: int
    owner: str  # `node`, `link`, or the complete name of a topic.
    part: Literal["identity", "link", "node", "in", "out"]
    name: str  # A counter of two registers has `_low` and `_high` at the end of their names.
    topic: int = 0  # Id of the topic; 0 for others.


IDENTITY = ("version", "fingerprint_low", "fingerprint_high", "topics", "clock_hz", "rate")
"""Registers that tell what the node is: the version of the frame, the fingerprint of the
description, the number of topics, the frequency of the clock, and the rate that is set."""

COUNTERS_FROM = 16
"""The number of the first counter."""

LINK_COUNTERS = ("passed", "lost", "late", "cut", "stray", "malformed", "full", "large", "unsent")
"""Counters of every link; those that it has no use for stay 0."""

ETHERNET_COUNTERS = tuple(f"ethernet_{name}" for name in DROPS)
"""Counters of a link that has an Ethernet of its own. They say why frames were dropped there; a
message that is lost with one is counted by the link, or by the host."""

NODE_COUNTERS = ("unknown", "control", "control_full")
"""Messages of topics that the node does not have; control requests; those without room."""

GATE_COUNTERS = (
    *("passed", "truncated", "trailing", "length", "encapsulation", "string"),
    *("full", "large", "overrun"),
)
"""Counters of packets from the host, as :class:`firm_hdl.PacketGate` has them."""

FIFO_COUNTERS = ("passed", "aborted", "full", "large")
"""Counters of packets to the host, as :class:`firm_hdl.PacketFifo` has them."""

_BYTES = ("bytes_low", "bytes_high")
"""Bytes of the packets that passed, as two registers."""


def ethernet_counter(name: str) -> str:
    """Return the counter of one of :data:`firm_hdl.ethernet.drops.DROPS`."""
    return f"ethernet_{name}"


def link_counters(link: Link) -> tuple[str, ...]:
    """Return the counters of a link. A simulated one has those of the link that it stands for."""
    return LINK_COUNTERS + (ETHERNET_COUNTERS if link.ethernet != "stream" else ())


def registers(description: Description) -> tuple[Register, ...]:
    """List all registers of a node, in the order of their numbers."""
    found = [
        Register(number=number, owner="node", part="identity", name=name)
        for number, name in enumerate(IDENTITY)
    ]

    def add(owner: str, part: Literal["link", "node", "in", "out"], name: str, topic: int) -> None:
        number = COUNTERS_FROM + len(found) - len(IDENTITY)
        found.append(Register(number=number, owner=owner, part=part, name=name, topic=topic))

    for name in link_counters(description.link):
        add("link", "link", name, 0)
    for name in NODE_COUNTERS:
        add("node", "node", name, 0)
    for topic in description.topics:
        if topic.has("in"):
            for name in (*GATE_COUNTERS, *_BYTES):
                add(topic.name, "in", name, topic.id)
        if topic.has("out"):
            for name in (*FIFO_COUNTERS, *_BYTES):
                add(topic.name, "out", name, topic.id)
    return tuple(found)


def counter_path(description: Description, register: Register) -> tuple[str, str]:
    """Return the part and the name that a counter has among those of the node."""
    if not register.topic:
        return register.part, register.name
    topic = description.topics[register.topic - 1]
    part = topic.part("in" if register.part == "in" else "out")
    return f"{part}_{topic.port}", register.name


_NO_LOSSES = (
    *("passed", "bytes_low", "bytes_high", "control", "control_full", "unsent"),
    ethernet_counter("other"),
)
"""Counters that do not count losses: a request of control without room was repeated; before a host
has spoken, all that a node sends is unsent; and a network has frames for others."""


def is_loss(register: Register) -> bool:
    """Return whether a counter counts losses, or says why something was lost."""
    return register.part != "identity" and register.name not in _NO_LOSSES


def nominal_rate(clock_hz: float) -> int:
    """Return the rate of a clock of that frequency, as `SET_RATE` takes it."""
    return round(1e9 / clock_hz * (1 << RATE_FRACTION_BITS))
