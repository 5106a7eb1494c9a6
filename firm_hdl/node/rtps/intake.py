"""From messages of publications and services to the histories of their writers."""

from __future__ import annotations

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware import PacketWidth
from firm_hdl.gateware.memories import BlockMemory, LutMemory
from firm_hdl.node.gateware.streams import LinkSignature
from firm_hdl.node.rtps.history import MOST_SAMPLES, Part, bytes_of

__all__ = ["HistoriesSignature", "Intake", "sample_layout", "writer_layout"]


def writer_layout(address_bits: int) -> data.StructLayout:
    """Return the state of one of our writers of topics.

    Members
    -------
    last, gone : unsigned(32)
        The newest number, and the newest of those that the history no longer has.
    at, used : unsigned(address_bits), unsigned(address_bits + 1)
        Place of the next message in the writer's memory, and bytes in use; multiples of 4.
    free : range(MOST_SAMPLES + 1)
        How many of the oldest samples no reader has to acknowledge any more.
    """
    return data.StructLayout(
        {
            "last": 32,
            "gone": 32,
            "at": address_bits,
            "used": address_bits + 1,
            "free": range(MOST_SAMPLES + 1),
        }
    )


def sample_layout(parts: tuple[Part, ...]) -> data.StructLayout:
    """Return a sample of the history: its place, its bytes, and the tag of the request, if any."""
    address, tag = ceil_log2(bytes_of(parts)), 32 * any(each.has_tags for each in parts)
    return data.StructLayout({"at": address, "bytes": address + 1, "tag": tag})


def HistoriesSignature(parts: tuple[Part, ...]) -> wiring.Signature:
    """Return the side of an :class:`Intake` that the engine has.

    Members
    -------
    waits : In(1)
        There is a message.
    takes : Out(1)
        Take it; held until `ends`, or until `free` is 0. No sample may be read meanwhile, as old
        ones give way.
    ends : In(1)
        High for one cycle: it is in the history, or dropped.
    asks, asker, oldest : In
        How many samples of the writer `asker`, from the number `oldest` on, may give way? Asked
        until `answers`.
    answers, free : Out(1), Out(range(MOST_SAMPLES + 1))
        So many. If it is 0, the message waits until it is taken again.
    writer : Out(range(len(parts)))
        Number of a writer.
    state : In(writer_layout(...))
        Its state, in the same cycle.
    number, fetches : Out(32), Out(1)
        Read a sample of it by its sequence number.
    sample : In(sample_layout(...))
        What was read, in the cycle after.
    """
    address = ceil_log2(bytes_of(parts))
    return wiring.Signature(
        {
            "waits": In(1),
            "takes": Out(1),
            "ends": In(1),
            "asks": In(1),
            "asker": In(range(max(2, len(parts)))),
            "oldest": In(32),
            "answers": Out(1),
            "free": Out(range(MOST_SAMPLES + 1)),
            "writer": Out(range(max(2, len(parts)))),
            "state": In(writer_layout(address)),
            "number": Out(32),
            "fetches": Out(1),
            "sample": In(sample_layout(parts)),
        }
    )


