"""What the node sends: frames made of templates, and of what waits in slots."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.header import ARP, BROADCAST, IPV4
from firm_hdl.ethernet.ipv4 import ICMP, IGMP, UDP
from firm_hdl.ethernet.slots import ARP_REPLY, ECHO, SlotReaderSignature
from firm_hdl.ethernet.streams import SendSignature, add_word

__all__ = ["FrameSender"]

# Bytes of templates that are not constant, beside those of a slot's header, which have the numbers
# 0 to 31: bytes of the destination's address in hardware, of the address that is asked for, and of
# the checksum of IPv4.
_MAC, _ASKED, _SUM_UPPER, _SUM_LOWER = 32, 33, 34, 35
_FIELD = 256
"""A byte of a template that is a field; its number is in the bits below."""

_DO_NOT_CUT = 0x4000
_TTL = 64


def _sum(*words: int) -> int:
    """Sum words up in one's complement."""
    total = sum(words)
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return total


class _Templates:
    """The bytes of all frames up to the payload, one frame after another."""

    def __init__(self, mac: int, address: int, groups: tuple[int, ...]) -> None:
        self.words: list[int] = []  # Bytes and fields of all templates.
        # Place and size of each.
        self.first: dict[str, int] = {}
        self.size: dict[str, int] = {}
        own = [*mac.to_bytes(6, "big")]
        ip = [*address.to_bytes(4, "big")]

        def field(number: int, count: int = 1) -> list[int]:
            return [_FIELD | number + k for k in range(count)]

        # Ethernet, IPv4, and sizes of their addresses (RFC 826).
        arp = [*ARP.to_bytes(2, "big"), 0, 1, *IPV4.to_bytes(2, "big"), 6, 4, 0]
        everybody = [*BROADCAST.to_bytes(6, "big")]
        self._add("ask", everybody + own + [*arp, 1] + own + ip + everybody + 4 * field(_ASKED))
        self._add(
            "answer",
            [*field(0, 6), *own, *arp, 2, *own, *ip, *field(0, 6), *field(6, 4)],
        )
        start = 6 * field(_MAC) + own + [*IPV4.to_bytes(2, "big"), 0x45, 0]
        checksum = [*field(_SUM_UPPER), *field(_SUM_LOWER)]
        rest = [*checksum, *ip, *field(6, 4)]
        echo = [*start, *field(10, 6), _TTL, ICMP, *rest]
        # An echo reply has type 0 and code 0.
        self._add("echo", [*echo, 0, 0, *field(0, 2)])
        self._add("echo rest", echo)
        # Without an identification: what is never cut needs none (RFC 6864).
        udp = [*start, *field(10, 2), 0, 0, *_DO_NOT_CUT.to_bytes(2, "big"), _TTL, UDP, *rest]
        self._add("datagram", [*udp, *field(16, 8)])
        for number, group in enumerate(groups):
            self._add(f"report {number}", self._report(own, address, group))

    def _add(self, name: str, words: list[int]) -> None:
        self.first[name], self.size[name] = len(self.words), len(words)
        self.words += words

    @staticmethod
    def _report(own: list[int], address: int, group: int) -> list[int]:
        """A report of IGMP version 2, with the option Router Alert (RFC 2236, RFC 2113)."""
        alert = 0x94040000
        # 24 bytes of header, 8 of IGMP; a report does not leave the network.
        words = [0x4600, 32, 0, _DO_NOT_CUT, 1 << 8 | IGMP]
        rest = [v >> shift & 0xFFFF for v in (address, group, alert) for shift in (16, 0)]
        igmp = [0x1600, group >> 16, group & 0xFFFF]
        words += [0xFFFF ^ _sum(*words, *rest), *rest]
        words += [igmp[0], 0xFFFF ^ _sum(*igmp), *igmp[1:]]
        to = (0x01005E << 24 | group & 0x7FFFFF).to_bytes(6, "big")
        return [*to, *own, *b"".join(w.to_bytes(2, "big") for w in [IPV4, *words])]


