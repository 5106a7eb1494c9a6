# amaranth: UnusedElaboratable=no
"""What a bench connects, and how it prints the data of a transfer."""

from __future__ import annotations

import pytest

from firm_hdl.export.top import DIRECTIONS
from firm_hdl.export.vhdl.bench_views import flat_view, stream_view
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.export.vhdl.test_layer import layer
from tests.strategies import make

PART = make("ros1", {"f": "bool"}, "Part")
MESSAGE = make(
    "ros1",
    {
        "b": "bool",
        "i": "int8",
        "bs": "bool[9]",
        "s": "string",
        "p": (PART, "[2]"),
        "d": "float64[]",
    },
)
# Leaves that are a single bit, have several items in a transfer, or are other vectors. In VHDL, a
# bit has no hexadecimal form; items of one bit, together, have one.
BITS, ITEMS = ("b", "p.item.f"), ("bs.items", "s.items", "d.items")
VECTORS = ("i", "s.length", "d.length")


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_data_of_records_are_printed_in_hexadecimal(bus_bytes):
    plan = build_plan(lay_out(MESSAGE), bus_bytes=bus_bytes)
    channels = stream_view(plan, layer(MESSAGE, bus_bytes)).channels
    assert {each.label: each.image for each in channels} == {
        **{name: f"to_string(rx_msg.{name}.data)" for name in BITS},
        **{name: f"to_hstring(to_slv(rx_msg.{name}.data))" for name in ITEMS},
        **{name: f"to_hstring(rx_msg.{name}.data)" for name in VECTORS},
    }
    for each in channels:
        record = {name: f"rx_msg.{each.label}.{name}" for name in ("data", "valid")}
        record |= {"last": f"rx_msg.{each.label}.last"} if each.label in ITEMS else {}
        assert each.rx == record | {"ready": f"rx_rdy.{each.label}"}
        assert each.tx == {name: text.replace("rx_", "tx_") for name, text in each.rx.items()}


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_data_of_flat_ports_are_printed_in_hexadecimal(bus_bytes):
    plan = build_plan(lay_out(MESSAGE), bus_bytes=bus_bytes)
    cores = {way: Core(entity=f"{way}_core", names={}) for way in DIRECTIONS}
    view = flat_view(plan, "p", cores)
    # On a bus of one byte, a transfer has one bool.
    bits = [*BITS, "bs.items"] if bus_bytes == 1 else BITS
    for each in view.channels:
        names = ["data", "valid", "ready", *(["last"] if each.label in ITEMS else [])]
        for signals, side in ((each.rx, "rx"), (each.tx, "tx")):
            assert signals == {n: f"{side}_{each.label.replace('.', '_')}_{n}" for n in names}
        kind = "to_string" if each.label in bits else "to_hstring"
        assert each.image == f"{kind}({each.rx['data']})"
    assert {each.label for each in view.channels} == {*BITS, *ITEMS, *VECTORS}
    assert view.instances == {way: f"component work.p.{way}_core" for way in DIRECTIONS}
