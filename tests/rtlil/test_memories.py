"""Memories in the reader of RTLIL: sizes, ports, contents."""

from __future__ import annotations

import pytest

from firm_hdl.rtlil.ir import Bits, Cell, Memory, Slice, cut
from firm_hdl.rtlil.read import parse
from firm_hdl.rtlil.simplify import simplified
from tests.rtlil.memory_designs import DESIGNS, Store, rtlil_of

LANES = {"mem": Store(shape=4, depth=3, init=[1, 2], granularity=2, reads=("comb", "transparent"))}


def _cells(text: str, kind: str) -> list[Cell]:
    return [i for i in parse(text).top.items if isinstance(i, Cell) and i.kind == kind]


@pytest.mark.parametrize("name", DESIGNS)
def test_reads_every_memory_with_its_size_and_ports(name: str) -> None:
    text = rtlil_of(DESIGNS[name])
    stores = DESIGNS[name]
    widths = {n: s.shape if isinstance(s.shape, int) else s.shape.size for n, s in stores.items()}
    assert parse(text).top.memories == {
        n: Memory(name=n, width=widths[n], size=store.depth, attributes={})
        for n, store in stores.items()
    }
    for kind, count in (
        ("$meminit_v2", len(stores)),
        ("$memwr_v2", sum(store.writes for store in stores.values())),
        ("$memrd_v2", sum(len(store.reads) + len(store.places) for store in stores.values())),
    ):
        assert len(_cells(text, kind)) == count


def test_reads_contents_lanes_and_transparency() -> None:
    text = rtlil_of(LANES)
    (contents,) = _cells(text, "$meminit_v2")
    assert contents.ports["DATA"] == (Bits("000000100001"),)
    (write,) = _cells(text, "$memwr_v2")
    low, high = Slice("mem_w0_en", 0, 1), Slice("mem_w0_en", 1, 1)
    lanes = [cut(write.ports["EN"], place, 1) for place in range(4)]
    assert lanes == [(low,), (low,), (high,), (high,)]
    asynchronous, synchronous = _cells(text, "$memrd_v2")
    assert [port.parameters["CLK_ENABLE"] for port in (asynchronous, synchronous)] == [0, 1]
    assert synchronous.parameters["TRANSPARENCY_MASK"] == Bits("1")


@pytest.mark.parametrize("name", DESIGNS)
def test_memories_stay_when_a_module_is_simplified(name: str) -> None:
    module = parse(rtlil_of(DESIGNS[name])).top
    plain = simplified(module)
    kinds = [
        sorted(i.kind for i in each.items if isinstance(i, Cell) and i.kind.startswith("$mem"))
        for each in (module, plain)
    ]
    assert kinds[0] == kinds[1] and kinds[0]
    assert plain.memories == module.memories


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("memory width 4 size 3 \\mem", "memory width 4 \\mem", "malformed memory"),
        ("memory width 4", "memory width -4", "malformed memory"),
        ("cell $memwr_v2", "cell $memwr", "Amaranth 0.5 emits no cells of kind"),
    ],
)
def test_malformed_memories_are_errors(old: str, new: str, message: str) -> None:
    text = rtlil_of(LANES)
    assert text.count(old) == 1
    with pytest.raises(ValueError, match=rf"^RTLIL line \d+: {message}"):
        parse(text.replace(old, new))
