"""UDP (RFC 768): datagrams that come, and datagrams to send."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.ethernet.ipv4 import UDP, Ipv4Signature, check_state_layout, in_payload
from firm_hdl.ethernet.slots import DATAGRAM, SlotWriterSignature
from firm_hdl.ethernet.streams import add_word
from firm_hdl.gateware.memories import BlockMemory

__all__ = [
    "HEADER_BYTES",
    "MOST_PAYLOAD",
    "WORD_BYTES",
    "DatagramReader",
    "StoreSignature",
    "UdpForwarder",
    "UdpReceiver",
    "UdpTransmitter",
    "join_words",
]

MOST_PAYLOAD = 1472
"""Largest payload of a datagram that is sent: it is not cut."""

WORD_BYTES = 4
"""Bytes of a word of datagrams to send."""

HEADER_BYTES = 8
_SOURCE_BYTES = 4


def StoreSignature() -> wiring.Signature:
    """Return how stored datagrams are read, seen from the store.

    A datagram is stored as the address of its source, 4 bytes, the header of UDP, and the payload.

    Members
    -------
    full : Out(1)
        There is a datagram.
    moves : In(1)
        The two steps of reading go on.
    takes : In(1)
        With `moves`: the next byte is read. It is on `byte` 2 steps later.
    byte : Out(8)
    release : In(1)
        Strobe: all bytes were read.
    """
    return wiring.Signature(
        {
            "full": Out(1),
            "moves": In(1),
            "takes": In(1),
            "byte": Out(8),
            "release": In(1),
        }
    )


class UdpReceiver(wiring.Component):
    """Store datagrams that are right and come in one piece, and drop all others.

    Right is a datagram for one of the node's ports, whose checksum is right or 0, whose length is
    that of IPv4's payload, and which is not empty. Its bytes are written as they come; they count
    when it has ended.

    A byte per cycle. A datagram can be read 3 cycles after its `end`.

    Parameters
    ----------
    memory_bytes : int
        A power of two, at least 2048.
    datagrams : int
        Most datagrams in the memory.

    Members
    -------
    datagrams : In(Ipv4Signature())
    check : In(check_state_layout())
    right : In(1)
        As those of a :class:`firm_hdl.ethernet.ipv4.PayloadCheck`.
    store : Out(StoreSignature())
    no_port, wrong, empty, full : Out(1)
        Strobes: a datagram was dropped, for one of these reasons.
    """

    def __init__(self, memory_bytes: int = 4096, datagrams: int = 32):
        self.memory_bytes, self.most = memory_bytes, datagrams
        super().__init__(
            {
                "datagrams": In(Ipv4Signature()),
                "check": In(check_state_layout()),
                "right": In(1),
                "store": Out(StoreSignature()),
                "no_port": Out(1),
                "wrong": Out(1),
                "empty": Out(1),
                "full": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, header, check = self.datagrams.bytes, self.datagrams.header, self.check
        ring = BlockMemory(m, 8, self.memory_bytes)
        # Bytes from `head` to `tail` are those of datagrams that count.
        at, tail, head = (Signal(range(self.memory_bytes), name=n) for n in ("at", "tail", "head"))
        level = Signal(range(self.memory_bytes))
        waiting = Signal(range(self.most + 1))
        room, ours, ends, commit = Signal(), Signal(), Signal(), Signal()
        is_source, fits, empty = Signal(), Signal(), Signal()
        m.d.comb += [
            ours.eq(header.udp & header.first & ~header.more),
            is_source.eq((header.place >= 12) & (header.place < 16)),
            ring.write_at.eq(at),
            ring.write_word.eq(came.payload.data),
            ring.writes.eq(
                came.valid & ~came.payload.end & ours & room & (is_source | in_payload(header))
            ),
            self.store.full.eq(waiting != 0),
            ring.read_at.eq(head),
            ring.reads.eq(self.store.moves),
        ]
        m.d.sync += [
            level.eq(tail - head),
            # All bytes have come a cycle before `ends`. Without a whole header, `check` has fields
            # of what came before.
            fits.eq((check.length == header.length) & (header.length >= HEADER_BYTES)),
            empty.eq(check.length == HEADER_BYTES),
            ends.eq(came.valid & came.payload.end & came.payload.good & ours),
            self.no_port.eq(0),
            self.wrong.eq(0),
            self.empty.eq(0),
            self.full.eq(0),
        ]
        with m.If(self.store.moves):
            m.d.sync += [self.store.byte.eq(ring.word), head.eq(head + self.store.takes)]
        with m.If(came.valid & (header.place == 11)):
            # The largest frame has room, so the size need not be known.
            m.d.sync += [
                at.eq(tail),
                room.eq((level < self.memory_bytes - MOST_PAYLOAD - 64) & (waiting != self.most)),
            ]
        with m.Elif(ring.writes):
            m.d.sync += at.eq(at + 1)
        with m.If(ends):
            right = self.right & fits
            m.d.comb += commit.eq(check.port & right & ~empty & room)
            m.d.sync += [
                self.no_port.eq(~check.port),
                self.wrong.eq(check.port & ~right),
                self.empty.eq(check.port & right & empty),
                self.full.eq(check.port & right & ~empty & ~room),
            ]
            with m.If(commit):
                m.d.sync += tail.eq(at)
        m.d.sync += waiting.eq(waiting + commit - self.store.release)
        return m


class UdpForwarder(wiring.Component):
    """Pass datagrams on as they come, and say with the last byte whether they are right.

    What a :class:`UdpReceiver` would not store has `error`, or nothing comes of it. A byte leaves
    when the next one has come, the last one 2 cycles after the `end`.

    Members
    -------
    datagrams, check, right, no_port, wrong, empty : as those of a :class:`UdpReceiver`
    received : Out(DatagramSignature(1))
        Cannot be held.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "datagrams": In(Ipv4Signature()),
                "check": In(check_state_layout()),
                "right": In(1),
                "received": Out(DatagramSignature(1)),
                "no_port": Out(1),
                "wrong": Out(1),
                "empty": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, header, check = self.datagrams.bytes, self.datagrams.header, self.check
        out = self.received
        byte, has_byte = Signal(8), Signal()
        ports, length = Signal(32), Signal(16)
        ours, comes, ends, closes, fits, right = (
            Signal(name=name) for name in ("ours", "comes", "ends", "closes", "fits", "is_right")
        )
        m.d.comb += [
            comes.eq(came.valid & ~came.payload.end & ours & in_payload(header)),
            right.eq(ends & self.right & fits),
        ]
        m.d.sync += [
            # The header is there a cycle before the payload. A good end has it in `good`.
            ours.eq(header.udp & header.first & ~header.more & (header.to_node | header.to_group)),
            # All bytes have come a cycle before `ends`.
            fits.eq(check.length == header.length),
            length.eq(check.length - HEADER_BYTES),
            closes.eq(came.valid & came.payload.end),
            ends.eq(came.valid & came.payload.end & came.payload.good & ours),
            self.no_port.eq(ends & ~check.port),
            self.wrong.eq(ends & check.port & ~(self.right & fits)),
            self.empty.eq(right & check.port & (length == 0)),
            out.valid.eq(0),
            out.payload.data.eq(byte),
            out.payload.last.eq(closes),
            out.payload.last_be.eq(closes),
            out.payload.error.eq(~right),
        ]
        m.d.comb += [
            out.payload.length.eq(length),
            out.payload.ip_address.eq(header.source),
            out.payload.src_port.eq(ports[16:]),
            out.payload.dst_port.eq(ports[:16]),
        ]
        with m.If(comes & (header.index < 4)):
            m.d.sync += ports.eq(Cat(came.payload.data, ports))
        with m.If(closes):
            m.d.sync += [out.valid.eq(has_byte), has_byte.eq(0)]
        with m.Elif(comes & (header.index >= HEADER_BYTES) & check.port):
            m.d.sync += [out.valid.eq(has_byte), byte.eq(came.payload.data), has_byte.eq(1)]
        return m


