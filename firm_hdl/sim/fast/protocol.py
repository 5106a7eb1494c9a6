"""The protocol between a :class:`.FastSimulation` and the engine that simulates its design.

Both sides send messages: a byte of the kind, four bytes of the length of the body, the body. All
numbers are unsigned and little-endian. A *number* of a port is its place in :class:`.Ports`; plain
inputs and plain outputs are counted separately. A value of n bits has ``max(1, ceil(n / 8))``
bytes. ``server.h`` is the same in C++.

To the engine:

====== ===========================================================================================
SEND   u16 stream, payloads. They are put into the queue of an input stream.
SET    u16 input, value. From the current cycle on.
GET    The engine answers VALUES.
STALL  u16 stream, u32 bits, bytes. The pattern of stalls: bit n is that of each cycle n modulo the
       number of bits, 1 is a stall. No bits: no stalls.
RUN    u64 cycles, u64 quiet, conditions: u16 stream, u16 bit, u64 count. Runs until each condition
       has been met, or `quiet` cycles have had no transfer (0: not for that reason), or the cycles
       have passed. A condition counts transfers of an output stream with the bit set in the
       payload; 65,535 counts all. The engine answers TRANSFERS and then DONE.
LIVE   u32 quiet, u32 milliseconds, u32 cycles. Runs until HALT. After `quiet` cycles without a
       transfer, the engine sleeps until a message comes, and runs that many cycles every so many
       milliseconds.
HALT   The engine answers DONE.
RESET  Back to the state of the start; queues are empty. Stalls, values of inputs and periods stay.
CLOCKS u16 base, u64 for each clock: its period. Cycles of runs are those of the clock `base`, and
       the cycle of a transfer, or of a stall, is one of the stream's own clock. Before this
       message, all periods are 1. The first edge of a clock is after one period.
====== ===========================================================================================

From the engine:

========= ========================================================================================
TRANSFERS u16 stream, then u64 cycle and payload for each transfer, in order.
VALUES    The values of all plain outputs, in the current cycle.
DONE      u8 reason, u64 cycle, u64 for each stream: payloads in the queue that were not yet taken.
FAILED    A text. The engine has ended.
========= ========================================================================================
"""

from __future__ import annotations

import enum
import struct
from collections.abc import Sequence
from dataclasses import dataclass

__all__ = [
    "ALL_TRANSFERS",
    "CYCLE_BYTES",
    "Answer",
    "Done",
    "Order",
    "Reason",
    "clocks",
    "done",
    "live",
    "message",
    "messages",
    "numbered",
    "read_clocks",
    "read_done",
    "read_live",
    "read_number",
    "read_run",
    "read_stall",
    "run",
    "stall",
    "transfers",
]

ALL_TRANSFERS = 0xFFFF
"""The bit of a condition that counts every transfer."""

CYCLE_BYTES = 8

_HEAD = struct.Struct("<BI")
_NUMBER = struct.Struct("<H")
_STALL = struct.Struct("<HI")
_RUN = struct.Struct("<QQ")
_CONDITION = struct.Struct("<HHQ")
_LIVE = struct.Struct("<III")
_DONE = struct.Struct("<BQ")


class Order(enum.IntEnum):
    """Kinds of messages to an engine."""

    SEND = 1
    SET = 2
    GET = 3
    STALL = 4
    RUN = 5
    LIVE = 6
    HALT = 7
    RESET = 8
    CLOCKS = 9


class Answer(enum.IntEnum):
    """Kinds of messages from an engine."""

    TRANSFERS = 1
    VALUES = 2
    DONE = 3
    FAILED = 4


class Reason(enum.IntEnum):
    """Why a run ended."""

    CYCLES = 0
    QUIET = 1
    CONDITIONS = 2
    HALTED = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class Done:
    """The end of a run: the reason, the number of the next cycle, and the queues by stream."""

    reason: Reason
    cycle: int
    queued: tuple[int, ...]


