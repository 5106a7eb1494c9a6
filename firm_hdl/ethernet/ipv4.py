"""The header of IPv4 (RFC 791), and the sum of what follows it (RFC 768, RFC 792, RFC 2236)."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.streams import FrameSignature, add_word, compare, is_all_ones

__all__ = [
    "ALL_SYSTEMS",
    "ICMP",
    "IGMP",
    "UDP",
    "Ipv4Receiver",
    "Ipv4Signature",
    "PayloadCheck",
    "check_state_layout",
    "header_layout",
    "in_payload",
]

ICMP, IGMP, UDP = 1, 2, 17
"""Protocols (RFC 790)."""

ALL_SYSTEMS = 0xE0000001
"""The group of all machines, to which general queries of IGMP go (RFC 2236, section 9)."""

_HEADER_BYTES = 20
_MOST_WORDS = 15


def header_layout() -> data.StructLayout:
    """Return what is known of a datagram of IPv4.

    A member is right from the byte on that completes it, until the next header begins.

    Members
    -------
    place : unsigned(5)
        The place of the byte in the header, from 0 to 19; 20 in the payload.
    index : unsigned(4)
        The place of the byte in the payload, while that is below 16. Then 14 and 15 take turns.
    options : unsigned(1)
        The header has options, which were left out.
    to_node, to_group : unsigned(1)
        The destination is the node, or one of its groups, in the frame's address, too.
    udp, icmp, igmp : unsigned(1)
    source : unsigned(32)
    identification : unsigned(16)
    offset : unsigned(13)
        Of a fragment, in units of 8 bytes.
    more : unsigned(1)
        More fragments follow.
    first : unsigned(1)
        `offset` is 0.
    length : unsigned(11)
        Bytes of the payload; known with the payload only.
    """
    return data.StructLayout(
        {
            "place": range(_HEADER_BYTES + 1),
            "index": 4,
            "options": 1,
            "to_node": 1,
            "to_group": 1,
            "udp": 1,
            "icmp": 1,
            "igmp": 1,
            "source": 32,
            "identification": 16,
            "offset": 13,
            "more": 1,
            "first": 1,
            "length": 11,
        }
    )


def Ipv4Signature() -> wiring.Signature:
    """Return the stream of datagrams of IPv4: a FrameSignature, and a header_layout().

    The first 20 bytes are the header, without options. Padding behind the payload is left out.
    """
    return wiring.Signature({"bytes": Out(FrameSignature()), "header": Out(header_layout())})


def in_payload(header: data.View[data.StructLayout]) -> Value:
    """Whether a byte is one of the payload: its place is 20, and none is above that."""
    return header.place[4] & header.place[2]


class Ipv4Receiver(wiring.Component):
    """Check the header of datagrams, skip its options, and cut the padding off.

    Passed on as good are datagrams of a whole frame, whose header has version 4, a right checksum,
    and a length that the frame has, and whose source can be one (RFC 1122, 3.2.1.3): not the node
    itself, no group, not broadcast, not 0.0.0.0. The destination is the node, or a group, in both
    addresses (RFC 1122, 3.3.6). A header behind which the frame has nothing counts as wrong.

    A byte per cycle; latency 1 cycle. Outputs are registers.

    Parameters
    ----------
    address : int
    groups : tuple of int
        Addresses, 32 bits.

    Members
    -------
    payloads : In(FrameSignature())
    to_node, to_group : In(1)
        As those of a :class:`firm_hdl.ethernet.header.HeaderReceiver`.
    datagrams : Out(Ipv4Signature())
    malformed, other : Out(1)
        Strobes: the header was wrong; the datagram is for others, or of another protocol.
    """

    def __init__(self, address: int, groups: tuple[int, ...] = ()):
        self.address, self.groups = address, groups
        super().__init__(
            {
                "payloads": In(FrameSignature()),
                "to_node": In(1),
                "to_group": In(1),
                "datagrams": Out(Ipv4Signature()),
                "malformed": Out(1),
                "other": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, byte = self.payloads, self.payloads.payload.data
        out, header = self.datagrams.bytes, self.datagrams.header
        # The place in the header, options included.
        place = Signal(range(4 * _MOST_WORDS + 1))
        words, last_word = Signal(4), Signal(4)
        in_header, wrong, right = Signal(init=1), Signal(), Signal()
        total = Signal(17)
        length, rest, left = Signal(16), Signal(17), Signal(11)
        own, nobody = Signal(), Signal()
        ours = Signal()
        to_node, to_groups = Signal(), [Signal(name=f"to_{n}") for n in range(len(self.groups))]
        begins = Signal()
        m.d.comb += [begins.eq(place == 0)]
        m.d.comb += [
            header.to_node.eq(to_node & self.to_node),
            header.to_group.eq(Cat(to_groups).any() & self.to_group),
            ours.eq(header.to_node | header.to_group),
        ]
        least = _HEADER_BYTES // 4
        known = header.udp | header.icmp | header.igmp
        m.d.sync += [
            out.valid.eq(0),
            out.payload.data.eq(byte),
            out.payload.end.eq(came.payload.end),
            self.malformed.eq(0),
            self.other.eq(0),
            right.eq(is_all_ones(total) & ~wrong & ~own & ~nobody),
            last_word.eq(words - 1),
            # Wraps around if the header is longer than the datagram.
            rest.eq(length - Cat(Const(0, 2), words)),
            header.options.eq(words != least),
        ]
        with m.If(came.valid & came.payload.end):
            m.d.sync += [place.eq(0), in_header.eq(1)]
            whole = right & ~in_header & (left == 0)
            m.d.sync += [
                out.valid.eq(1),
                out.payload.good.eq(came.payload.good & whole & ours & known),
                self.malformed.eq(came.payload.good & ~whole),
                self.other.eq(came.payload.good & whole & ~(ours & known)),
            ]
        with m.Elif(came.valid & in_header):
            m.d.sync += [
                place.eq(place + 1),
                header.index.eq(15),
                total.eq(
                    add_word(Mux(begins, 0, total), Mux(place[0], byte, Cat(Const(0, 8), byte)))
                ),
            ]
            with m.If(place < _HEADER_BYTES):
                m.d.sync += [out.valid.eq(1), header.place.eq(place)]
            with m.If((place[2:] == last_word) & place[:2].all()):
                m.d.sync += [in_header.eq(0), left.eq(rest), header.length.eq(rest)]
                with m.If(rest[11:].any()):
                    m.d.sync += wrong.eq(1)
            compare(m, own, byte, place, 12, self.address, 4)
            compare(m, to_node, byte, place, 16, self.address, 4)
            for flag, group in zip(to_groups, self.groups, strict=True):
                compare(m, flag, byte, place, 16, group, 4)
            with m.Switch(place):
                with m.Case(0):
                    m.d.sync += [
                        words.eq(Mux(byte[:4] < least, least, byte[:4])),
                        wrong.eq((byte[4:] != 4) | (byte[:4] < least)),
                    ]
                with m.Case(2, 3):
                    m.d.sync += length.eq(Cat(byte, length))
                with m.Case(4, 5):
                    m.d.sync += header.identification.eq(Cat(byte, header.identification))
                with m.Case(6):
                    m.d.sync += [header.more.eq(byte[5]), header.offset[8:].eq(byte[:5])]
                    m.d.sync += header.first.eq(byte[:5] == 0)
                with m.Case(7):
                    m.d.sync += header.offset[:8].eq(byte)
                    m.d.sync += header.first.eq(header.first & (byte == 0))
                with m.Case(9):
                    m.d.sync += [
                        header.udp.eq(byte == UDP),
                        header.icmp.eq(byte == ICMP),
                        header.igmp.eq(byte == IGMP),
                    ]
                with m.Case(12):
                    # Groups, reserved addresses and broadcast begin with 224 to 255.
                    m.d.sync += nobody.eq(byte[5:].all() | (byte == 0))
            with m.If((place >= 12) & (place < 16)):
                m.d.sync += header.source.eq(Cat(byte, header.source))
        with m.Elif(came.valid):
            m.d.sync += [
                out.valid.eq(left != 0),
                left.eq(left - (left != 0)),
                header.place.eq(_HEADER_BYTES),
                # It was 15 before the first byte.
                header.index.eq(
                    Mux(
                        header.index.all(),
                        Mux(header.place == _HEADER_BYTES, 14, 0),
                        header.index + 1,
                    )
                ),
            ]
        return m


def check_state_layout() -> data.StructLayout:
    """Return what a :class:`PayloadCheck` knows of a payload.

    Members
    -------
    total : unsigned(17)
        The sum, as :func:`firm_hdl.ethernet.streams.add_word` has it.
    length : unsigned(16)
        Length in the header of UDP.
    port : unsigned(1)
        The destination is a port of the node.
    no_sum : unsigned(1)
        The sender made no checksum (RFC 768).
    """
    return data.StructLayout({"total": 17, "length": 16, "port": 1, "no_sum": 1})


class PayloadCheck(wiring.Component):
    """Sum the payload up, and read the header of UDP.

    The sum of UDP has a pseudo header: addresses, protocol, length. For ICMP and IGMP, it is that
    of the payload alone. A datagram may come in fragments; then the state after one of them is
    loaded before the next one.

    A byte per cycle. `state` is that of all bytes before; `right` is a cycle behind.

    Parameters
    ----------
    ports : tuple of int
        Ports of UDP of the node.

    Members
    -------
    datagrams : In(Ipv4Signature())
    load : In(1)
        Strobe, with or after byte 11 of a header and before its payload: go on from `loaded`.
    loaded : In(check_state_layout())
    state : Out(check_state_layout())
    right : Out(1)
        The sum is that of right data, or UDP has none.
    """

    def __init__(self, ports: tuple[int, ...]):
        self.ports = ports
        super().__init__(
            {
                "datagrams": In(Ipv4Signature()),
                "load": In(1),
                "loaded": In(check_state_layout()),
                "state": Out(check_state_layout()),
                "right": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, header, state = self.datagrams.bytes, self.datagrams.header, self.state
        byte = came.payload.data
        first, is_payload = header.first, in_payload(header)
        word, adds = Signal(16), Signal()
        ports = [Signal(name=f"port_{port}") for port in self.ports]
        place = Mux(is_payload, header.index, header.place)
        m.d.comb += word.eq(Mux(place[0], byte, Cat(Const(0, 8), byte)))
        pseudo = header.udp & first & (header.place >= 12)
        m.d.comb += adds.eq(came.valid & ~came.payload.end & (is_payload | pseudo))
        # The length of UDP counts twice, as it is in the pseudo header, too. Twice a word in one's
        # complement is the word rotated by a bit. A byte is half a word, in one half or the other.
        twice = is_payload & header.udp & first & (header.index[1:] == 2)
        m.d.sync += self.right.eq(is_all_ones(state.total) | (header.udp & state.no_sum))
        with m.If(self.load):
            m.d.sync += state.eq(self.loaded)
        with m.Elif(came.valid & (header.place == 11)):
            m.d.sync += state.total.eq(Mux(header.udp & first, UDP, 0))
        with m.Elif(adds):
            m.d.sync += state.total.eq(
                add_word(state.total, Mux(twice, Cat(word[-1], word[:-1]), word))
            )
        with m.If(came.valid & ~came.payload.end & is_payload & header.udp & first):
            for flag, port in zip(ports, self.ports, strict=True):
                compare(m, flag, byte, header.index, 2, port, 2)
            with m.Switch(header.index):
                with m.Case(4):
                    m.d.sync += [state.length[8:].eq(byte), state.port.eq(Cat(ports).any())]
                with m.Case(5):
                    m.d.sync += state.length[:8].eq(byte)
                with m.Case(6):
                    m.d.sync += state.no_sum.eq(byte == 0)
                with m.Case(7):
                    m.d.sync += state.no_sum.eq(state.no_sum & (byte == 0))
        return m