class DatagramReader(wiring.Component):
    """Read datagrams from stores, in turn.

    A byte per cycle. The first byte is valid 16 cycles after a store is `full`. `ready` reaches the
    memories' enables combinationally.

    Parameters
    ----------
    stores : int
        Number of stores.

    Members
    -------
    stores : In(StoreSignature()), as an array
    datagrams : Out(DatagramSignature(1))
        Without `error`: what was damaged is not stored. `last_be` is that of `last`.
    """

    def __init__(self, stores: int):
        self.count = stores
        super().__init__(
            {
                "stores": In(StoreSignature()).array(stores),
                "datagrams": Out(DatagramSignature(1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        out = self.datagrams
        head_bytes = _SOURCE_BYTES + HEADER_BYTES
        source = Signal(range(max(2, self.count)))
        moves, takes, release = Signal(), Signal(), Signal()
        byte = Signal(8)
        stores: Sequence[wiring.PureInterface] = self.stores
        for number, store in enumerate(stores):
            chosen = source == number
            m.d.comb += [
                store.moves.eq(moves),
                store.takes.eq(takes & chosen),
                store.release.eq(release & chosen),
            ]
        m.d.comb += byte.eq(Array(store.byte for store in stores)[source])
        # Steps of reading: whether there is a byte, and whether it is the last one. A byte that is
        # taken is two steps behind: in the store's register, then on `byte`.
        there, last = Signal(2), Signal(2)
        left = Signal(16)
        # Addresses, ports, and lengths, in the order of the bytes, the first one highest.
        head = Signal(8 * (head_bytes - 2))
        length = Signal(16)
        m.d.comb += [
            out.payload.data.eq(byte),
            out.payload.last.eq(last[1]),
            out.payload.last_be.eq(last[1]),
            out.payload.length.eq(length),
            out.payload.dst_port.eq(head[16:32]),
            out.payload.src_port.eq(head[32:48]),
            out.payload.ip_address.eq(head[48:]),
        ]
        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += [left.eq(head_bytes), there.eq(0), last.eq(0)]
                for number, store in reversed(list(enumerate(stores))):
                    with m.If(store.full):
                        m.d.sync += source.eq(number)
                        m.next = "HEAD"
            with m.State("HEAD"):
                m.d.comb += [moves.eq(1), takes.eq(left != 0)]
                m.d.sync += [there.eq(Cat(takes, there[0])), left.eq(left - takes)]
                with m.If(there[1] & takes):
                    m.d.sync += head.eq(Cat(byte, head))
                with m.If(~takes):
                    # The checksum, which comes last, is not needed.
                    rest = head[:16] - HEADER_BYTES
                    m.d.sync += [left.eq(rest), length.eq(rest), there.eq(0)]
                    m.next = "BODY"
            with m.State("BODY"):
                m.d.comb += [
                    out.valid.eq(there[1]),
                    moves.eq(~there[1] | out.ready),
                    takes.eq(moves & (left != 0)),
                ]
                with m.If(moves):
                    m.d.sync += [
                        there.eq(Cat(left != 0, there[0])),
                        last.eq(Cat(left == 1, last[0])),
                    ]
                with m.If(takes):
                    m.d.sync += left.eq(left - 1)
                with m.If(there[1] & last[1] & out.ready):
                    m.d.comb += release.eq(1)
                    m.next = "RELEASE"
            with m.State("RELEASE"):
                m.next = "IDLE"
        return m


_ABOUT = ("ip_address", "src_port", "dst_port")


def join_words(m: Module, source: Any, target: Any) -> None:
    """Join the bytes of datagrams to words; all else is the same during a datagram."""
    came, out = source.payload, target.payload
    number, kept = Signal(range(WORD_BYTES)), Signal(8 * (WORD_BYTES - 1))
    completes = Signal()
    m.d.comb += [
        *(out[name].eq(came[name]) for name in ("last", "error", "length", *_ABOUT)),
        out.data.eq(kept | came.data << (number << 3)),
        out.last_be.eq(came.last << number),
        completes.eq(came.last | (number == WORD_BYTES - 1)),
        target.valid.eq(source.valid & completes),
        source.ready.eq(target.ready | ~completes),
    ]
    with m.If(source.valid & source.ready):
        m.d.sync += [number.eq(number + 1), kept.eq(out.data)]
        with m.If(completes):
            m.d.sync += [number.eq(0), kept.eq(0)]


class UdpTransmitter(wiring.Component):
    """Take datagrams to send, and sum them up.

    A word per cycle; the header is written and summed beside the payload, a byte per cycle. It has
    12 bytes, so the last word of a short datagram waits. The datagram is in its slot 8 cycles after
    its last word. Its frame may begin before that, if few bytes are missing.

    A datagram is dropped if it has more than 1472 bytes, or another number of bytes than `length`.
    If its frame has begun before, the frame is not right.

    Parameters
    ----------
    address : int
        The node's address.
    ahead_bytes : int
        So many bytes may be missing when the frame begins. If there are any, datagrams must not
        pause.

    Members
    -------
    datagrams : In(DatagramSignature(WORD_BYTES))
        `error` does not count.
    slot : Out(SlotWriterSignature(WORD_BYTES))
        Bytes 6 to 9 of the header are the destination, 10 and 11 the length of IPv4, 16 to 23 the
        header of UDP.
    unfit : Out(1)
        Strobe: a datagram was dropped.
    """

    def __init__(self, address: int, ahead_bytes: int = 0):
        self.address, self.ahead_bytes = address, ahead_bytes
        super().__init__(
            {
                "datagrams": In(DatagramSignature(WORD_BYTES)),
                "slot": Out(SlotWriterSignature(WORD_BYTES)),
                "unfit": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, slot = self.datagrams, self.slot
        length, total_length = Signal(16), Signal(16)
        # Bytes of the header in the order in which they are summed, with their places. Halves of
        # words take turns, the lower one first. What the sender reads first comes first. The length
        # of IPv4 stands for UDP's length in the pseudo header; the constant makes up for the
        # difference.
        destination, source_port = came.payload.ip_address, came.payload.src_port
        fields = [
            (6, destination[16:]),
            (8, destination[:16]),
            (10, total_length),
            (16, source_port),
            (18, came.payload.dst_port),
            (20, length),
        ]
        halves = [
            (place + 1 - half, field[8 * half :][:8]) for place, field in fields for half in (0, 1)
        ]
        own = (self.address >> 16) + (self.address & 0xFFFF) + UDP + 0xFFFF - 20
        # The number of words that came, and of bytes that are missing with this one.
        count, rest = Signal(range(MOST_PAYLOAD // WORD_BYTES + 1)), Signal(16)
        step = Signal(range(len(halves) + 1))
        # The sums of the payload, which is a word behind, and of the header.
        payload, word, has_word = Signal(33), Signal(32), Signal()
        total, header_word = Signal(17), Signal(16)
        header_moves, header_done, moves = Signal(), Signal(), Signal()
        taking = Signal()  # The state is TAKE.
        long, ended, begun, commits = Signal(), Signal(), Signal(), Signal()
        checksum, from_header, following = Signal(16), Signal(8), Signal(8)
        # A register has the byte of the header that comes next.
        with m.Switch(step):
            for number, (place, _) in enumerate(halves):
                with m.Case(number):
                    m.d.comb += slot.header_at.eq(place)
                    m.d.comb += following.eq(halves[(number + 1) % len(halves)][1])
        # Behind the last byte, a word counts as 0.
        ends = [
            came.payload.last & (came.payload.last_be[:place].any()) for place in range(WORD_BYTES)
        ]
        data = [Mux(end, 0, came.payload.data.word_select(n, 8)) for n, end in enumerate(ends)]
        m.d.comb += [
            slot.payload_at.eq(Cat(Const(0, 2), count)),
            slot.payload_word.eq(came.payload.data),
            slot.payload_write.eq(moves),
            slot.header_byte.eq(from_header),
            slot.kind.eq(DATAGRAM),
            # The last word waits until the header, which comes with it, has been read.
            came.ready.eq(taking & (~came.payload.last | header_done)),
            moves.eq(came.valid & came.ready),
            header_moves.eq(taking & came.valid & ~header_done),
        ]
        m.d.sync += [
            self.unfit.eq(0),
            header_word.eq(0),
            total.eq(add_word(total, header_word)),
            has_word.eq(moves),
        ]
        with m.If(has_word):
            m.d.sync += payload.eq((Cat(Const(1, 1), payload[:32]) + Cat(payload[32], word))[1:34])
        with m.If(came.valid):
            m.d.sync += [
                length.eq(came.payload.length + HEADER_BYTES),
                total_length.eq(came.payload.length + 28),
            ]
        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += [count.eq(0), step.eq(0), total.eq(own % 0xFFFF), payload.eq(0)]
                m.d.sync += [from_header.eq(halves[0][1]), header_done.eq(0), begun.eq(0)]
                m.d.sync += [long.eq(0), rest.eq(came.payload.length)]
                with m.If(came.valid & slot.free):
                    m.d.sync += taking.eq(1)
                    m.next = "TAKE"
            with m.State("TAKE"):
                m.d.comb += slot.header_write.eq(header_moves)
                with m.If(header_moves):
                    m.d.sync += [
                        header_word.eq(Mux(step[0], Cat(Const(0, 8), from_header), from_header)),
                        step.eq(step + 1),
                        from_header.eq(following),
                        header_done.eq(step == len(halves) - 1),
                    ]
                if self.ahead_bytes:
                    begins = ~begun & ~long & (step >= 6) & (rest <= self.ahead_bytes)
                    m.d.comb += slot.begins.eq(begins)
                    m.d.sync += begun.eq(begun | begins)
                with m.If(moves):
                    m.d.sync += [
                        word.eq(Cat(reversed(data))),
                        count.eq(count + ~long),
                        rest.eq(rest - WORD_BYTES),
                        long.eq(long | (count == MOST_PAYLOAD // WORD_BYTES)),
                    ]
                    with m.If(came.payload.last):
                        m.d.sync += taking.eq(0)
                        m.next = "CARRY"
                        # `rest` bytes are missing with this word, so byte `rest` - 1 is its last
                        # one.
                        fits = came.payload.last_be.bit_select((rest + 3)[:2], 1) & (rest <= 4)
                        m.d.sync += ended.eq(fits & (rest != 0))
            with m.State("CARRY"):
                m.next = "LOW"
            for state, part, following_state in (
                ("LOW", payload[:16], "HIGH"),
                ("HIGH", payload[16:32], "TOP"),
                ("TOP", payload[32], "FOLD"),
            ):
                with m.State(state):
                    m.d.sync += total.eq(add_word(total, Cat(part, Const(0, 16))[:16]))
                    m.next = following_state
            # A checksum of 0 is sent as 0xFFFF (RFC 768). The last word was 0 or 1; so if a carry
            # is left, the sum is at most 1, and adding the carry does not carry again.
            with m.State("FOLD"):
                folded = total[:16] + total[16]
                m.d.sync += checksum.eq(Mux(folded[:16].all(), 0xFFFF, ~folded[:16]))
                m.next = "UPPER"
            with m.State("UPPER"):
                m.d.comb += [
                    slot.header_write.eq(1),
                    slot.header_at.eq(22),
                    slot.header_byte.eq(checksum[8:]),
                ]
                m.next = "LOWER"
            with m.State("LOWER"):
                m.d.comb += [
                    commits.eq(ended & ~long),
                    slot.header_write.eq(1),
                    slot.header_at.eq(23),
                    slot.header_byte.eq(checksum[:8]),
                    slot.commit.eq(commits | begun),
                ]
                m.d.sync += self.unfit.eq(~commits)
                m.next = "IDLE"
        return m
