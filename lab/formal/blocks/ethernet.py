"""Claims about the receivers of Ethernet: datagrams in one piece, and in fragments.

Datagrams of IPv4 come as `Ipv4Receiver` passes them on, with any header, payload, and end. Memories
and payloads are small; where a limit is made for the largest frame, it is made for the largest
payload of the scene.
"""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

from amaranth.hdl import Mux, Signal, Value

from firm_hdl.ethernet import udp
from firm_hdl.ethernet.fragments import Reassembler
from firm_hdl.ethernet.udp import UdpReceiver
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene

__all__ = ["studies"]

GAP = 5
"""Cycles between the end of a frame and the next byte, at least."""

MOST_BYTES, RING_BYTES, FRAGMENT_BYTES = 11, 32, 64
"""Payload of a datagram of IPv4, and the memories of datagrams."""


class _Datagrams:
    """Any datagrams of IPv4, a byte per cycle at most.

    Attributes
    ----------
    comes, ends : Value
        A byte of the payload comes; the datagram ends, and is good.
    count : Signal
        Bytes of the payload so far.
    """

    def __init__(self, scene: Scene, datagrams: Any, most: int):
        m, bytes_, header = scene.m, datagrams.bytes, datagrams.header
        place, pause = Signal(5, name="place"), Signal(range(GAP + 1), name="pause")
        valid, end = scene.free(1, "valid"), scene.free(1, "end")
        self.place, self.pause = place, pause
        self.count = count = Signal(range(most + 2), name="count")
        kept = Signal(header.shape(), name="kept_header")
        choice = scene.free(header.shape(), "header")
        whole = (place == 20) & (count == header.length)
        m.d.comb += [
            bytes_.valid.eq(valid & (pause == 0)),
            bytes_.payload.data.eq(scene.free(8, "byte")),
            bytes_.payload.end.eq(end),
            bytes_.payload.good.eq(end & whole & scene.free(1, "good")),
            header.eq(Mux(bytes_.valid & (place < 12), choice, kept)),
            header.place.eq(place),
        ]
        scene.assume(header.length <= most)
        scene.assume(header.offset <= 2 * RING_BYTES)
        scene.assume((place < 12) | (header.first == (header.offset == 0)))
        self.comes = bytes_.valid & ~end & (place == 20)
        self.ends = bytes_.valid & bytes_.payload.good
        m.d.sync += [kept.eq(header), pause.eq(pause - (pause != 0))]
        scene.assume(~self.comes | (count < header.length))
        with m.If(bytes_.valid):
            m.d.sync += place.eq(Mux(end, 0, place + (place != 20)))
            m.d.sync += count.eq(Mux(end, 0, count + (place == 20)))
            with m.If(end):
                m.d.sync += pause.eq(GAP)

    def check(self, scene: Scene, state: Any, load: Value | int, loaded: Any) -> None:
        """Drive what a `PayloadCheck` knows: anything until the header of UDP has come."""
        kept = Signal(state.shape(), name="kept_state")
        changes = self.comes & (self.count < udp.HEADER_BYTES)
        scene.m.d.comb += state.eq(kept)
        scene.m.d.sync += kept.eq(
            Mux(load, loaded, Mux(changes, scene.free(len(kept.as_value()), "state"), kept))
        )


