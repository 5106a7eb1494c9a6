"""From datagrams to events: the receiver of RTPS messages (8.3.4), a word per cycle."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.node.description import Link
from firm_hdl.node.rtps.announcements import AnnouncementReader
from firm_hdl.node.rtps.assembler import FragmentSignature
from firm_hdl.node.rtps.events import EventKind, announced_layout, event_layout, raw
from firm_hdl.node.rtps.parameters import ParameterReader, swapped
from firm_hdl.rtps.wire.guid import PUBLICATIONS_WRITER, SPDP_WRITER, SUBSCRIPTIONS_WRITER
from firm_hdl.rtps.wire.parameters import Pid
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    InfoDestination,
    InfoSource,
    InfoTimestamp,
    NackFrag,
)

__all__ = ["WORD_BYTES", "MessageReader"]

WORD_BYTES = 4
"""Bytes of a datagram that are read in a cycle: all that is not a name is in words (9.4.1)."""

_HEADER_BYTES = 20
_PAD = 0x01
# Bytes of a submessage's body (9.4.5). Those of sets are longer by the words of the set.
_LEAST = {
    InfoDestination.KIND: 12,
    InfoSource.KIND: 20,
    Data.KIND: 20,
    DataFrag.KIND: 32,
    Heartbeat.KIND: 28,
    AckNack.KIND: 24,
    Gap.KIND: 28,
    NackFrag.KIND: 28,
}
_INFO = (InfoDestination.KIND, InfoSource.KIND)
# What octetsToInlineQos is at least.
_DATA_BYTES, _DATA_FRAG_BYTES = 16, 28
_MOST_BITS = 256
# Vendors whose identifier of the related sample is that of Fast DDS: Fast DDS, and we.
_FAST_DDS = (0x0F01, 0xFF01)


class MessageReader(wiring.Component):
    """Read RTPS messages, and tell of the submessages that are for this participant.

    Both byte orders are read. Submessages and parameters that are not known are skipped, whatever
    their size; nothing is stored but the fields of one event. A submessage that is not valid makes
    the rest of its datagram invalid; what comes before counts (8.3.4.1). Sequence numbers above
    ``2**32 - 1`` are not valid here.

    A word of 4 bytes is taken per cycle, and a byte of parameters and of fragments; some cycles
    more go by for each submessage and each parameter, and those in which an event waits.
    Submessages and payloads begin with a word (9.4.1); others are not valid.

    Parameters
    ----------
    link : Link
        Its domain and address.

    Members
    -------
    packets : In(PacketSignature(WORD_BYTES))
        Datagrams, which have to come whole.
    size : In(16)
        Bytes of the datagram on `packets`.
    own : In(96)
        GUID prefix of this participant, the first byte in the lowest bits.
    events : Out(stream.Signature(event_layout()))
    announced : Out(announced_layout())
        What the event `PARTICIPANT` or `ENDPOINT` announces.
    knows, wants : In(1)
        The answer to an event, in the cycle of its transfer: the sender of `SOURCE` is known; the
        payload of `SAMPLE` is wanted.
    payload : Out(PacketSignature(WORD_BYTES))
        Payloads that are wanted.
    payload_bytes : Out(32)
        Bytes of the payload, in all its beats.
    drained : In(1)
        The payload has left; before that, nothing after it is read.
    fragments : Out(FragmentSignature())
        An :class:`.Assembler`, which takes the bytes of fragments. If it has a whole sample,
        `SAMPLE` comes after `FRAGMENT`, and the payload is that of the assembler.
    nears : Out(1)
        Within some cycles, an event comes, or this ends without one.
    malformed : Out(1)
        High for one cycle per datagram whose rest is dropped.
    stray : Out(1)
        High for one cycle per sample of a sender that is not known.
    """

    def __init__(self, link: Link):
        self.link = link
        super().__init__(
            {
                "packets": In(PacketSignature(WORD_BYTES)),
                "size": In(16),
                "own": In(96),
                "events": Out(stream.Signature(event_layout())),
                "announced": Out(announced_layout()),
                "knows": In(1),
                "wants": In(1),
                "payload": Out(PacketSignature(WORD_BYTES)),
                "payload_bytes": Out(32),
                "drained": In(1),
                "fragments": Out(FragmentSignature()),
                "nears": Out(1),
                "malformed": Out(1),
                "stray": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        # A datagram goes through these states, and what is malformed to `DROP`:
        #
        #   START      -> HEADER -> EVENT (SOURCE) -> SUBMESSAGE
        #   SUBMESSAGE -> LENGTH -> CHECK -> FIELDS -> HEARTBEAT | SET -> EVENT, or -> DATA
        #   DATA       -> BEFORE_INLINE (-> PARAMETERS -> LISTED) -> CONTENT
        #   CONTENT    -> EVENT; of SPDP, SEDP -> ENCAPSULATION -> PARAMETERS -> LISTED -> EVENT
        #   EVENT      -> PAYLOAD -> DRAIN, or -> FRAGMENTS (-> EVENT -> DRAIN)
        #   each       -> SKIP -> SUBMESSAGE -> START, when the datagram has no more
        m = Module()
        packets, event, fragments = self.packets, self.events.payload, self.fragments
        # The word, its first byte lowest; and as a number in the sender's order.
        word, value = Value.cast(packets.payload.data), Signal(32)
        # The byte of the word that is next, and how many are taken; or all are dropped.
        place, byte, step = Signal(2), Signal(8), Signal(3, init=1)
        wants, flushes, is_first = Signal(), Signal(), Signal()
        # Words that were taken in this state; bytes that the datagram and the submessage have yet.
        index, rest, left = Signal(4), Signal(16), Signal(16)
        takes, behind = Signal(), Signal(4)
        kind, flags, length = Signal(8), Signal(8), Signal(16)
        flag_inline, flag_data, flag_key = flags[1], flags[2], flags[3]
        is_little = Signal()
        is_addressed, is_known, in_payload, is_fast = Signal(), Signal(), Signal(), Signal()
        is_fragment, is_part = Signal(), Signal()
        skip, words = Signal(16), Signal(4)
        m.d.comb += [
            takes.eq(packets.valid & wants),
            is_first.eq(place == 0),
            # A beat is given back when all of its bytes were taken, one by one or at once.
            behind.eq(place + step),
            packets.ready.eq(
                flushes | (wants & (behind == Mux(packets.payload.last, packets.payload.count, 4)))
            ),
            byte.eq(word.word_select(place, 8)),
            value.eq(Mux(is_little, word, swapped(word))),
            Value.cast(self.payload.payload.data).eq(word),
            self.payload.payload.count.eq(step),
            self.payload.payload.last.eq(left <= WORD_BYTES),
            is_fragment.eq(kind == DataFrag.KIND),
            fragments.byte.eq(byte),
        ]
        with m.If(takes):
            m.d.sync += [
                place.eq(behind),
                index.eq(index + 1),
                rest.eq(rest - step),
                left.eq(left - step),
            ]
        with m.If(packets.valid & packets.ready):
            m.d.sync += place.eq(0)
        m.submodules.parameters = parameters = ParameterReader()
        m.submodules.announcement = announcement = AnnouncementReader(self.link)
        m.d.comb += [
            parameters.byte.eq(byte),
            parameters.is_little.eq(is_little),
            parameters.left.eq(left),
            announcement.source.eq(event.source),
            announcement.writer.eq(event.writer),
            announcement.adds.eq(parameters.adds & in_payload),
            announcement.aligned.eq(parameters.aligned & in_payload),
            *(
                getattr(announcement, name).eq(getattr(parameters, name))
                for name in ("pid", "index", "byte", "word", "value")
            ),
            self.announced.eq(announcement.announced),
        ]

        def restart(state: str) -> None:
            m.d.sync += index.eq(0)
            m.next = state

        def take_words() -> None:
            m.d.comb += [wants.eq(1), step.eq(WORD_BYTES), self.nears.eq(1)]

        def malformed() -> None:
            m.d.comb += self.malformed.eq(1)
            m.next = "DROP"

        def emit(what: Any) -> None:
            m.d.sync += event.kind.eq(what)
            m.next = "EVENT"

        is_spdp = event.writer == raw(SPDP_WRITER)
        is_sedp = (event.writer == raw(PUBLICATIONS_WRITER)) | (
            event.writer == raw(SUBSCRIPTIONS_WRITER)
        )
        is_builtin = event.writer[30:] == 3
        is_upper = Signal()
        with m.FSM():
            with m.State("START"):
                m.d.sync += [rest.eq(self.size), kind.eq(0), is_addressed.eq(1)]
                with m.If(packets.valid):
                    restart("HEADER")
                    with m.If(self.size < _HEADER_BYTES):
                        malformed()

            with m.State("HEADER"):
                take_words()
                with m.If(takes), m.Switch(index):
                    with m.Case(0), m.If(word != int.from_bytes(b"RTPS", "little")):
                        malformed()
                    with m.Case(1):
                        vendor = word[16:]
                        m.d.sync += is_fast.eq((vendor == _FAST_DDS[0]) | (vendor == _FAST_DDS[1]))
                        with m.If(word[:8] != 2):
                            malformed()
                    with m.Default():
                        m.d.sync += event.source.eq(Cat(event.source[32:], word))
                        with m.If(index == 4):
                            emit(EventKind.SOURCE)

            with m.State("SUBMESSAGE"):
                with m.If(rest == 0):
                    m.next = "START"
                with m.Elif((rest < WORD_BYTES) | ~is_first):
                    malformed()
                with m.Else():
                    take_words()
                    with m.If(takes):
                        m.d.sync += [
                            kind.eq(word[:8]),
                            flags.eq(word[8:16]),
                            length.eq(Mux(word[8], word[16:], swapped(word[16:]))),
                        ]
                        restart("LENGTH")

            with m.State("LENGTH"):
                m.d.comb += self.nears.eq(1)
                # 9.4.5.1.3: 0 means "to the end", except where a submessage may be empty.
                to_end = (length == 0) & (kind != _PAD) & (kind != InfoTimestamp.KIND)
                m.d.sync += [
                    left.eq(Mux(to_end, rest, length)),
                    is_little.eq(flags[0]),
                    event.is_final.eq(flags[1]),
                    event.has_related.eq(0),
                    event.entity.eq(0),
                    in_payload.eq(0),
                    is_part.eq(0),
                ]
                m.next = "CHECK"

            with m.State("CHECK"):
                m.d.comb += self.nears.eq(1)
                m.next = "SKIP"
                with m.Switch(kind):
                    for each, least in _LEAST.items():
                        with m.Case(each):
                            with m.If(left < least):
                                malformed()
                            with m.Elif(is_addressed | (each in _INFO)):
                                m.next = "FIELDS"
                with m.If(left > rest):
                    malformed()

            with m.State("FIELDS"):
                take_words()
                with m.If(takes):
                    with m.Switch(kind):
                        with m.Case(InfoDestination.KIND), m.Switch(index):
                            # Two fields of an event serve as registers of the prefix.
                            with m.Case(0):
                                m.d.sync += event.number.eq(word)
                            with m.Case(1):
                                m.d.sync += event.last.eq(word)
                            with m.Case(2):
                                to = Cat(event.number, event.last, word)
                                m.d.sync += is_addressed.eq((to == self.own) | (to == 0))
                                m.next = "SKIP"
                        with m.Case(InfoSource.KIND):
                            with m.If(index >= 2):
                                m.d.sync += event.source.eq(Cat(event.source[32:], word))
                            with m.If(index == 4):
                                emit(EventKind.SOURCE)
                        with m.Case(Data.KIND, DataFrag.KIND), m.Switch(index):
                            # A word of two numbers. `value` has turned all four bytes, so in the
                            # other byte order the numbers have changed places.
                            halves = Mux(is_little, value, Cat(value[16:], value[:16]))
                            with m.Case(0):
                                m.d.sync += skip.eq(halves[16:])
                            with m.Case(1):
                                m.d.sync += event.reader.eq(word)
                            with m.Case(2):
                                m.d.sync += event.writer.eq(word)
                            with m.Case(3):
                                m.d.comb += is_upper.eq(1)
                            with m.Case(4):
                                m.d.sync += event.number.eq(value)
                                with m.If(~is_fragment):
                                    m.next = "DATA"
                            with m.Case(5):
                                m.d.sync += event.bits.eq(value)
                            with m.Case(6):
                                m.d.sync += Cat(event.fragments, event.fragment_bytes).eq(halves)
                            with m.Case(7):
                                m.d.sync += event.last.eq(value)
                                m.next = "DATA"
                        #   word      | 0      | 1      | 2, 3   | 4    | 5    | 6
                        #   HEARTBEAT | reader | writer | first  | last ...... | count
                        #   GAP       | reader | writer | start  | base ...... | bits
                        #   ACKNACK   | reader | writer | base   | bits |
                        #   NACK_FRAG | reader | writer | number | base | bits |
                        #
                        # Sequence numbers have two words, the upper half first. Bits are the size
                        # of a set, whose words follow.
                        with m.Case(Heartbeat.KIND, AckNack.KIND, Gap.KIND, NackFrag.KIND):
                            is_interval = (kind == Heartbeat.KIND) | (kind == Gap.KIND)
                            with m.Switch(index):
                                with m.Case(0):
                                    m.d.sync += event.reader.eq(word)
                                with m.Case(1):
                                    m.d.sync += event.writer.eq(word)
                                with m.Case(2):
                                    m.d.comb += is_upper.eq(1)
                                with m.Case(3):
                                    m.d.sync += event.number.eq(value)
                                with m.Case(4):
                                    m.d.comb += is_upper.eq(is_interval)
                                    with m.If(kind == NackFrag.KIND):
                                        m.d.sync += event.last.eq(value)
                                with m.Case(5), m.If(is_interval):
                                    m.d.sync += event.last.eq(value)
                            with m.If((kind == Heartbeat.KIND) & (index == 6)):
                                m.next = "HEARTBEAT"
                            size_at = Mux(kind == NackFrag.KIND, 5, 6)
                            is_count = index == Mux(kind == AckNack.KIND, 4, size_at)
                            with m.If((kind != Heartbeat.KIND) & is_count):
                                m.d.sync += words.eq((value + 31)[5:])
                                restart("SET")
                                with m.If(value > _MOST_BITS):
                                    malformed()
                    with m.If(is_upper & (word != 0)):
                        malformed()

            with m.State("SET"):
                # The first word of a set (9.4.2.6), if it has one. All but GAP have a count behind
                # it.
                needed = Cat(0, 0, words) + Mux(kind == Gap.KIND, 0, 4)
                is_short = left < needed
                m.d.comb += [wants.eq((words != 0) & ~is_short), step.eq(WORD_BYTES)]
                with m.If(is_short):
                    malformed()
                with m.Elif(takes | (words == 0)):
                    m.d.sync += event.bits.eq(Mux(words == 0, 0, value))
                    m.next = "SKIP"
                    with m.If(is_known), m.Switch(kind):
                        with m.Case(Gap.KIND):
                            emit(EventKind.GAP)
                        with m.Case(NackFrag.KIND):
                            emit(EventKind.NACK_FRAG)
                        with m.Default():
                            emit(EventKind.ACKNACK)
                    # Numbers begin with 1 (8.3.5.4), but Fast DDS greets a writer with base 0.
                    with m.If((kind != AckNack.KIND) & (event.number == 0)):
                        malformed()

            with m.State("HEARTBEAT"):
                m.next = "SKIP"
                # A writer without samples has a first number that is one above the last (8.3.8.6).
                with m.If((event.number == 0) | (event.last + 1 < event.number)):
                    malformed()
                with m.Elif(is_known):
                    emit(EventKind.HEARTBEAT)

            with m.State("DATA"):
                m.d.comb += self.nears.eq(1)
                # 9.4.5.4: a later version may have more fields before the inline QoS.
                least = Mux(is_fragment, _DATA_FRAG_BYTES, _DATA_BYTES)
                m.d.sync += [skip.eq(Mux(skip < least, 0, skip - least)), event.is_gone.eq(0)]
                m.next = "BEFORE_INLINE"
                fields = (event.bits, event.fragments, event.fragment_bytes, event.last)
                is_empty = Cat(each == 0 for each in fields).any()
                with m.If((event.number == 0) | (is_fragment & is_empty)):
                    malformed()

            with m.State("BEFORE_INLINE"):
                # DATA has a payload or a key, not both (9.4.5.4).
                is_wrong = (skip > left) | (~is_fragment & flag_data & flag_key)
                m.d.comb += [wants.eq((skip != 0) & ~is_wrong), parameters.begins.eq(1)]
                m.d.comb += self.nears.eq(skip == 0)
                with m.If(takes):
                    m.d.sync += skip.eq(skip - 1)
                with m.If(is_wrong):
                    malformed()
                with m.Elif(skip == 0):
                    m.next = "CONTENT"
                    with m.If(flag_inline):
                        m.next = "PARAMETERS"

            with m.State("CONTENT"):
                gone = ~is_fragment & (flag_key | ~flag_data)
                m.d.comb += self.nears.eq(1)
                m.d.sync += [event.is_gone.eq(gone), in_payload.eq(1)]
                m.d.comb += announcement.begins.eq(1)
                m.next = "SKIP"
                with m.If(is_fragment & is_known):
                    emit(EventKind.FRAGMENT)
                with m.Elif(is_spdp & ~is_fragment):
                    with m.If(gone & is_known):
                        emit(EventKind.PARTICIPANT_GONE)
                    with m.Elif(~gone):
                        restart("ENCAPSULATION")
                with m.Elif(~is_known):
                    m.d.comb += self.stray.eq(~is_builtin)
                with m.Elif(is_sedp):
                    restart("ENCAPSULATION")
                    with m.If(~flag_data & ~flag_key):
                        emit(EventKind.ENDPOINT_GONE)
                with m.Elif(~is_builtin):
                    emit(EventKind.SAMPLE)
                    with m.If(flag_data & ((left == 0) | ~is_first)):
                        malformed()

            with m.State("ENCAPSULATION"):
                # 10.5: PL_CDR, in either byte order.
                m.d.comb += parameters.begins.eq(1)
                with m.If((left < WORD_BYTES) | ~is_first):
                    malformed()
                with m.Else():
                    take_words()
                    with m.If(takes):
                        m.d.sync += is_little.eq(word[8])
                        m.next = "PARAMETERS"
                        with m.If(word[:16] & 0xFEFF != 0x0200):
                            malformed()

            with m.State("PARAMETERS"):
                m.d.comb += [wants.eq(parameters.wants), parameters.takes.eq(takes)]
                self._inline(m, parameters, in_payload, is_fast)
                with m.If(parameters.failed):
                    malformed()
                with m.Elif(parameters.ended):
                    m.next = "LISTED"

            with m.State("LISTED"):
                with m.If(~in_payload):
                    m.next = "CONTENT"
                with m.Elif(is_spdp):
                    emit(EventKind.PARTICIPANT)
                with m.Else():
                    emit(EventKind.ENDPOINT)
                    with m.If(event.is_gone):
                        m.d.sync += event.entity.eq(announcement.announced.entity)
                        emit(EventKind.ENDPOINT_GONE)

            with m.State("EVENT"):
                m.d.comb += self.events.valid.eq(1)
                with m.If(self.events.ready):
                    m.next = "SKIP"
                    with m.If(event.kind == EventKind.SOURCE):
                        m.d.sync += is_known.eq(self.knows)
                        with m.If(kind != InfoSource.KIND):
                            restart("SUBMESSAGE")
                        # Multicast comes back to who sent it.
                        with m.If(event.source == self.own):
                            m.next = "DROP"
                    with m.If((event.kind == EventKind.SAMPLE) & self.wants & ~event.is_gone):
                        m.d.sync += self.payload_bytes.eq(left)
                        m.next = "PAYLOAD"
                        # The payload is in the assembler; `left` is that of the last fragment.
                        with m.If(is_part):
                            m.d.comb += fragments.plays.eq(1)
                            m.d.sync += self.payload_bytes.eq(event.last)
                            m.next = "DRAIN"
                    with m.If((event.kind == EventKind.FRAGMENT) & self.wants):
                        m.next = "FRAGMENTS"

            with m.State("PAYLOAD"):
                m.d.comb += [
                    self.payload.valid.eq(packets.valid),
                    wants.eq(self.payload.ready),
                    step.eq(Mux(left < WORD_BYTES, left, WORD_BYTES)),
                ]
                with m.If(takes & self.payload.payload.last):
                    m.next = "DRAIN"

            # The assembler wants bytes while fragments that it has accepted are to come. If they
            # end before, the submessage is shorter than it says.
            with m.State("FRAGMENTS"):
                m.d.comb += [
                    wants.eq(fragments.wants & (left != 0)),
                    fragments.takes.eq(takes),
                ]
                with m.If(fragments.is_whole):
                    m.d.sync += is_part.eq(1)
                    emit(EventKind.SAMPLE)
                with m.Elif(~fragments.wants | (left == 0)):
                    m.d.comb += fragments.stores.eq(1)
                    m.next = "SKIP"
                    with m.If(fragments.wants):
                        malformed()

            with m.State("DRAIN"), m.If(self.drained):
                m.next = "SKIP"

            with m.State("SKIP"):
                is_whole = is_first & (left >= WORD_BYTES)
                m.d.comb += [wants.eq(left != 0), step.eq(Mux(is_whole, WORD_BYTES, 1))]
                with m.If(left == 0):
                    restart("SUBMESSAGE")

            with m.State("DROP"):
                # A datagram without bytes has one beat all the same.
                m.d.comb += flushes.eq((rest != 0) | (self.size == 0))
                with m.If((rest == 0) | packets.valid & packets.payload.last):
                    m.next = "START"
        return m

    def _inline(
        self, m: Module, parameters: ParameterReader, in_payload: Signal, is_fast: Signal
    ) -> None:
        """Take what counts of inline QoS: the sample that is answered, and the key."""
        event, pid, index, word = (
            self.events.payload,
            parameters.pid,
            parameters.index,
            parameters.word,
        )
        is_related = (pid == Pid.RELATED_SAMPLE_IDENTITY) | (
            is_fast & (pid == Pid.FAST_DDS_SAMPLE_IDENTITY)
        )
        with m.If(parameters.aligned & ~in_payload):
            with m.If(is_related & (index < 4)):
                m.d.sync += event.related.eq(Cat(event.related[32:], word))
                with m.If(index == 3):
                    m.d.sync += event.has_related.eq(1)
            with m.If((pid == Pid.KEY_HASH) & (index == 3)):
                m.d.sync += event.entity.eq(word)
