"""Counters of a node, and how a host reads them."""

from __future__ import annotations

from collections.abc import Sequence

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

__all__ = ["ByteCounter", "RegisterReader", "read_cycles"]

_GROUP = 16


def read_cycles(count: int) -> int:
    """Return the cycles from a new number of one of `count` registers to its value."""
    return 2 + -(-count // _GROUP)


class ByteCounter(wiring.Component):
    """Count bytes of packets, in 64 bits. The upper half changes a cycle after the lower one.

    Members
    -------
    adds : In(1)
        A packet of `size` bytes is counted in this cycle.
    size : In(size_bits)
    low, high : Out(32)
    """

    def __init__(self, size_bits: int):
        super().__init__({"adds": In(1), "size": In(size_bits), "low": Out(32), "high": Out(32)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        adds, size, carry = Signal(), Signal.like(self.size), Signal()
        total = Signal(33)
        m.d.comb += total.eq(self.low + Mux(adds, size, 0))
        m.d.sync += [
            adds.eq(self.adds),
            size.eq(self.size),
            self.low.eq(total),
            carry.eq(total[32]),
            self.high.eq(self.high + carry),
        ]
        return m


class RegisterReader(wiring.Component):
    """Give the value of one of many registers, `read_cycles(count)` cycles after its number.

    The registers are far from each other. So they are divided into groups, and each group has
    registers for the number and for its value, in a chain from group to group.

    Parameters
    ----------
    count : int
        Number of registers.

    Members
    -------
    values : In(ArrayLayout(32, count))
    number : In(range(count))
        Has to stay until the value is there.
    value : Out(32)
    """

    def __init__(self, count: int):
        super().__init__(
            {
                "values": In(data.ArrayLayout(32, count)),
                "number": In(range(max(2, count))),
                "value": Out(32),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        values = [Value.cast(each) for each in self.values]
        bits = ceil_log2(_GROUP)
        number, value = self.number, Const(0, 32)
        for place, at in enumerate(range(0, len(values), _GROUP)):
            here = Signal.like(self.number, name=f"number_{place}", reset_less=True)
            mine = Signal(32, name=f"group_{place}", reset_less=True)
            chosen = Signal(32, name=f"value_{place}", reset_less=True)
            m.d.sync += [
                here.eq(number),
                mine.eq(_pick(values[at : at + _GROUP], here[:bits])),
                chosen.eq(Mux(here[bits:] == place, mine, value)),
            ]
            number, value = here, chosen
        m.d.comb += self.value.eq(value)
        return m


def _pick(values: Sequence[Value], number: Value) -> Value:
    """Return the value with a number; the last one for numbers without a value."""
    if len(values) == 1:
        return values[0]
    half = 1 << (ceil_log2(len(values)) - 1)
    bit = ceil_log2(half)
    if bit >= len(number):
        return _pick(values[:half], number)
    return Mux(number[bit], _pick(values[half:], number[:bit]), _pick(values[:half], number[:bit]))