class Intake(wiring.Component):
    """Take messages into the memories of their writers; the oldest samples give way.

    One that is among the last `depth` of its writer gives way only when all readers that are waited
    for have acknowledged it; until then, the message waits.

    Parameters
    ----------
    bus_bytes : int
    topics : sequence of int
        The topic of each writer.
    parts : sequence of Part
        The memory of each writer.
    most_bytes : int
        The largest message.

    Members
    -------
    histories : In(HistoriesSignature(parts))
    sent : In(LinkSignature(bus_bytes))
    unsent : Out(1)
        High for one cycle: a message is dropped, because it is too large, or of no writer.
    write_at, write_word, writes : as of a `History`
    """

    def __init__(
        self, bus_bytes: int, topics: tuple[int, ...], parts: tuple[Part, ...], most_bytes: int
    ):
        self.bus_bytes, self.topics, self.parts = bus_bytes, topics, parts
        self.most_bytes = most_bytes
        super().__init__(
            {
                "histories": In(HistoriesSignature(parts)),
                "sent": In(LinkSignature(bus_bytes)),
                "unsent": Out(1),
                "write_at": Out(ceil_log2(bytes_of(parts))),
                "write_word": Out(32),
                "writes": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        sent, asked = self.sent, self.histories
        count, address = max(2, len(self.parts)), len(self.write_at)
        m.submodules.width = width = PacketWidth(self.bus_bytes, 4)
        m.submodules.samples = inner = Module()
        samples = BlockMemory(inner, asked.sample.shape(), MOST_SAMPLES << ceil_log2(count))
        states = LutMemory(m, "states", asked.state.shape(), count)
        read, written, narrow = states.reader(), states.write, width.packets_out
        # The message: its writer, the state of that, and the place of the next byte.
        writer, tag = Signal(range(count)), Signal(32)
        length, fed = Signal(address + 1), Signal()
        state, place = Signal(asked.state.shape()), Signal(address)
        limit, base, depth, replays = (
            Array(getattr(each, name) for each in self.parts or (Part(base=0, bytes=0),))[writer]
            for name in ("bytes", "base", "depth", "replays")
        )
        mask, number = (limit - 1)[:address], Signal(32)
        kept = Signal(range(MOST_SAMPLES + 1))

        def place_of(writer: Value, number: Value) -> Value:
            return Cat(number[: ceil_log2(MOST_SAMPLES)], writer)

        def in_memory(size: Value) -> Value:
            return Cat(Const(0, 2), (size + 3)[2:])

        m.d.comb += [
            asked.waits.eq(sent.valid),
            asked.state.eq(read.data),
            read.addr.eq(asked.writer),
            samples.read_at.eq(place_of(asked.writer, asked.number)),
            samples.reads.eq(asked.fetches),
            Value.cast(asked.sample).eq(samples.word),
            width.packets_in.payload.eq(sent.payload.beat),
            self.write_at.eq(base | (place & mask)),
            # Behind its end, a message is padded with zeros (9.4.1).
            self.write_word.eq(
                Cat(
                    Mux(narrow.payload.count > place, narrow.payload.data[place], 0)
                    for place in range(4)
                )
            ),
            number.eq(state.last + 1),
            kept.eq(state.last - state.gone),
            samples.write_at.eq(place_of(writer, number)),
            samples.write_word.at.eq(state.at),
            samples.write_word.bytes.eq(length),
            samples.write_word.tag.eq(tag),
            written.addr.eq(writer),
            written.data.last.eq(number),
            written.data.gone.eq(state.gone),
            written.data.at.eq(place & mask),
            written.data.used.eq(state.used + in_memory(length)),
            # A late reader may need some that others have acknowledged.
            written.data.free.eq(Mux(replays, 0, state.free)),
            asked.asker.eq(writer),
            asked.oldest.eq(state.gone + 1),
        ]
        with m.FSM():
            with m.State("INIT"):
                # Memories keep their content in a reset.
                m.d.comb += [written.en.eq(1), Value.cast(written.data).eq(0)]
                m.d.sync += writer.eq(writer + 1)
                with m.If(writer == count - 1):
                    m.next = "IDLE"
            with m.State("IDLE"), m.If(asked.takes):
                known = Const(0)
                for place_in_order, topic in enumerate(self.topics):
                    with m.If(sent.payload.topic == topic):
                        m.d.sync += writer.eq(place_in_order)
                    known = known | (sent.payload.topic == topic)
                m.d.sync += [tag.eq(sent.payload.tag), length.eq(sent.payload.length), fed.eq(0)]
                m.next = "STATE"
                long = sent.payload.length > self.most_bytes
                with m.If(~known | long | (sent.payload.length == 0)):
                    m.d.comb += self.unsent.eq(1)
                    m.next = "DISCARD"
            with m.State("DISCARD"):
                m.d.comb += sent.ready.eq(1)
                with m.If(sent.valid & sent.payload.beat.last):
                    m.d.comb += asked.ends.eq(1)
                    m.next = "IDLE"
            with m.State("STATE"):
                m.d.comb += read.addr.eq(writer)
                m.d.sync += [state.eq(read.data), place.eq(read.data.at)]
                m.next = "ROOM"
                with m.If(length > limit):
                    m.d.comb += self.unsent.eq(1)
                    m.next = "DISCARD"
            with m.State("ROOM"):
                m.d.comb += [
                    samples.read_at.eq(place_of(writer, asked.oldest)),
                    samples.reads.eq(1),
                ]
                m.next = "COPY"
                # One more must fit, by number and by bytes; if not, the oldest gives way. If that
                # one is among the last `depth`, counting the new one, readers are asked first.
                with m.If((kept == MOST_SAMPLES) | (state.used + in_memory(length) > limit)):
                    m.next = "FORGET"
                    with m.If((state.free == 0) & (kept < depth)):
                        m.next = "ASK"
            with m.State("ASK"):
                m.d.comb += asked.asks.eq(1)
                with m.If(asked.answers):
                    # A reader that comes later is not asked about those, but about later ones.
                    m.d.sync += state.free.eq(Mux(asked.free < kept, asked.free, kept))
                    m.next = "ROOM"
                    with m.If(asked.free == 0):
                        m.next = "IDLE"
            # `ROOM` has read the oldest sample, for its size.
            with m.State("FORGET"):
                m.d.sync += [
                    state.gone.eq(asked.oldest),
                    state.used.eq(state.used - in_memory(asked.sample.bytes)),
                    state.free.eq(Mux(state.free == 0, 0, state.free - 1)),
                ]
                m.next = "ROOM"
            with m.State("COPY"):
                # `fed` closes the way behind the last beat: the next message may wait on `sent`
                # already, while words of this one are still in the converter of widths.
                m.d.comb += [
                    width.packets_in.valid.eq(sent.valid & ~fed),
                    sent.ready.eq(width.packets_in.ready & ~fed),
                    narrow.ready.eq(1),
                    self.writes.eq(narrow.valid),
                ]
                with m.If(sent.valid & sent.ready & sent.payload.beat.last):
                    m.d.sync += fed.eq(1)
                with m.If(narrow.valid):
                    m.d.sync += place.eq(place + 4)
                    with m.If(narrow.payload.last):
                        m.next = "COPIED"
            with m.State("COPIED"):
                m.d.comb += [samples.writes.eq(1), written.en.eq(1), asked.ends.eq(1)]
                m.next = "IDLE"
        return m
