"""Claims about frames of Ethernet: what is passed on of their datagrams of IPv4."""

from __future__ import annotations

from amaranth.hdl import Mux, Signal, Value

from firm_hdl.ethernet.ipv4 import Ipv4Receiver
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene

__all__ = ["studies"]

ADDRESS, GROUP = 0x0A000032, 0xE0000001
HEADER_BYTES, FRAME_GAP = 20, 12


def _ipv4(scene: Scene) -> None:
    """Receive any frames, and count the bytes that are passed on."""
    m, block = scene.m, Ipv4Receiver(ADDRESS, (GROUP,))
    inner = scene.inside(block)["Ipv4Receiver"]
    came, out, header = block.payloads, block.datagrams.bytes, block.datagrams.header
    begun, pause = Signal(name="begun"), Signal(range(FRAME_GAP + 1), name="pause")
    ends = came.valid & came.payload.end
    m.d.comb += [
        came.valid.eq(scene.free(1, "valid") & (pause == 0)),
        came.payload.data.eq(scene.free(8, "byte")),
        came.payload.end.eq(scene.free(1, "end") & begun),
        came.payload.good.eq(scene.free(1, "good") & came.payload.end),
        block.to_node.eq(scene.free(1, "to_node")),
        block.to_group.eq(scene.free(1, "to_group")),
    ]
    m.d.sync += pause.eq(Mux(ends, FRAME_GAP, pause - (pause != 0)))
    m.d.sync += begun.eq(~ends & (begun | came.valid))
    count, is_byte = Signal(12, name="count"), out.valid & ~out.payload.end
    m.d.sync += count.eq(Mux(out.valid & out.payload.end, 0, count + is_byte))
    place = Mux(count < HEADER_BYTES, count, HEADER_BYTES)
    is_good = out.valid & out.payload.end & out.payload.good
    scene.claim("whole", ~is_good | (count == HEADER_BYTES + header.length))
    scene.claim("whole", ~is_byte | (header.place == place))
    # From this, the claim follows in a cycle.
    at, words, in_header = inner.place, inner.words, inner.in_header
    passed = count + is_byte
    is_over = out.valid & out.payload.end
    for always in (
        (pause == 0) | ~begun,
        begun | ((at == 0) & in_header),
        (at == 0) | begun,
        (at < 2) | (inner.last_word == (words - 1)[:4]),
        in_header | (at != 0),
        ~in_header | (at == 0) | ((words >= 5) & (at < Value.cast(words << 2))),
        ~is_over | (pause == FRAME_GAP),
        is_over | ~in_header | (passed == Mux(at < HEADER_BYTES, at, HEADER_BYTES)),
        in_header | (passed + inner.left == HEADER_BYTES + header.length),
        in_header | (passed >= HEADER_BYTES),
    ):
        scene.claim("whole", always)


_IPV4 = Ipv4Receiver.elaborate


def studies() -> list[Study]:
    """Return the studies of frames."""
    short = Bug(_IPV4, "& (left == 0)", "")
    return [
        Study(
            "ipv4-receiver",
            "`Ipv4Receiver`, any frames",
            _ipv4,
            (Claim("whole", short, "induction", found_within=40),),
        )
    ]