def _udp(scene: Scene) -> None:
    m, block = scene.m, UdpReceiver(RING_BYTES)
    # A datagram of the scene has room where the largest one has it.
    with patch.object(udp, "MOST_PAYLOAD", RING_BYTES - 16 - 64):
        inner = scene.inside(block)["UdpReceiver"]
    came, check = _Datagrams(scene, block.datagrams, MOST_BYTES), block.check
    came.check(scene, check, 0, check)
    store, header = block.store, block.datagrams.header
    # The reader reads what was committed, and nothing else.
    in_use = Signal(5, name="in_use")
    m.d.comb += [
        in_use.eq(inner.tail - inner.head),
        block.right.eq(scene.free(1, "right")),
        store.moves.eq(scene.free(1, "moves")),
        store.takes.eq(scene.free(1, "takes") & (in_use != 0)),
        store.release.eq(scene.free(1, "release") & store.full),
    ]
    ring, written = inner.ring, Signal(5, name="written")
    m.d.comb += written.eq(inner.at - inner.tail)
    free = Signal(5, name="distance")
    m.d.comb += free.eq(ring.write_at - inner.head)
    scene.claim("place", ~ring.writes | (free >= in_use))
    # From this, the claim follows in a cycle.
    expected = Mux(came.place <= 12, 0, Mux(came.place < 16, came.place - 12, 4)) + came.count
    committed = scene.was(inner.commit, "committed")
    for always in (
        (came.place < 12) | ~inner.room | (in_use < 16),
        (came.place < 12) | ~inner.room | ~inner.ours | (written == expected),
        ~inner.ends | ~inner.room | ((in_use < 16) & (written < 16)),
        (came.place == 0) | ~(inner.ends | committed),
        (inner.level >= in_use) | committed,
    ):
        scene.claim("place", always)
    whole = (written == header.length + 4) & (check.length == header.length)
    scene.claim("whole", ~inner.commit | (whole & (check.length > udp.HEADER_BYTES)))
    ours = header.udp & header.first & ~header.more
    judged = scene.was(scene.was(came.ends & ours, "ends"), "judged")
    strobes = [committed, block.no_port, block.wrong, block.empty, block.full]
    scene.claim("one outcome", sum(strobes, Value.cast(0)) == judged)


class _SmallReassembler(Reassembler):
    """A memory of a few bytes."""

    def __init__(self) -> None:
        super().__init__(4096)
        self.memory_bytes = FRAGMENT_BYTES


def _fragments(scene: Scene) -> None:
    m, block = scene.m, _SmallReassembler()
    inner = scene.inside(block)["_SmallReassembler"]
    came, store = _Datagrams(scene, block.datagrams, FRAGMENT_BYTES - 4), block.store
    came.check(scene, block.check, block.load, block.loaded)
    tick = scene.free(1, "tick")
    m.d.comb += [
        block.right.eq(scene.free(1, "right")),
        block.tick.eq(tick),
        store.moves.eq(scene.free(1, "moves")),
        store.takes.eq(scene.free(1, "takes")),
        store.release.eq(scene.free(1, "release") & store.full),
    ]
    for number, part in enumerate(inner.parts):
        silent = Signal(3, name=f"silent_{number}")
        is_new = inner.ends & inner.chosen & (inner.slot == number)
        is_new = is_new | ~part.busy | part.done
        m.d.sync += silent.eq(Mux(is_new, 0, silent + (tick & (silent != 7))))
        scene.claim("bounded time", silent <= 4)


_UDP, _FRAGMENTS = UdpReceiver.elaborate, Reassembler.elaborate


def studies() -> list[Study]:
    """Return the studies of the receivers of Ethernet."""
    receiver = {
        "place": Bug(_UDP, "MOST_PAYLOAD - 64", "MOST_PAYLOAD - 48"),
        "whole": Bug(_UDP, "& (header.length >= HEADER_BYTES)", ""),
        "one outcome": Bug(_UDP, "check.port & ~right", "~right"),
    }
    fragments = Bug(_FRAGMENTS, "part.age == _MOST_AGE", "0")
    return [
        Study(
            "udp-receiver",
            f"`UdpReceiver({RING_BYTES})`, payloads of at most {MOST_BYTES} bytes",
            _udp,
            tuple(Claim(name, bug, found_within=95) for name, bug in receiver.items()),
        ),
        Study(
            "reassembler",
            f"`Reassembler({FRAGMENT_BYTES})`, fragments of at most {FRAGMENT_BYTES - 4} bytes",
            _fragments,
            (Claim("bounded time", fragments, found_within=90),),
        ),
    ]
