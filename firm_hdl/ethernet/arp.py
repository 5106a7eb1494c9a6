"""Address resolution (RFC 826): requests for the node, and a table of others that ages."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import data, memory, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.header import IPV4
from firm_hdl.ethernet.slots import ARP_REPLY, SlotWriterSignature
from firm_hdl.ethernet.streams import FrameSignature, compare

__all__ = ["ArpCache", "ArpReceiver", "peer_layout"]

_BYTES = 28
_REQUEST = 1


def peer_layout() -> data.StructLayout:
    """Return the addresses of another machine: `ip`, 32 bits, and `mac`, 48 bits."""
    return data.StructLayout({"ip": 32, "mac": 48})


class ArpReceiver(wiring.Component):
    """Read ARP messages of IPv4 over Ethernet: learn from all, and answer requests for the node.

    As the algorithm of RFC 826 has it, a sender that is known is updated by any message, and an
    unknown one becomes known if the message is for the node. An address that no machine can have
    is not learned: 0.0.0.0 of a probe (RFC 5227), and the node's own. A sender whose address in
    hardware is a group's gets no answer either.

    The reply is handed over with the last byte of a good frame; if no slot is free, there is none.

    Parameters
    ----------
    mac, address : int
        The node's addresses, 48 and 32 bits.

    Members
    -------
    payloads : In(FrameSignature())
    reply : Out(SlotWriterSignature())
        Hardware and protocol address of the sender, as bytes 0 to 9 of the header.
    peer : Out(peer_layout())
        The sender.
    learns, inserts : Out(1)
        Strobes: `peer` is to be updated, and to be entered if it is unknown.
    other, full : Out(1)
        Strobes: a message was of no use; a request found no free slot.
    """

    def __init__(self, mac: int, address: int):
        self.mac, self.address = mac, address
        super().__init__(
            {
                "payloads": In(FrameSignature()),
                "reply": Out(SlotWriterSignature()),
                "peer": Out(peer_layout()),
                "learns": Out(1),
                "inserts": Out(1),
                "other": Out(1),
                "full": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, byte = self.payloads, self.payloads.payload.data
        place = Signal(range(_BYTES + 1))
        known, request, operation = Signal(), Signal(), Signal()
        for_node, own, group = Signal(), Signal(), Signal()
        valid, answers, room = Signal(), Signal(), Signal()
        m.d.comb += [
            valid.eq(came.payload.good & (place == _BYTES) & known & operation & ~group),
            answers.eq(valid & for_node & request & ~own),
            self.reply.kind.eq(ARP_REPLY),
            # The addresses of the sender are bytes 8 to 17.
            self.reply.header_at.eq(Cat(place[:3], place[4])),
            self.reply.header_byte.eq(byte),
        ]
        # `peer` is a shift register. It stays for 34 cycles behind a frame: 12 in which none comes,
        # 14 bytes of Ethernet, and 8 of the next message. The cache needs it for 21.
        m.d.sync += [self.learns.eq(0), self.inserts.eq(0), self.other.eq(0), self.full.eq(0)]
        with m.If(came.valid & came.payload.end):
            m.d.sync += place.eq(0)
            learns = valid & ~own & self.peer.ip.any()
            m.d.sync += [
                self.learns.eq(learns),
                self.inserts.eq(learns & for_node),
                self.other.eq(came.payload.good & ~(valid & for_node)),
                self.full.eq(answers & ~room),
            ]
            m.d.comb += self.reply.commit.eq(answers & room)
        with m.Elif(came.valid):
            m.d.sync += place.eq(Mux(place == _BYTES, _BYTES, place + 1))
            # Ethernet, IPv4, sizes of their addresses.
            compare(m, known, byte, place, 0, (1 << 32 | IPV4 << 16 | 6 << 8 | 4), 6)
            compare(m, for_node, byte, place, 24, self.address, 4)
            compare(m, own, byte, place, 14, self.address, 4)
            with m.Switch(place):
                with m.Case(6):
                    m.d.sync += operation.eq(byte == 0)
                with m.Case(7):
                    m.d.sync += [request.eq(byte == _REQUEST), room.eq(self.reply.free)]
                    m.d.sync += operation.eq(operation & ((byte == _REQUEST) | (byte == 2)))
                with m.Case(8):
                    m.d.sync += group.eq(byte[0])
            with m.If((place >= 8) & (place < 14)):
                m.d.comb += self.reply.header_write.eq(1)
                m.d.sync += self.peer.mac.eq(Cat(byte, self.peer.mac))
            with m.If((place >= 14) & (place < 18)):
                m.d.comb += self.reply.header_write.eq(1)
                m.d.sync += self.peer.ip.eq(Cat(byte, self.peer.ip))
        return m


_LIVES, _REFRESH, _ABSENT = 60, 20, 2
"""Lives of an entry: when it was learned, from where on it is stale, and of an absent machine."""


class ArpCache(wiring.Component):
    """A table of machines on the network, which forgets those that are silent.

    Entries lie in distributed RAM and are looked at one a cycle. An entry has a number of lives: 60
    when it was learned, one less with each `tick`, none if it is free. An entry with few lives is
    found, but `stale`: its machine should be asked, so that a machine in use is not forgotten.

    A machine that does not answer is entered as absent for 2 ticks, so that it is not asked again
    with each datagram (RFC 1122, 2.3.2.1).

    A lookup takes 4 to ``entries + 4`` cycles, and up to ``entries + 5`` more if another action is
    under way.

    Parameters
    ----------
    entries : int
        A power of two.

    Members
    -------
    peer : In(peer_layout())
    learns, inserts : In(1)
        Strobes: update an entry; enter it if there is none, in place of the next one in turn.
        `peer` has to stay for ``entries + 5`` cycles.
    tick : In(1)
        Strobe: all entries lose a life.
    ip : In(32)
        The address to look for.
    look, absent : In(1)
        Look for `ip`; enter `ip` as absent. One of them is held until `done`, with `ip`.
    done : Out(1)
        Strobe; with `look`, the outputs are those of the lookup.
    found, gone, stale : Out(1)
        There is an entry; it is one of an absent machine; the machine should be asked.
    mac : Out(48)
    """

    def __init__(self, entries: int = 16):
        self.entries = entries
        super().__init__(
            {
                "peer": In(peer_layout()),
                "learns": In(1),
                "inserts": In(1),
                "tick": In(1),
                "ip": In(32),
                "look": In(1),
                "absent": In(1),
                "done": Out(1),
                "found": Out(1),
                "gone": Out(1),
                "stale": Out(1),
                "mac": Out(48),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        count = self.entries
        shape = data.StructLayout({"lives": range(_LIVES + 1), "gone": 1, "ip": 32, "mac": 48})
        m.submodules.table = table = memory.Memory(shape=shape, depth=count, init=[])
        write, read = table.write_port(), table.read_port(domain="comb")
        learn_waits, enters, ages = Signal(), Signal(), Signal()
        number = Signal(range(count + 2))
        # What is to be entered; an absent machine has no address in hardware.
        new = Signal(shape)
        always = Signal()
        # A step behind `number`, and two steps behind.
        #
        #   number            | 0 | 1    | 2    | 3
        #   entry             |   | of 0 | of 1 | of 2
        #   same, same_entry  |   |      | of 0 | of 1
        #
        # So the entry that is found is `number` - 2, and before 2, `same` is of an earlier action.
        entry = Signal(shape)
        same, same_entry = Signal(), Signal(shape)
        victim, place = Signal(range(count)), Signal(range(count))
        hit, over = Signal(), Signal()
        m.d.comb += [
            read.addr.eq(number),
            hit.eq(same & (number >= 2)),
            over.eq(number == count + 1),
            write.addr.eq(place),
            write.data.eq(new),
        ]
        m.d.sync += [
            entry.eq(read.data),
            same.eq((entry.lives != 0) & (entry.ip == new.ip)),
            same_entry.eq(entry),
            self.done.eq(0),
        ]
        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += [number.eq(0), new.ip.eq(Mux(learn_waits, self.peer.ip, self.ip))]
                with m.If(learn_waits):
                    m.d.sync += [learn_waits.eq(0), always.eq(enters)]
                    m.d.sync += [new.mac.eq(self.peer.mac), new.gone.eq(0), new.lives.eq(_LIVES)]
                    m.next = "ENTER"
                with m.Elif(ages):
                    m.d.sync += ages.eq(0)
                    m.next = "AGE"
                with m.Elif(self.look & ~self.done):
                    m.next = "LOOK"
                with m.Elif(self.absent & ~self.done):
                    m.d.sync += [always.eq(1), new.gone.eq(1), new.lives.eq(_ABSENT)]
                    m.next = "ENTER"
            with m.State("LOOK"):
                m.d.sync += number.eq(number + 1)
                with m.If(hit | over):
                    m.d.sync += [
                        self.done.eq(1),
                        self.found.eq(hit),
                        self.gone.eq(same_entry.gone),
                        self.stale.eq(same_entry.lives <= _REFRESH),
                        self.mac.eq(same_entry.mac),
                    ]
                    m.next = "IDLE"
            with m.State("ENTER"):
                m.d.sync += number.eq(number + 1)
                with m.If(hit | over):
                    m.d.sync += place.eq(Mux(hit, number - 2, victim))
                    m.next = "IDLE"
                    with m.If(hit | always):
                        m.d.sync += victim.eq(victim + ~hit)
                        m.next = "WRITE"
            with m.State("WRITE"):
                m.d.comb += write.en.eq(1)
                m.d.sync += self.done.eq(new.gone)
                m.next = "IDLE"
            with m.State("AGE"):
                m.d.comb += [
                    write.addr.eq(number),
                    write.data.eq(read.data),
                    write.data.lives.eq(Mux(read.data.lives == 0, 0, read.data.lives - 1)),
                    write.en.eq(1),
                ]
                m.d.sync += number.eq(number + 1)
                with m.If(number == count - 1):
                    m.next = "IDLE"
        with m.If(self.tick):
            m.d.sync += ages.eq(1)
        with m.If(self.learns):
            m.d.sync += [learn_waits.eq(1), enters.eq(self.inserts)]
        return m
