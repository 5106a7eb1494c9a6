"""AXI4-Stream (Arm IHI 0051) in place of packet streams, for the cores of others.

A packet stream counts the bytes of a beat, and AXI4-Stream marks them in TKEEP. All else is the
same: TLAST ends a packet, and a transfer happens when TVALID and TREADY are both high.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Module, Mux, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.limits import check_bits
from firm_hdl.gateware.positions import named
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import check_bus_bytes

__all__ = [
    "AxiStreamSignature",
    "AxiStreamToPackets",
    "PacketsToAxiStream",
    "count_of_keep",
    "keep_of_count",
]


def count_of_keep(m: Module, keep: Value, last: Value) -> Value:
    """Return the number of bytes in a beat: ones of TKEEP from bit 0 up to the first zero.

    All bytes count in a beat that is not the last one of its packet.
    """
    lanes = len(keep)
    # One-hot; bits above the first zero have no effect.
    found = {
        n: named(m, f"tkeep_begins_with_{n}", keep[:n].all() & ~keep[n]) for n in range(1, lanes)
    }
    found[lanes] = keep.all()
    bits = range(lanes.bit_length())
    ones = Cat(Cat(here for n, here in found.items() if n >> bit & 1).any() for bit in bits)
    return Mux(last, ones, lanes)


def keep_of_count(count: Value, lanes: int) -> Value:
    """Return TKEEP of a beat with that many bytes."""
    return Cat(count > lane for lane in range(lanes))


class AxiStreamSignature(wiring.Signature):
    """An AXI4-Stream of packets, seen from the side that sends it.

    Two signatures are equal if their parameters are equal.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    user_bits, dest_bits : int
        Bits of TUSER and TDEST. 0: there is none.

    Members
    -------
    tdata : Out(8 * bus_bytes)
        Bytes; the first one on the wire is in bits 7 to 0.
    tkeep : Out(bus_bytes)
        Valid bytes, from lane 0 on; only the value in the last beat of a packet counts. Tie to -1
        what a core without TKEEP does not have.
    tlast, tvalid : Out(1)
    tready : In(1)
    tuser : Out(user_bits)
    tdest : Out(dest_bits)

    Raises
    ------
    TypeError, ValueError
    """

    def __init__(self, bus_bytes: int, *, user_bits: int = 0, dest_bits: int = 0):
        check_bus_bytes(bus_bytes)
        check_bits("Number of user bits", user_bits)
        check_bits("Number of destination bits", dest_bits)
        self.bus_bytes, self.user_bits, self.dest_bits = bus_bytes, user_bits, dest_bits
        super().__init__(
            {
                "tdata": Out(8 * bus_bytes),
                "tkeep": Out(bus_bytes),
                "tlast": Out(1),
                "tvalid": Out(1),
                "tready": In(1),
                **({"tuser": Out(user_bits)} if user_bits else {}),
                **({"tdest": Out(dest_bits)} if dest_bits else {}),
            }
        )

    def __eq__(self, other: object) -> bool:
        return type(other) is AxiStreamSignature and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def _key(self) -> tuple[int, int, int]:
        return self.bus_bytes, self.user_bits, self.dest_bits

    def __repr__(self) -> str:
        bus_bytes, user, dest = self._key
        return f"AxiStreamSignature({bus_bytes}, user_bits={user}, dest_bits={dest})"


class _Adapter(Component):
    """A stream of either kind, and the other one of the same packets.

    * `flow`: of `packets`.
    """

    axis: Any
    packets: PacketStream

    def __init__(self, flow: Any, bus_bytes: int, side_bits: int, dest_bits: int):
        self.bus_bytes, self.side_bits, self.dest_bits = bus_bytes, side_bits, dest_bits
        axis = AxiStreamSignature(bus_bytes, user_bits=side_bits, dest_bits=dest_bits)
        way = "in" if flow is In else "out"
        super().__init__(
            {
                "axis": (Out if flow is In else In)(axis),
                "packets": flow(PacketSignature(bus_bytes)),
                **({f"side_{way}": flow(side_bits)} if side_bits else {}),
                **({f"dest_{way}": flow(dest_bits)} if dest_bits else {}),
            }
        )


class AxiStreamToPackets(_Adapter):
    """Read packets from an AXI4-Stream.

    Combinational: no registers, latency 0. `packets.valid` and its payload depend on `axis`, and
    `axis.tready` on `packets.ready`.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    side_bits : int
        Bits of TUSER, which travel beside each beat as in packet parts. 0: there is none.
    dest_bits : int
        Bits of TDEST, such as the `topic` of a :class:`PacketRouter`. 0: there is none.

    Members
    -------
    axis : In(AxiStreamSignature(bus_bytes, user_bits=side_bits, dest_bits=dest_bits))
    packets : Out(PacketSignature(bus_bytes))
        A last beat in which no byte is valid adds none.
    side_out : Out(side_bits)
        Only with `side_bits`. TUSER; valid with `packets`.
    dest_out : Out(dest_bits)
        Only with `dest_bits`. TDEST; valid with `packets`.

    Raises
    ------
    TypeError, ValueError
    """

    side_out: Value
    dest_out: Value

    def __init__(self, bus_bytes: int, *, side_bits: int = 0, dest_bits: int = 0):
        super().__init__(Out, bus_bytes, side_bits, dest_bits)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        axis, packets = self.axis, self.packets
        m.d.comb += [
            Value.cast(packets.payload.data).eq(axis.tdata),
            packets.payload.count.eq(count_of_keep(m, axis.tkeep, axis.tlast)),
            packets.payload.last.eq(axis.tlast),
            packets.valid.eq(axis.tvalid),
            axis.tready.eq(packets.ready),
        ]
        if self.side_bits:
            m.d.comb += self.side_out.eq(axis.tuser)
        if self.dest_bits:
            m.d.comb += self.dest_out.eq(axis.tdest)
        return m


class PacketsToAxiStream(_Adapter):
    """Write packets to an AXI4-Stream.

    Combinational: no registers, latency 0. `axis.tvalid` and all that goes with it depend on
    `packets`, and `packets.ready` on `axis.tready`.

    Parameters
    ----------
    bus_bytes, side_bits, dest_bits
        As for :class:`AxiStreamToPackets`. `packet_error` of a :class:`Serializer` is one bit
        beside each beat.

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    side_in : In(side_bits)
        Only with `side_bits`. TUSER; as stable as the payload.
    dest_in : In(dest_bits)
        Only with `dest_bits`. TDEST; as stable as the payload.
    axis : Out(AxiStreamSignature(bus_bytes, user_bits=side_bits, dest_bits=dest_bits))
        TKEEP has ones from bit 0 on; all but in the last beat of a packet. It is 0 only in the one
        beat of an empty packet.

    Raises
    ------
    TypeError, ValueError
    """

    side_in: Value
    dest_in: Value

    def __init__(self, bus_bytes: int, *, side_bits: int = 0, dest_bits: int = 0):
        super().__init__(In, bus_bytes, side_bits, dest_bits)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        axis, packets = self.axis, self.packets
        m.d.comb += [
            axis.tdata.eq(Value.cast(packets.payload.data)),
            axis.tkeep.eq(keep_of_count(packets.payload.count, self.bus_bytes)),
            axis.tlast.eq(packets.payload.last),
            axis.tvalid.eq(packets.valid),
            packets.ready.eq(axis.tready),
        ]
        if self.side_bits:
            m.d.comb += axis.tuser.eq(self.side_in)
        if self.dest_bits:
            m.d.comb += axis.tdest.eq(self.dest_in)
        return m