class FrameSender(wiring.Component):
    """Send what waits: replies, datagrams, requests of ARP, reports of IGMP.

    Headers come from a memory of templates, whose fields are bytes of a slot. The destination's
    address in hardware comes from the cache; beyond the network, that of the gateway. Replies and
    datagrams take turns.

    A datagram whose destination is not known waits, and ARP asks; if no answer comes within `wait`
    cycles, the datagram is dropped, and the destination counts as absent. An echo reply does not
    wait.

    From a datagram in its slot to its first byte on `frames`: 18 cycles, and those of the lookup.

    Parameters
    ----------
    mac, address, prefix_bits, gateway : int
        The node's addresses, bits of the address that are those of the network, and the gateway's
        address, or 0.
    groups : tuple of int
    wait : int
        Cycles.

    Members
    -------
    replies, datagrams : Out(SlotReaderSignature())
    report, group : In(1), In(range(len(groups)))
        A report is to be sent, and of which group.
    reported : Out(1)
        Strobe: it is on its way.
    tick : In(1)
        Strobe: a machine whose entry is stale may be asked again.
    ip, look, absent : Out(32), Out(1), Out(1)
    done, found, gone, stale, mac : In(1), In(1), In(1), In(1), In(48)
        As those of an :class:`firm_hdl.ethernet.arp.ArpCache`.
    learned : In(1)
        Strobe: the cache has changed.
    frames : Out(SendSignature())
    unresolved : Out(1)
        Strobe: a frame was dropped, because its destination does not answer.
    """

    def __init__(
        self,
        mac: int,
        address: int,
        prefix_bits: int,
        gateway: int,
        groups: tuple[int, ...],
        wait: int,
    ):
        self.own_mac, self.address, self.prefix_bits = mac, address, prefix_bits
        self.gateway, self.groups, self.wait = gateway, groups, wait
        super().__init__(
            {
                "replies": Out(SlotReaderSignature()),
                "datagrams": Out(SlotReaderSignature()),
                "report": In(1),
                "group": In(range(max(1, len(groups)))),
                "reported": Out(1),
                "tick": In(1),
                "ip": Out(32),
                "look": Out(1),
                "absent": Out(1),
                "done": In(1),
                "found": In(1),
                "gone": In(1),
                "stale": In(1),
                "mac": In(48),
                "learned": In(1),
                "frames": Out(SendSignature()),
                "unresolved": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        templates = _Templates(self.own_mac, self.address, self.groups)
        m.submodules.templates = rom = memory.Memory(
            shape=9, depth=len(templates.words), init=templates.words
        )
        word = rom.read_port()
        out = self.frames

        # What is sent: of replies or of datagrams, and from which template.
        is_reply = Signal()
        turn = Signal()
        slots = (self.datagrams, self.replies)
        header_at = Signal(5)
        header_byte, payload_byte, kind = Signal(8), Signal(8), Signal(2)
        payload_at, moves, release = Signal(11), Signal(), Signal()
        for slot, chosen in zip(slots, (~is_reply, is_reply), strict=True):
            m.d.comb += [
                slot.header_at.eq(header_at),
                slot.payload_at.eq(payload_at),
                slot.payload_moves.eq(moves),
                slot.release.eq(release & chosen),
            ]
        m.d.comb += [
            header_byte.eq(Mux(is_reply, self.replies.header_byte, self.datagrams.header_byte)),
            payload_byte.eq(Mux(is_reply, self.replies.payload_byte, self.datagrams.payload_byte)),
        ]
        m.d.sync += kind.eq(self.replies.kind)

        at, left_of_template = Signal(range(len(templates.words))), Signal(6)
        left, has_payload, active = Signal(11), Signal(), Signal()
        # The frame takes its slot with it; a request of ARP follows.
        releases, asks_after = Signal(), Signal()

        first, size = Signal.like(at), Signal.like(left_of_template)

        def begin(name: str) -> None:
            m.d.comb += [first.eq(templates.first[name]), size.eq(templates.size[name])]
            m.d.sync += active.eq(1)
            m.next = "SEND"

        hardware, key = Signal(48), Signal(32)
        index = Signal(4)
        total, checksum = Signal(17), Signal(16)
        length = Signal(11)
        # A datagram whose destination was asked for waits for an answer, until the time is over.
        asked, retries, timer = Signal(), Signal(), Signal(range(self.wait + 1))
        # What may be asked for often, by echo requests of a stranger, is asked for once a tick.
        may_ask = Signal(init=1)
        ip = (self.address >> 16, self.address & 0xFFFF)
        udp_start = _sum(0x4500, _DO_NOT_CUT, _TTL << 8 | UDP, *ip)
        icmp_start = _sum(0x4500, _TTL << 8 | ICMP, *ip)
        host_bits = 32 - self.prefix_bits
        m.d.comb += self.ip.eq(key)
        m.d.sync += self.unresolved.eq(0)
        with m.If(timer != 0):
            m.d.sync += timer.eq(timer - 1)
        with m.If(self.learned | (timer == 1)):
            m.d.sync += retries.eq(1)
        with m.If(self.tick):
            m.d.sync += may_ask.eq(1)

        # The steps of a byte: its place; what the memories have there; that in registers, because
        # memories are slow; a field's byte of the header, likewise; the byte that it stands for.
        there, from_payload, last = Signal(3), Signal(3), Signal(3)
        looked_up, template_word, from_header = Signal(9), Signal(9), Signal(8)
        # The byte is one of `hardware`, or of `key`, which rotate.
        of_hardware, of_key = Signal(), Signal()
        stored = Signal(8)
        this_last, in_template = Signal(), Signal()
        goes = Signal()
        m.d.comb += [
            goes.eq(~out.valid | out.ready),
            in_template.eq(left_of_template != 0),
            this_last.eq(Mux(in_template, (left_of_template == 1) & ~has_payload, left == 1)),
            moves.eq(goes),
            word.addr.eq(at),
            word.en.eq(goes),
        ]
        value = Signal(8)
        m.d.comb += value.eq(template_word[:8])
        with m.If(of_hardware):
            m.d.comb += value.eq(hardware[40:])
        with m.Elif(of_key):
            m.d.comb += value.eq(key[24:])
        with m.Elif(template_word == (_FIELD | _SUM_UPPER)):
            m.d.comb += value.eq(checksum[8:])
        with m.Elif(template_word == (_FIELD | _SUM_LOWER)):
            m.d.comb += value.eq(checksum[:8])
        with m.Elif(template_word[8]):
            m.d.comb += value.eq(from_header)
        in_place = there[1] & ~from_payload[1]
        with m.If(goes):
            m.d.sync += [
                there.eq(Cat(active, there)),
                from_payload.eq(Cat(~in_template, from_payload)),
                last.eq(Cat(this_last, last)),
                looked_up.eq(word.data),
                template_word.eq(looked_up),
                of_hardware.eq(in_place & (looked_up == (_FIELD | _MAC))),
                of_key.eq(in_place & (looked_up == (_FIELD | _ASKED))),
                from_header.eq(header_byte),
                stored.eq(payload_byte),
                out.valid.eq(there[2]),
                out.payload.data.eq(Mux(from_payload[2], stored, value)),
                out.payload.last.eq(last[2]),
            ]
            with m.If(of_hardware):
                m.d.sync += hardware.eq(hardware.rotate_left(8))
            with m.If(of_key):
                m.d.sync += key.eq(key.rotate_left(8))
        with m.If(~active):
            m.d.sync += [at.eq(first), left_of_template.eq(size)]
        with m.Elif(goes):
            m.d.sync += active.eq(~this_last)
            with m.If(in_template):
                m.d.sync += [at.eq(at + 1), left_of_template.eq(left_of_template - 1)]
            with m.Else():
                m.d.sync += [payload_at.eq(payload_at + 1), left.eq(left - 1)]

        # The bytes of the header that vary are 6 to 11, and of an echo to 15. They are summed up a
        # cycle after they were read, in the state HEADER, for which `in_header` stands: a register
        # is nearer to the memory.
        in_header, adds, place, byte = Signal(), Signal(), Signal(4), Signal(8)
        m.d.comb += header_at.eq(Mux(in_header, index, looked_up[:5]))
        m.d.sync += [adds.eq(in_header), place.eq(index), byte.eq(header_byte)]
        with m.If(adds):
            m.d.sync += total.eq(add_word(total, Mux(place[0], byte, Cat(Const(0, 8), byte))))
            with m.If(place < 10):
                m.d.sync += key.eq(Cat(byte, key))
            with m.Elif(place < 12):
                m.d.sync += length.eq(Cat(byte, length))
        with m.Elif(in_header):
            m.d.sync += total.eq(Mux(is_reply, icmp_start, udp_start))

        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += [index.eq(6), has_payload.eq(0), payload_at.eq(0)]
                m.d.sync += [asks_after.eq(0), releases.eq(1)]
                datagram = self.datagrams.full & (~asked | retries)
                with m.If(self.replies.full & ~(turn & datagram)):
                    m.d.sync += [is_reply.eq(1), turn.eq(1)]
                    m.next = "REPLY"
                with m.Elif(datagram):
                    m.d.sync += [is_reply.eq(0), turn.eq(0), in_header.eq(1)]
                    m.next = "HEADER"
                with m.Elif(self.report):
                    m.next = "REPORT"
            with m.State("REPORT"):
                m.d.comb += self.reported.eq(1)
                m.d.sync += releases.eq(0)
                for number in range(len(self.groups)):
                    with m.If(self.group == number):
                        begin(f"report {number}")
            with m.State("REPLY"):
                with m.If(kind == ARP_REPLY):
                    begin("answer")
                with m.Else():
                    m.d.sync += in_header.eq(1)
                    m.next = "HEADER"
            with m.State("HEADER"):
                m.d.sync += index.eq(index + 1)
                with m.If(index == Mux(is_reply, 15, 11)):
                    m.d.sync += in_header.eq(0)
                    m.next = "LAST BYTE"
            with m.State("LAST BYTE"):
                m.next = "HOP"
            with m.State("HOP"):
                # After that, a carry means that the rest is 0. So adding it in `START` carries no
                # more.
                m.d.sync += total.eq(add_word(total, Const(0, 16)))
                # Without what templates have of it: the header of IPv4, of UDP, and of an echo the
                # type, the code and the checksum.
                m.d.sync += left.eq(length - Mux(is_reply, Mux(kind == ECHO, 24, 20), 28))
                # The address of a group in hardware (RFC 1112, 6.4): 23 bits of it are the group's.
                m.d.sync += hardware.eq(Cat(key[:23], Const(0x01005E << 1, 25)))
                m.d.sync += self.look.eq(1)
                m.next = "LOOK"
                with m.If(key[28:] == 0b1110):
                    m.d.sync += self.look.eq(0)
                    m.next = "START"
                with m.Elif(key[host_bits:] != self.address >> host_bits):
                    if self.gateway:
                        m.d.sync += key.eq(self.gateway)
                    else:
                        m.d.sync += self.look.eq(0)
                        m.next = "DROP"
            with m.State("LOOK"), m.If(self.done):
                m.d.sync += [
                    self.look.eq(0),
                    hardware.eq(self.mac),
                    asks_after.eq(self.found & self.stale & may_ask),
                ]
                m.next = "START"
                with m.If(~self.found):
                    m.next = "ASK"
                    with m.If(is_reply & ~may_ask):
                        m.next = "DROP"
                    with m.Elif(asked & ~is_reply):
                        m.next = "RETRY"
                with m.Elif(self.gone):
                    m.next = "DROP"
            with m.State("RETRY"):
                m.next = "ABSENT"
                with m.If(timer != 0):
                    m.d.sync += retries.eq(0)
                    m.next = "IDLE"
            with m.State("ABSENT"):
                m.d.comb += self.absent.eq(1)
                with m.If(self.done):
                    m.next = "DROP"
            with m.State("DROP"):
                m.d.comb += release.eq(1)
                m.d.sync += self.unresolved.eq(1)
                with m.If(~is_reply):
                    m.d.sync += asked.eq(0)
                m.next = "IDLE"
            with m.State("ASK"):
                begin("ask")
                m.d.sync += [releases.eq(0), may_ask.eq(0)]
                with m.If(is_reply):
                    m.d.comb += release.eq(1)
                    m.d.sync += self.unresolved.eq(1)
                with m.Else():
                    m.d.sync += [asked.eq(1), retries.eq(0), timer.eq(self.wait)]
            with m.State("START"):
                m.d.sync += [
                    checksum.eq(~(total[:16] + total[16])),
                    has_payload.eq(left != 0),
                ]
                with m.If(~is_reply):
                    m.d.sync += asked.eq(0)
                    begin("datagram")
                with m.Elif(kind == ECHO):
                    begin("echo")
                with m.Else():
                    begin("echo rest")
            with m.State("SEND"), m.If(out.valid & out.ready & out.payload.last):
                m.d.comb += release.eq(releases)
                m.next = "IDLE"
                with m.If(asks_after):
                    m.next = "ASK AGAIN"
            with m.State("ASK AGAIN"):
                begin("ask")
                m.d.sync += [releases.eq(0), may_ask.eq(0), asks_after.eq(0), has_payload.eq(0)]
        return m
