"""Membership of groups (RFC 1112, RFC 2236): IGMP version 2 of a host."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.ipv4 import Ipv4Signature, in_payload
from firm_hdl.ethernet.streams import compare

__all__ = ["IgmpHost"]

_QUERY = 0x11
_UNSOLICITED = 3
"""Reports at the start: a lost one is made up for (RFC 2236, 8.10, asks for 2)."""

_OLD_MAXIMUM = 100
"""Of a query of version 1, in tenths of a second (RFC 2236, section 4)."""


class IgmpHost(wiring.Component):
    """Ask for reports of the node's groups: at the start, and in answer to queries.

    After a query, the reports of all groups follow at a moment that depends on a counter, within
    the time that the query names. Reports of others are not heeded, as in version 3 (RFC 3376,
    appendix A.2): switches that watch IGMP need those of each machine. The node never leaves.

    Parameters
    ----------
    groups : tuple of int
        Addresses, 32 bits; at least one.

    Members
    -------
    datagrams : In(Ipv4Signature())
    right : In(1)
        As that of a :class:`firm_hdl.ethernet.ipv4.PayloadCheck`.
    tick : In(1)
        Strobe, about each 60 ms.
    pending : Out(1)
        A report is to be sent.
    group : Out(range(len(groups)))
        Of which group.
    sent : In(1)
        Strobe: it is on its way.
    wrong, other : Out(1)
        Strobes: a message had a wrong checksum; it is no query for the node.
    """

    def __init__(self, groups: tuple[int, ...]):
        self.groups = groups
        super().__init__(
            {
                "datagrams": In(Ipv4Signature()),
                "right": In(1),
                "tick": In(1),
                "pending": Out(1),
                "group": Out(range(len(groups))),
                "sent": In(1),
                "wrong": Out(1),
                "other": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, header = self.datagrams.bytes, self.datagrams.header
        byte = came.payload.data
        query, ends = Signal(), Signal()
        general, ours = Signal(), [Signal(name=f"is_{n}") for n in range(len(self.groups))]
        maximum = Signal(8)
        # Reports follow when this many ticks are over; each time at another moment of the counter.
        counter, delay = Signal(7), Signal(8, init=1)
        unsolicited = Signal(range(_UNSOLICITED + 1), init=_UNSOLICITED)
        m.d.sync += [
            counter.eq(counter + 1),
            ends.eq(came.valid & came.payload.end & came.payload.good & header.igmp),
            self.wrong.eq(ends & ~self.right),
            self.other.eq(0),
        ]
        with m.If(came.valid & ~came.payload.end & in_payload(header)):
            with m.Switch(header.index):
                with m.Case(0):
                    m.d.sync += query.eq(byte == _QUERY)
                with m.Case(1):
                    m.d.sync += maximum.eq(Mux(byte == 0, _OLD_MAXIMUM, byte))
            compare(m, general, byte, header.index, 4, 0, 4)
            for flag, group in zip(ours, self.groups, strict=True):
                compare(m, flag, byte, header.index, 4, group, 4)
        with m.If(self.tick & (delay != 0)):
            m.d.sync += delay.eq(delay - 1)
            with m.If(delay == 1):
                m.d.sync += self.pending.eq(1)
                with m.If(unsolicited != 0):
                    m.d.sync += unsolicited.eq(unsolicited - 1)
                with m.If(unsolicited > 1):
                    m.d.sync += delay.eq(_OLD_MAXIMUM)
        with m.If(self.sent):
            last = self.group == len(self.groups) - 1
            m.d.sync += [
                self.group.eq(Mux(last, 0, self.group + 1)),
                self.pending.eq(~last),
            ]
        valid = query & self.right & ~header.more & header.first
        valid = valid & (general | Cat(ours).any()) & (header.length >= 8)
        # A mask of ones keeps the delay within the maximum; a tick is less than a tenth.
        mask = Cat(maximum[1 + bit :].any() for bit in range(len(counter)))
        within = Signal.like(delay)
        m.d.sync += within.eq((counter & mask) + 1)
        with m.If(ends & valid), m.If((delay == 0) | (within < delay)):
            m.d.sync += delay.eq(within)
        with m.Elif(ends):
            m.d.sync += self.other.eq(self.right)
        return m