def message(kind: Order | Answer, body: bytes = b"") -> bytes:
    """Return a message."""
    return _HEAD.pack(kind, len(body)) + body


def messages(received: bytearray) -> list[tuple[int, bytes]]:
    """Take the complete messages from the front of a buffer: the kind and the body of each."""
    found = []
    at = 0
    while len(received) - at >= _HEAD.size:
        kind, length = _HEAD.unpack_from(received, at)
        body = at + _HEAD.size
        if len(received) < body + length:
            break
        found.append((kind, bytes(received[body : body + length])))
        at = body + length
    del received[:at]
    return found


def numbered(kind: Order, number: int, body: bytes) -> bytes:
    """Return a message about a port."""
    return message(kind, _NUMBER.pack(number) + body)


def read_number(body: bytes) -> tuple[int, bytes]:
    """Return the number of a port, and what follows."""
    return _NUMBER.unpack_from(body)[0], body[_NUMBER.size :]


def stall(stream: int, pattern: Sequence[bool]) -> bytes:
    """Return the message STALL."""
    bits = sum(1 << index for index, is_stalled in enumerate(pattern) if is_stalled)
    body = _STALL.pack(stream, len(pattern)) + bits.to_bytes(-(-len(pattern) // 8), "little")
    return message(Order.STALL, body)


def read_stall(body: bytes) -> tuple[int, list[bool]]:
    """Return the stream and the pattern of a message STALL."""
    stream, count = _STALL.unpack_from(body)
    data = body[_STALL.size :]
    return stream, [bool(data[n >> 3] >> (n & 7) & 1) for n in range(count)]


def run(cycles: int, quiet: int, conditions: Sequence[tuple[int, int, int]]) -> bytes:
    """Return the message RUN."""
    body = _RUN.pack(cycles, quiet) + b"".join(_CONDITION.pack(*each) for each in conditions)
    return message(Order.RUN, body)


def read_run(body: bytes) -> tuple[int, int, list[tuple[int, int, int]]]:
    """Return cycles, quiet cycles and conditions of a message RUN."""
    cycles, quiet = _RUN.unpack_from(body)
    return cycles, quiet, list(_CONDITION.iter_unpack(body[_RUN.size :]))


def live(quiet: int, milliseconds: int, cycles: int) -> bytes:
    """Return the message LIVE."""
    return message(Order.LIVE, _LIVE.pack(quiet, milliseconds, cycles))


def read_live(body: bytes) -> tuple[int, int, int]:
    """Return the numbers of a message LIVE."""
    quiet, milliseconds, cycles = _LIVE.unpack(body)
    return quiet, milliseconds, cycles


def clocks(base: int, periods: Sequence[int]) -> bytes:
    """Return the message CLOCKS."""
    return message(Order.CLOCKS, _NUMBER.pack(base) + struct.pack(f"<{len(periods)}Q", *periods))


def read_clocks(body: bytes) -> tuple[int, tuple[int, ...]]:
    """Return the base and the periods of a message CLOCKS."""
    base, periods = read_number(body)
    return base, struct.unpack(f"<{len(periods) // 8}Q", periods)


def transfers(stream: int, records: bytes) -> bytes:
    """Return the message TRANSFERS."""
    return message(Answer.TRANSFERS, _NUMBER.pack(stream) + records)


def done(result: Done) -> bytes:
    """Return the message DONE."""
    queued = struct.pack(f"<{len(result.queued)}Q", *result.queued)
    return message(Answer.DONE, _DONE.pack(result.reason, result.cycle) + queued)


def read_done(body: bytes) -> Done:
    """Return the content of a message DONE."""
    reason, cycle = _DONE.unpack_from(body)
    count = (len(body) - _DONE.size) // 8
    queued = struct.unpack_from(f"<{count}Q", body, _DONE.size)
    return Done(reason=Reason(reason), cycle=cycle, queued=queued)
