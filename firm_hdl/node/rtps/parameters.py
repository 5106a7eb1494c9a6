"""Parameter lists as streams (9.4.2.11): nothing is stored, whatever the size of a parameter."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

__all__ = ["ParameterReader", "swapped"]

_SENTINEL = 0x0001
# 9.6.2.2.1: the bits that say "of a vendor", and "must understand".
_VENDOR, _MUST_UNDERSTAND = 15, 14


def swapped(word: Value) -> Value:
    """Return a word with its bytes in the other order."""
    return Cat(word.word_select(place, 8) for place in reversed(range(len(word) // 8)))


class ParameterReader(wiring.Component):
    """Divide a list of parameters into the words of their values.

    A byte per cycle, and a cycle more per parameter. Outputs of a byte come in its cycle.

    Members
    -------
    begins : In(1)
        The next byte begins a list. Only after the one before has ended or failed.
    byte, takes : In(8), In(1)
        A byte of the list; `takes` only where `wants` is high.
    is_little : In(1)
        Byte order.
    left : In(16)
        Bytes that the submessage has yet, this one included.
    wants : Out(1)
        A byte of the list comes next.
    pid : Out(16)
        Identifier of the parameter, without the bit "must understand". It stays until the head of
        the next one was read.
    index : Out(5)
        Number of the word in its value; all from 16 on have numbers from 16 on.
    adds : Out(1)
        A byte of a value is taken.
    aligned : Out(1)
        The last byte of a word is taken.
    word, value : Out(32)
        The word, its first byte in the lowest bits; and as a number in the order of the list.
    ended, failed : Out(1)
        The sentinel was read; the list is longer than its submessage.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "begins": In(1),
                "byte": In(8),
                "takes": In(1),
                "is_little": In(1),
                "left": In(16),
                "wants": Out(1),
                "pid": Out(16),
                "index": Out(5),
                "adds": Out(1),
                "aligned": Out(1),
                "word": Out(32),
                "value": Out(32),
                "ended": Out(1),
                "failed": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        older = Signal(24)
        place = Signal(2)
        size = Signal(16)
        m.d.comb += [
            self.word.eq(Cat(older, self.byte)),
            self.value.eq(Mux(self.is_little, self.word, swapped(self.word))),
        ]
        with m.If(self.takes):
            m.d.sync += [older.eq(self.word[8:]), place.eq(place + 1)]
        with m.FSM(init="ENDED"):
            with m.State("HEAD"):
                m.d.comb += self.wants.eq(1)
                with m.If((place == 0) & (self.left < 4)):
                    m.d.comb += self.wants.eq(0)
                    m.next = "FAILED"
                with m.If(self.takes & (place == 3)):
                    first, second = self.value[:16], self.value[16:]
                    pid = Mux(self.is_little, first, second)
                    must = ~pid[_VENDOR] & pid[_MUST_UNDERSTAND]
                    m.d.sync += [
                        self.pid.eq(pid & ~(must << _MUST_UNDERSTAND)),
                        size.eq(Mux(self.is_little, second, first)),
                        self.index.eq(0),
                    ]
                    m.next = "CHECK"
            with m.State("CHECK"):
                m.next = "VALUE"
                with m.If(self.pid == _SENTINEL):
                    m.next = "ENDED"
                with m.Elif(size > self.left):
                    m.next = "FAILED"
                with m.Elif(size == 0):
                    m.next = "HEAD"
            with m.State("VALUE"):
                m.d.comb += [
                    self.wants.eq(1),
                    self.adds.eq(self.takes),
                    self.aligned.eq(self.takes & (place == 3)),
                ]
                with m.If(self.takes):
                    m.d.sync += size.eq(size - 1)
                    with m.If(place == 3):
                        m.d.sync += self.index.eq(Mux(self.index[4], self.index, self.index + 1))
                    with m.If(size == 1):
                        m.d.sync += place.eq(0)
                        m.next = "HEAD"
            with m.State("ENDED"):
                m.d.comb += self.ended.eq(1)
                self._begin(m, place)
            with m.State("FAILED"):
                m.d.comb += self.failed.eq(1)
                self._begin(m, place)
        return m

    def _begin(self, m: Module, place: Signal) -> None:
        with m.If(self.begins):
            m.d.sync += [place.eq(0), self.pid.eq(0)]
            m.next = "HEAD"
