"""A UART: 8 data bits, no parity, 1 stop bit."""

from __future__ import annotations

import math

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.cdc import FFSynchronizer
from amaranth.lib.wiring import In, Out

__all__ = ["UartReceiver", "UartTransmitter"]


class UartTransmitter(wiring.Component):
    """Send bytes: a start bit of 0, the lowest bit first, a stop bit of 1.

    Parameters
    ----------
    cycles : int
        Cycles per bit, at least 4.

    Members
    -------
    i : In(stream.Signature(8))
        A byte is taken every 10 bits.
    tx : Out(1)
        The line; 1 while it is idle. A register.
    """

    def __init__(self, cycles: int):
        self.cycles = _checked(cycles)
        super().__init__({"i": In(stream.Signature(8)), "tx": Out(1, init=1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # Bits that are not sent, the next one lowest; a 1 above them marks the end.
        bits = Signal(10, init=1)
        count = Signal(range(self.cycles))
        is_idle = bits == 1
        m.d.comb += self.i.ready.eq(is_idle & (count == 0))
        with m.If(count != 0):
            m.d.sync += count.eq(count - 1)
        with m.Elif(~is_idle):
            m.d.sync += [self.tx.eq(bits[0]), bits.eq(bits[1:]), count.eq(self.cycles - 1)]
        with m.Elif(self.i.valid):
            m.d.sync += [
                self.tx.eq(0),
                # The stop bit, and the mark of the end.
                bits.eq(Cat(self.i.payload, Const(3, 2))),
                count.eq(self.cycles - 1),
            ]
        return m


class UartReceiver(wiring.Component):
    """Receive bytes; those without a stop bit are dropped.

    Each bit is read near its middle, also if the sender is 2 % fast or slow. The line passes two
    registers first. A byte that is not taken before the next one comes is lost, and counts as an
    overrun.

    Parameters
    ----------
    cycles : float
        Cycles per bit, at least 4. The nearest integer may be 2 % off.

    Members
    -------
    rx : In(1)
    o : Out(stream.Signature(8))
        Registers.
    broken, overrun : Out(1)
        High for a cycle for each byte that was dropped: without a stop bit, or not taken in time.
    """

    def __init__(self, cycles: float):
        self.cycles = _checked(round(cycles))
        # From the edge of a start bit to the cycle in which it is read. Errors add up until the
        # stop bit, so that is the one whose middle, 9.5 bits later, is met. The edge is seen half a
        # cycle late on average:
        #
        #     line   ~~\___start___/  bit 0  \__ ... __/  stop   \
        #     read          ^             ^                 ^
        #              first       + cycles         + 9 * cycles
        self.first = math.floor(9.5 * cycles - 9 * self.cycles)
        super().__init__(
            {
                "rx": In(1, init=1),
                "o": Out(stream.Signature(8)),
                "broken": Out(1),
                "overrun": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        line = Signal(init=1)
        m.submodules.line = FFSynchronizer(self.rx, line, init=1)
        bits = Signal(9)
        number = Signal(range(10))
        count = Signal(range(2 * self.cycles))
        with m.If(self.o.ready):
            m.d.sync += self.o.valid.eq(0)
        m.d.sync += [self.broken.eq(0), self.overrun.eq(0)]
        with m.FSM():
            with m.State("IDLE"):
                # If the line is 1 when the start bit is read, it was a glitch.
                m.d.sync += [count.eq(self.first - 1), number.eq(0)]
                with m.If(~line):
                    m.next = "BITS"
            with m.State("BITS"):
                m.d.sync += count.eq(count - 1)
                with m.If(count == 0):
                    m.d.sync += [
                        count.eq(self.cycles - 1),
                        bits.eq(Cat(bits[1:], line)),
                        number.eq(number + 1),
                    ]
                    with m.If((number == 0) & line):
                        m.next = "IDLE"
                    with m.Elif(number == 9):
                        # The stop bit. The next start bit may come half a bit later.
                        self._end(m, line, bits[1:])
            with m.State("WAIT"), m.If(line):
                # A line that stays 0, as in a break, begins no byte.
                m.next = "IDLE"
        return m

    def _end(self, m: Module, line: Signal, byte: Value) -> None:
        """Pass a byte on, if it has a stop bit and the one before it was taken."""
        is_free = ~self.o.valid | self.o.ready
        m.d.sync += [self.broken.eq(~line), self.overrun.eq(line & ~is_free)]
        with m.If(line & is_free):
            m.d.sync += [self.o.payload.eq(byte), self.o.valid.eq(1)]
        m.next = "IDLE"
        with m.If(~line):
            m.next = "WAIT"


def _checked(cycles: int) -> int:
    if cycles < 4:
        raise ValueError(f"A bit must take 4 cycles at least, not {cycles}")
    return cycles
